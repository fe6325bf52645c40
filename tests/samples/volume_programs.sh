#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# The samples that show the volumes' API, on a sphere: volume_programs.sh COMMAND SAMPLE_FOLDER SPHERE.obj
set -eu
command=$1 samples=$2 sphere=$3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
fail() { echo "$1"; exit 1; }

# Texture coordinates by projection along z.
awk '/^v /{print; print "vt", $2, $3; next} /^f /{for (i = 2; i <= NF; i++) $i = $i "/" $i} {print}' "$sphere" > textured.obj
"$command" build textured.obj --resolution 48 -q -o shell.vdb
"$command" volumes shell.vdb --volumes density -o fog.vdb

"$samples/write_coordinates" shell.vdb coordinates.vdb > coordinates.txt
cat coordinates.txt
# All have the same voxels, and so have the distances.
[ "$(sed 's/.*: //' coordinates.txt | sort -u | wc -l)" = 1 ] && [ "$(wc -l < coordinates.txt)" = 3 ] || fail "other voxels"
"$samples/distances" shell.vdb distances.vdb | tee distances.txt
[ "$(sed 's/ voxels.*//' distances.txt)" = "$(sed -n '1s/.*: \(.*\) voxels/\1/p' coordinates.txt)" ] || fail "other voxels than coordinates"
# A sphere of radius 1: the middle is 1 away from its vertices, and the mesh is a little inside. What
# is empty around the middle, .003 of the solid at most, has a radius of .15 if it is a ball.
awk '{exit !($NF < -0.85 && $NF >= -1)}' distances.txt || fail "not the depth of a sphere"

# At rest nothing changes.
"$samples/deform_fog" fog.vdb shell.vdb shell.vdb carried.vdb | tee carried.txt
awk '{exit !($3 > 0 && $3 == $5)}' carried.txt || fail "other mass at rest"

"$samples/map_texture" fog.vdb shell.vdb textured.obj mapped.vdb | tee mapped.txt
awk '{exit !($1 == "density:" && $2 > 1000 && $NF >= 1)}' mapped.txt || fail "nothing mapped"
