#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# Runs one of the sample programs and looks at its status and at what it says:
#   programs.sh custom_mesh|carry_points|make_motion|make_meshes COMMAND SAMPLE_FOLDER MESHES
set -eu
program=$1 command=$2 samples=$3 meshes=$4
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
fail() { echo "$1"; exit 1; }

# By itself and not in a pipe, where its status would be lost.
said() { "$@" > said.txt || fail "$1 ended with status $?"; cat said.txt; }

case "$program" in
custom_mesh)
    said "$samples/custom_mesh"
    # 8 prisms of 3 tets between an octahedron and itself shrunk to 0.8.
    grep -q '^24 tets fill 0\.488[0-9]* of the solid$' said.txt || fail "another shell"
    grep -q '^cancelled:$' said.txt && [ "$(tail -n 1 said.txt)" = cancelled ] || fail "not cancelled"
    ;;
carry_points)
    "$command" build "$meshes/sphere.obj" -q -o carried.vdb
    echo 0.25 0.5 -0.125 99 0 0 > points.txt
    "$samples/carry_points" carried.vdb carried.vdb < points.txt > said.txt || fail "carry_points ended with status $?"
    cat said.txt
    # At rest a point stays, to the six digits that are printed.
    [ "$(cat said.txt)" = "$(printf '0.25 0.5 -0.125\noutside')" ] || fail "it moved"
    ;;
make_motion)
    # Frames of make_motion, for pose_frames.
    "$command" build "$meshes/sphere.obj" --resolution 48 -q -o shell.vdb
    said "$samples/make_motion" "$meshes/sphere.obj" bend 3 frames
    [ "$(ls frames | tr '\n' ' ')" = "bend.0001.obj bend.0002.obj bend.0003.obj " ] || fail "other files"
    said "$samples/pose_frames" shell.vdb frames/*.obj
    [ "$(wc -l < said.txt)" = 3 ] || fail "not three frames"
    [ "$(grep -c '"certified": 1,' said.txt)" = 3 ] || fail "not certified"
    # The first frame is the rest, and then it bends.
    sed -n 1p said.txt | grep -q '"moved": 0, .*"skin_jump": 0,' || fail "the first frame is not the rest"
    [ "$(grep -c '"skin_jump": 0\.[0-9]*[1-9]' said.txt)" = 2 ] || fail "nothing bends"
    # A surface of other triangles is no frame of it.
    if "$samples/pose_frames" shell.vdb "$meshes/box.obj" > said.txt 2>&1; then fail "a box is taken for a frame"; fi
    ;;
make_meshes)
    said "$samples/vdb_shell_make_meshes" made
    (cd "$meshes" && ls *.obj) > kept.txt
    (cd made && ls) > made.txt
    cmp kept.txt made.txt || fail "other files"
    for name in $(cat kept.txt); do
        # Bytes, but for the last decimals of coordinates: not every processor and maths library rounds sines alike.
        cmp -s "made/$name" "$meshes/$name" || paste -d ' ' "made/$name" "$meshes/$name" | awk '
            $1 == "v" && NF == 8 && $5 == "v" {
                for (k = 2; k <= 4; ++k) { d = $k - $(k + 4); if (d > 1e-5 || d < -1e-5) exit 1 }
                next
            }
            { half = NF / 2; for (k = 1; k <= half; ++k) if ($k != $(k + half)) exit 1; if (NF % 2) exit 1 }' || fail "$name is another"
    done
    ;;
*) fail "no such program: $program" ;;
esac
