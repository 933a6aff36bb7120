#!/usr/bin/env bash
# Prints apt's binary package sources as deb-src lines, one per suite, component main only: where the source packages
# of this machine's packages are.
#
# Usage: scripts/source_lines.sh FILE...     one-line .list files and deb822 .sources files; others are passed over
set -euo pipefail

one_line_sources() {
  sed -nE 's/^[[:space:]]*deb[[:space:]]+(\[[^]]*\][[:space:]]+)?([^[:space:]]+)[[:space:]]+([^[:space:]]+)[[:space:]](.*[[:space:]])?main([[:space:]#].*)?$/deb-src \1\2 \3 main/p' "$1"
}

deb822_sources() {
  awk '
    function print_stanza(   u, s, i, j, uri_count, suite_count, option) {
      if ((" " types " ") ~ / deb / && (" " components " ") ~ / main / && tolower(enabled) !~ /^(no|false)/) {
        option = signed == "" ? "" : "[signed-by=" signed "] "
        uri_count = split(uris, u, " ")
        suite_count = split(suites, s, " ")
        for (i = 1; i <= uri_count; ++i)
          for (j = 1; j <= suite_count; ++j) print "deb-src " option u[i] " " s[j] " main"
      }
      types = uris = suites = components = enabled = signed = ""
    }
    /^#/ { next }
    /^[[:space:]]*$/ { print_stanza(); next }
    { value = $0; sub(/^[^:]*:[[:space:]]*/, "", value); gsub(/[[:space:]]+/, " ", value); sub(/ $/, "", value) }
    tolower($1) == "types:" { types = value }
    tolower($1) == "uris:" { uris = value }
    tolower($1) == "suites:" { suites = value }
    tolower($1) == "components:" { components = value }
    tolower($1) == "enabled:" { enabled = value }
    # A key that stands in the file itself cannot be named on one line; the keys that the machine trusts have to do.
    tolower($1) == "signed-by:" { signed = value ~ /^\// ? value : "" }
    END { print_stanza() }
  ' "$1"
}

for file in "$@"; do
  [ -f "$file" ] || continue
  case $file in
    *.list) one_line_sources "$file" ;;
    *.sources) deb822_sources "$file" ;;
  esac
done | sort -u
