#!/usr/bin/env bash
# Makes a Debian machine ready to build: installs the packages that are missing and unpacks MeshLab's headers, which
# Debian packages only as source. What is done already is skipped. The machine's apt configuration is left alone.
#
# Usage: scripts/setup.sh build|test|benchmark     what the packages are needed for; each needs those before it
set -euo pipefail

top=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
# shellcheck source=scripts/common.sh
source "$top/scripts/common.sh"

build_packages=(
  g++ cmake ninja-build ccache meshlab qtbase5-dev libqt5opengl5-dev libeigen3-dev libglew-dev libgl-dev libcgal-dev
  libtbb-dev libmaxflow-dev libopenvdb-dev dpkg-dev ca-certificates xz-utils
)
test_packages=(libgtest-dev libgmock-dev libopenvdb-tools python3 xvfb xauth libgl1-mesa-dri xdotool openbox imagemagick)
benchmark_packages=(libbenchmark-dev f3d)

installed() {
  [ "$(dpkg-query -W -f '${db:Status-Status}' "$1" 2>/dev/null)" = installed ]
}

# Installs the packages among the arguments that are missing.
install_packages() {
  local missing=() package
  for package in "$@"; do
    installed "$package" || missing+=("$package")
  done
  [ ${#missing[@]} -gt 0 ] || return 0
  say "Installing ${#missing[@]} Debian packages: ${missing[*]}"
  as_root apt-get update -qq
  as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}" \
    </dev/null >"$cache/apt-install.log" 2>&1 ||
    fail "apt-get install failed; the last lines of $cache/apt-install.log are:
$(tail -n 15 "$cache/apt-install.log")"
}

# apt with lists, cache and sources of its own.
private_apt() {
  local command=$1
  shift
  "$command" -o Dir::Etc::sourcelist="$private/sources.list" -o Dir::Etc::sourceparts=- \
    -o Dir::State::lists="$private/lists" -o Dir::Cache="$private/cache" -o Dir::Cache::archives="$private/archives" \
    -o APT::Get::List-Cleanup=false -o APT::Sandbox::User="$(id -un)" "$@"
}

fetch_meshlab_headers() {
  local version upstream target
  version=$(dpkg-query -W -f '${source:Version}' meshlab)
  upstream=${version%%[+-]*}
  target=$cache/meshlab-$upstream
  [ -f "$target/ML_VERSION" ] && return 0
  say "Fetching the headers of MeshLab $version from Debian's source package"
  private=$cache/apt
  rm -rf "$private"
  mkdir -p "$private/lists/partial" "$private/cache" "$private/archives/partial" "$private/download"
  "$top/scripts/source_lines.sh" /etc/apt/sources.list /etc/apt/sources.list.d/* >"$private/sources.list"
  [ -s "$private/sources.list" ] || fail "No Debian package source with the component main is configured in /etc/apt."
  private_apt apt-get update -qq
  (cd "$private/download" && private_apt apt-get source -qq --download-only --tar-only "meshlab=$version") ||
    fail "MeshLab's source package $version could not be downloaded."
  rm -rf "$target.part"
  mkdir -p "$target.part"
  tar -xf "$private"/download/meshlab_*.orig.tar.* -C "$target.part" --strip-components=1 --wildcards --no-wildcards-match-slash \
    '*/ML_VERSION' '*/LICENSE.txt' '*/src/common' '*/vcglib/vcg' '*/vcglib/wrap'
  [ -f "$target.part/src/common/meshmodel.h" ] || fail "MeshLab's source package $version does not have the expected layout."
  mv "$target.part" "$target"
  rm -rf "$private"
}

case ${1:-build} in
  build) packages=("${build_packages[@]}") ;;
  test) packages=("${build_packages[@]}" "${test_packages[@]}") ;;
  benchmark) packages=("${build_packages[@]}" "${test_packages[@]}" "${benchmark_packages[@]}") ;;
  *) usage_error "Usage: scripts/setup.sh build|test|benchmark" ;;
esac
command -v apt-get >/dev/null || fail "This set-up knows Debian only. Elsewhere: install the packages named in scripts/setup.sh, unpack MeshLab's source, and pass -DMESHLAB_SOURCE_DIR= to cmake."
mkdir -p "$cache"
install_packages "${packages[@]}"
fetch_meshlab_headers
