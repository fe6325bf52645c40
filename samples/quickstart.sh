#!/usr/bin/env bash
# Installs what is missing, builds, and makes a shell of the sample creature in build/quickstart/.
set -euo pipefail
cd "$(dirname "$0")/.."
bash .ci/install_packages.sh build
# A clean build takes less by folders; one that is there already keeps the way it is built.
[ -e build/release/CMakeCache.txt ] || unity=-DVDB_SHELL_UNITY=ON
cmake --preset release -DVDB_SHELL_BUILD_TESTS=OFF ${unity:-}
cmake --build --preset release
out=build/quickstart
mkdir -p "$out"
build/release/src/vdb_shell build samples/meshes/creature.obj \
    -o "$out/creature.vdb" -o "$out/creature.vtu" -o "$out/creature.png" --section-axis x --section-position 0.525 --report "$out/creature.json"
build/release/src/vdb_shell check "$out/creature.vdb"
echo
echo "The shell:    $out/creature.vdb (level set, depth, points) and $out/creature.vtu (tets)"
echo "Its figures:  $out/creature.json"
echo "Its picture:  $out/creature.png"
