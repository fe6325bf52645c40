#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Makes the pictures of volumes in docs/images: a brick shell map, smoke bound to a bending creature, marble layers by depth.
#
#     bash samples/volume_pictures.sh [BUILD [FOLDER]]
#
# BUILD (build/release) has the command and make_motion; pictures go to FOLDER (docs/images). Needs blender, python3-numpy and
# python3-openvdb (Debian). About three minutes on two cores.
set -euo pipefail

root=$(cd "$(dirname "$0")/.." && pwd)
build=$(realpath "${1:-$root/build/release}")
pictures=$(realpath "${2:-$root/docs/images}")
creature=$root/samples/meshes/creature.obj
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
export PATH=$build/src:$build/samples:$PATH

make_volumes() { /usr/bin/python3 "$root/samples/blender/make_volumes.py" "$@"; }
show() { blender --background --factory-startup --python-exit-code 1 --python "$root/samples/blender/$1" -- "${@:2}" > blender.log || { cat blender.log; exit 1; }; }

# A wall of bricks: a skin 0.04 thick, 5 bricks of 0.2 for one unit of u, 6.25 times two courses of 0.08 for one of v.
make_volumes unwrap "$creature" textured.obj
make_volumes bricks bricks.vdb
vdb_shell build textured.obj --thickness 0.04 -q -o skin.vdb
vdb_shell map bricks.vdb --shell skin.vdb --mesh textured.obj --repeat-u 5 --repeat-v 6.25 --voxel-size 0.006 -o wall.vdb
show show_solids.py wall.vdb "$pictures/shell_map_bricks.png" --body bricks:0.5,0.15,0.08 --body mortar:0.6,0.57,0.52 \
    --up y --turn 60 --samples 16

# Smoke that fills the creature, at rest and in two poses.
vdb_shell build "$creature" -q -o rest.vdb
vdb_shell volumes rest.vdb --volumes density --density-ramp 0:0.3,0.15:1,1:1 -o density.vdb
make_volumes smoke density.vdb smoke.vdb
make_motion "$creature" bend 3 bend
vdb_shell pose -q rest.vdb 'bend/bend.####.obj' --frames 1-3 -o 'posed.####.vdb'
vdb_shell deform smoke.vdb --posed 'posed.####.vdb' --frames 1-3 -o 'smoke.####.vdb'
show show_volumes.py smoke.0001.vdb smoke.0002.vdb smoke.0003.vdb "$pictures/bound_smoke.png" \
    --up y --turn 90 --size 900 280 --samples 48 --light 12

# Marble: veins of depth and noise, the creature cut through its middle.
vdb_shell volumes rest.vdb --volumes depth -o depth.vdb
make_volumes marble depth.vdb marble.vdb
show show_solids.py marble.vdb "$pictures/marble_layers.png" --body solid --colour vein --up y --turn -90 --samples 16
