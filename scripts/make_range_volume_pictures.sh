#!/usr/bin/env bash
# Makes the pictures of range volumes in docs/images: of ten scans of the Stanford Bunny, and of what is made of them.
#
# Usage: scripts/make_range_volume_pictures.sh BUNNY.mlp [FOLDER]
#
# BUNNY.mlp is a MeshLab project of Stanford's scans of the bunny, in metres, with the poses of their bun.conf; they come
# from the Stanford 3D Scanning Repository and are not part of this one. The pictures go to FOLDER (default: docs/images).
# Needs f3d, xvfb-run, ImageMagick and the runner: build/bin/meshcomplete, or where the variable MESHCOMPLETE says.
# Takes about two minutes.
set -euo pipefail

top=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
# shellcheck source=scripts/common.sh
source "$top/scripts/common.sh"

[ $# -eq 1 ] || [ $# -eq 2 ] || usage_error "Usage: scripts/make_range_volume_pictures.sh BUNNY.mlp [FOLDER]"
project=$1
images=${2:-$top/docs/images}
runner=${MESHCOMPLETE:-$build/bin/meshcomplete}
[ -x "$runner" ] || fail "There is no runner at $runner: run ./complete once, or set MESHCOMPLETE."
[ -r "$project" ] || fail "The project cannot be read: $project"
mkdir -p "$images"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# Runs filters on the scans. Usage: make FILE ARGUMENTS...
make() {
  say "Making $1"
  "$runner" --quiet -p "$project" "${@:2}" -o "$work/$1"
}

# A mesh seen from the point X,Y,Z, with the y axis upwards. Usage: draw FILE NAME X,Y,Z SIDE
draw() {
  say "Drawing range-volume-$2.png"
  local picture=$images/range-volume-$2.png
  xvfb-run -a f3d "$work/$1" --dry-run --quiet --output "$picture" --resolution "$((2 * $4)),$((2 * $4))" \
    --bg-color 1,1,1 --color 0.86,0.87,0.90 --roughness 0.6 --camera-position="$3" \
    --camera-focal-point=-0.0168,0.1105,-0.0015 --camera-view-up=0,1,0 --camera-view-angle=28
  # Drawn twice as large and shrunk: smooth edges. A palette keeps the file small.
  convert "$picture" -filter Box -resize 50% -level 0,68% -strip -colors 200 -define png:compression-level=9 "$picture"
}

# One image of a volume's slices, a voxel as two by two pixels. Usage: slice FILE NAME CHANGES...
slice() {
  say "Taking range-volume-$2.png"
  convert "$work/$1" "${@:3}" -filter Point -resize 200% -strip -define png:compression-level=9 \
    "$images/range-volume-$2.png"
}

merge=(-f "Range Volume: Merge Scans" -p "LineOfSight=Z axis of each layer")
extract=(-f "Range Volume: Extract Surface")
morphology=(-f "Range Volume: Morphology" -p Measure=false)

# From the scans to one closed surface.
front=-0.05,0.185,0.39 below=0.06,-0.23,0.16
make scans.ply -f "Flatten Visible Layers" -p MergeVertices=false
make surface.ply "${merge[@]}" VoxelSize=0.001 "${morphology[@]}" "Operators=d2 e2" -f "Range Volume: Fill" -p Measure=false \
  "${extract[@]}" -p SmallestComponent=1000
draw scans.ply scans "$front" 420
draw scans.ply scans-below "$below" 420
draw surface.ply surface "$front" 420
draw surface.ply surface-below "$below" 420

# As published: what was not looked through stays unseen, before the surface too.
published=("${merge[@]}" Surroundings=false)
around=0.05,0.15,0.475
make before.ply "${published[@]}" VoxelSize=0.001 "${extract[@]}"
make after.ply "${published[@]}" VoxelSize=0.001 "${morphology[@]}" "Operators=e1 d1" "${extract[@]}"
make fan.ply "${published[@]}" VoxelSize=0.001 "${extract[@]}" -p ObservedOnly=true \
  -f "Close Holes: Triangle Fan" -p AsPublished=true
draw before.ply vrip-before "$around" 560
draw after.ply vrip-after "$around" 560
draw fan.ply fan "$around" 560

# Slices near the middle, likewise.
slices=(-f "Range Volume: Slice" -p)
make sliced.ply "${published[@]}" VoxelSize=0.0005 \
  "${slices[@]}" Axis=x View=States "Folder=$work/before" "${slices[@]}" Axis=z View=Normals "Folder=$work/normals" \
  "${slices[@]}" Axis=y View=Weights "Folder=$work/weights" "${morphology[@]}" "Operators=d2 e2 e2 d2" \
  "${slices[@]}" Axis=x View=States "Folder=$work/after"
slice before/x_0130.png states-before -rotate -90
slice after/x_0130.png states-after -rotate -90
slice normals/z_0130.png normals
slice weights/y_0060.png weights
