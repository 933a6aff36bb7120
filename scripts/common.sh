# What the scripts share; to be sourced with `top` set to the checkout.
# shellcheck shell=bash
# shellcheck disable=SC2034 # used by the scripts that source this one

: "${top:?}"
cache=$top/.cache
build=$top/build
plugin_names=(filter_curveunfold filter_atomicvolumes filter_poissoncompletion filter_volmorph filter_checkcompletion)

say() { printf '== %s\n' "$*"; }

fail() {
  printf '%s\n' "$*" >&2
  exit 1
}

usage_error() {
  printf '%s\n' "$*" >&2
  exit 2
}

# Runs a command with the rights to install packages.
as_root() {
  if [ "$(id -u)" -eq 0 ]; then
    "$@"
  elif command -v sudo >/dev/null; then
    sudo "$@"
  else
    fail "This needs root, or sudo, to run: $*"
  fi
}

# Shows on a terminal how far a build is: the step numbers that ninja prints, as [12/60].
show_steps() {
  local line
  while IFS= read -r line; do
    if [ -t 1 ] && [[ $line =~ ^\[[0-9]+/[0-9]+\] ]]; then
      printf '\r   %s' "${BASH_REMATCH[0]}"
    fi
  done
  [ ! -t 1 ] || printf '\r\033[K'
}

# Runs a step whose output only matters when it fails.
# Usage: quietly LOG COMMAND...
quietly() {
  local log=$1
  shift
  "$@" 2>&1 </dev/null | tee "$log" | show_steps || fail "$1 failed; the last lines of $log are:
$(tail -n 40 "$log")"
}

# Configures a build folder unless it is configured with these options already.
# Usage: configure DIRECTORY OPTIONS     options without spaces in them, separated by spaces
configure() {
  local directory=$1 options=$2 words
  # cmake's cache is of no use in a checkout that was moved or copied.
  if ! grep -qxF "CMAKE_HOME_DIRECTORY:INTERNAL=$top" "$directory/CMakeCache.txt" 2>/dev/null; then
    rm -rf "$directory"
  fi
  [ -f "$directory/build.ninja" ] && [ "$(cat "$directory/configured-with" 2>/dev/null)" = "$options" ] && return 0
  say "Configuring $(basename "$directory")"
  mkdir -p "$directory"
  read -r -a words <<<"$options"
  quietly "$directory/configure.log" cmake -S "$top" -B "$directory" -G Ninja "${words[@]}"
  printf '%s\n' "$options" >"$directory/configured-with"
}

# Usage: configure_and_build DIRECTORY OPTIONS
configure_and_build() {
  configure "$1" "$2"
  say "Building $(basename "$1")"
  quietly "$1/build.log" cmake --build "$1"
}

# Builds the runner and the plugins, in whatever configuration the build folder already has.
build_runner() {
  local options
  options=$(cat "$build/configured-with" 2>/dev/null) || options="-DCMAKE_BUILD_TYPE=Release -DMESHCOMPLETE_TESTS=OFF"
  configure "$build" "$options"
  say "Building the runner and the plugins"
  quietly "$build/build.log" cmake --build "$build" --target meshcomplete plugins
}
