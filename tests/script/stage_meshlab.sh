#!/usr/bin/env bash
# Builds a MeshLab tree that needs no root: MeshLab's own programs and plugins, linked, with further plugins beside them.
#
# Usage: stage_meshlab.sh DIRECTORY PLUGIN...
set -euo pipefail

target=$1
shift
meshlab=$(command -v meshlab)
library=$(find /usr/lib -maxdepth 3 -path '*/meshlab/libmeshlab-common.so' -print -quit)
[ -n "$library" ] || {
  echo "MeshLab is not installed." >&2
  exit 1
}
packaged=$(dirname "$library")
staged=$target/${packaged#/usr/}

rm -rf "$target"
mkdir -p "$target/bin" "$target/share" "$staged/plugins"
# A linked program would find its way back to the packaged plugins, so the programs are copied.
cp "$(readlink -f "$meshlab")" "$target/bin/meshlab"
cp "$(readlink -f "$(dirname "$meshlab")/meshlabserver")" "$target/bin/meshlabserver"
ln -s /usr/share/meshlab "$target/share/meshlab"
ln -s "$library" "$staged/"
ln -s "$packaged"/plugins/* "$staged/plugins/"
for plugin in "$@"; do
  ln -sf "$(readlink -f "$plugin")" "$staged/plugins/"
done
