#!/usr/bin/env bash
# Makes the pictures in docs/images: meshes before and after their holes are closed.
#
# Usage: scripts/make_pictures.sh [BUNNY.ply]
#
# The meshes come from Debian's package libcgal-demo, and some are made by scripts. BUNNY.ply is the reconstruction of the
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
"$top/scripts/fetch_demo.sh" elephant-with-holes.off mech-holes-shark.off armadillo.off hand.off bunny00.off \
  lion-head.off
"$top/scripts/make_spiral_hole.py" "$work/spiral.off"
for shape in pierced-sphere outer-half-torus inside-the-ring island guide-tube unlike-halves; do
  "$top/scripts/make_atomic_shapes.py" "$shape" "$work/$shape.off"
done
for shape in fist slices assembled head horseshoe; do
  "$top/scripts/make_paper_cases.py" "$shape" "$work"
done
"$top/scripts/make_atomic_shapes.py" gap "$work/gap.off" "$cache/data/armadillo.off" y -28 -22

picture() {
  say "Drawing $(basename "$2")"
  "$top/scripts/render_completion.py" "$@"
}

picture "$cache/data/elephant-with-holes.off" "$images/elephant" --from=0.7,0.3,1 --width=1.08
picture "$cache/data/mech-holes-shark.off" "$images/shark" --from=1,0.5,1 --width=1.1
picture "$cache/data/mech-holes-shark.off" "$images/shark-close" --from=1,0.5,1 --width=0.3 --at=0.44,0.1,0.5 --edges
picture "$work/spiral.off" "$images/spiral" --from=-0.3,0.9,1 --width=0.9 --unfolded

# By atomic volumes: a shape, the picture's name, the view, and parameters.
atomic() {
  local shape=$1 name=$2
  shift 2
  picture "$work/$shape.off" "$images/atomic-$name" -f "Close Holes: Atomic Volumes" --size=480,360 "$@"
}

atomic pierced-sphere pierced --from=1,-0.6,0.7 --up=0,0,1 --width=1.1
atomic gap gap --from=0.35,0.12,-1 --width=0.55 --at=0,-20,0
atomic island island --from=1,-0.6,1.1 --up=0,0,1 --width=0.8
atomic outer-half-torus torus -p Weight=Area --from=1,-0.6,1.1 --up=0,0,1 --width=0.85
atomic outer-half-torus ring -p Weight=Area --from=1,-0.6,1.1 --up=0,0,1 --width=0.85 \
  --with "$work/inside-the-ring.off" -p OutsideLayer=inside-the-ring.off
rm "$images/atomic-ring-before.png"

# Driven by a Poisson reconstruction, likewise.
poisson() {
  local shape=$1 name=$2
  shift 2
  picture "$work/$shape.off" "$images/poisson-$name" -f "Close Holes: Poisson-driven" --size=480,360 "$@"
}

poisson gap gap --from=0.35,0.12,-1 --width=0.55 --at=0,-20,0
poisson gap gap-close --from=0.35,0.12,-1 --width=0.17 --at=24,-25,15 --edges
poisson island island --from=1,-0.6,1.1 --up=0,0,1 --width=0.8
poisson unlike-halves unlike --from=1,-0.6,0.5 --up=0,0,1 --width=0.95 --edges
poisson outer-half-torus torus --from=1,-0.6,1.1 --up=0,0,1 --width=0.85
poisson outer-half-torus guided --from=1,-0.6,1.1 --up=0,0,1 --width=0.85 \
  --with "$work/guide-tube.off" -p GuideLayer=guide-tube.off -p Fairing=None
picture "$work/gap.off" "$images/poisson-strip" -f "Conditional Vertex Selection" \
  -p "condSelect=(y > -36) && (y < -14) && (z < 12) && (abs(x - 26) < 5)" \
  -f "Close Holes: Poisson-driven" -p PartialFill=true --size=480,360 --from=0.35,0.12,-1 --width=0.25 --at=24,-24,12
picture "$cache/data/mech-holes-shark.off" "$images/poisson-shark" -f "Close Holes: Poisson-driven" --size=480,360 \
  --from=-1,-0.3,0.3 --width=1
# The paper's figures 10, 1 and 12, and what it names as future work.
poisson fist fist --from=0.2,-1,0.25 --up=0,0,1 --width=0.6 --at=0,0,0.1
poisson fist fist-below --from=0.3,-1,-0.9 --up=0,0,1 --width=0.45 --at=0,0,0.1
poisson slices slices --from=-0.3,0.3,1 --width=1.05
poisson assembled assembled --from=-0.1,0.1,1 --width=0.9 \
  --with "$work/assembled-tube.off" -p GuideLayer=assembled-tube.off
poisson head head --from=-0.5,0.3,1 --width=0.9
poisson head head-close --from=-0.5,0.3,1 --width=0.35 --at=-0.38,0.05,0.12 --edges
poisson horseshoe horseshoe --from=0.3,-0.6,1 --width=0.85
poisson horseshoe horseshoe-guided --from=0.3,-0.6,1 --width=0.85 \
  --with "$work/horseshoe-points.ply" -p GuideLayer=horseshoe-points.ply
rm "$images"/poisson-horseshoe{,-guided}-before.png
# Those are the same as with atomic volumes.
rm "$images"/poisson-{gap,island,torus,guided}-before.png

# By triangle fans; before, it is as above.
picture "$cache/data/mech-holes-shark.off" "$images/fan-shark" -f "Close Holes: Triangle Fan" --size=480,360 \
  --from=-1,-0.3,0.3 --width=1 --edges
rm "$images/fan-shark-before.png"

[ $# -eq 0 ] || picture "$1" "$images/bunny" --from=0.1,-1,0.15 --up=0,0,1
