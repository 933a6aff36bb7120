#!/usr/bin/env bash
# Makes the pictures in docs/images: meshes before and after their holes are closed.
#
# Usage: scripts/make_pictures.sh [BUNNY.ply]
#
# The meshes come from Debian's package libcgal-demo, and one is made by a script. BUNNY.ply is the reconstruction of the
# Stanford Bunny (35,947 vertices, five holes) from the Stanford 3D Scanning Repository; without it its pictures stay as
# they are. Needs the runner: build/bin/meshcomplete, or where the variable MESHCOMPLETE says.
set -euo pipefail

top=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
# shellcheck source=scripts/common.sh
source "$top/scripts/common.sh"

images=$top/docs/images
mkdir -p "$images"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$top/scripts/fetch_demo.sh" elephant-with-holes.off mech-holes-shark.off
"$top/scripts/make_spiral_hole.py" "$work/spiral.off"

picture() {
  say "Drawing $(basename "$2")"
  "$top/scripts/render_completion.py" "$@"
}

picture "$cache/data/elephant-with-holes.off" "$images/elephant" --from=0.7,0.3,1 --width=1.08
picture "$cache/data/mech-holes-shark.off" "$images/shark" --from=1,0.5,1 --width=1.1
picture "$cache/data/mech-holes-shark.off" "$images/shark-close" --from=1,0.5,1 --width=0.3 --at=0.44,0.1,0.5 --edges
picture "$work/spiral.off" "$images/spiral" --from=-0.3,0.9,1 --width=0.9 --unfolded
[ $# -eq 0 ] || picture "$1" "$images/bunny" --from=0.1,-1,0.15 --up=0,0,1
