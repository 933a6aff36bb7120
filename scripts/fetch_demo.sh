#!/usr/bin/env bash
# Takes meshes out of Debian's package libcgal-demo without installing it: slim systems do not unpack documentation, and
# that is where the package keeps them. What is there already is not fetched again.
#
# Usage: scripts/fetch_demo.sh NAME...     e.g. elephant-with-holes.off; they are put into .cache/data
set -euo pipefail

top=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
# shellcheck source=scripts/common.sh
source "$top/scripts/common.sh"

missing=()
for name in "$@"; do
  [ -s "$cache/data/$name" ] || missing+=("$name")
done
[ ${#missing[@]} -gt 0 ] || exit 0

download() {
  (cd "$work" && apt-get download -qq -o APT::Sandbox::User="$(id -un)" libcgal-demo) 2>"$work/log"
}

say "Fetching ${missing[*]} from Debian's package libcgal-demo"
mkdir -p "$cache/data"
work=$cache/demo.part
rm -rf "$work"
mkdir -p "$work"
if ! download; then
  as_root apt-get update -qq
  download || fail "The package libcgal-demo could not be downloaded: $(cat "$work/log")"
fi
dpkg -x "$work"/libcgal-demo_*.deb "$work/package"
archive=$work/package/usr/share/doc/libcgal-dev/data.tar.gz
[ -f "$archive" ] || fail "The package libcgal-demo does not hold data.tar.gz."
for name in "${missing[@]}"; do
  member=$(tar -tzf "$archive" | grep -E "/$name\$" | head -n 1) || fail "libcgal-demo does not hold $name."
  tar -xzf "$archive" -O "$member" >"$work/mesh"
  mv "$work/mesh" "$cache/data/$name"
done
rm -rf "$work"
