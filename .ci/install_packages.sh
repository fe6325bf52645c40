#!/usr/bin/env bash
# Installs the Debian 12 packages that are missing.
#   install_packages.sh build   what compiling and running needs
#   install_packages.sh test    that, and what the tests need
set -euo pipefail

build=(g++ cmake ninja-build libtbb-dev libopenvdb-dev libblosc-dev libboost-dev libboost-iostreams-dev libopenmesh-dev
       libcgal-dev libhwy-dev libxxhash-dev libpng-dev zlib1g-dev nlohmann-json3-dev libcli11-dev libeigen3-dev)
test=(git libgtest-dev libgmock-dev libbenchmark-dev clang libclang-rt-14-dev clang-format clang-tidy doxygen python3 python3-jsonschema python3-openvdb python3-numpy python3-vtk9 gmsh tetgen libopenvdb-tools blender chromium
      slurm-wlm munge)

case "${1:-}" in
build) wanted=("${build[@]}") ;;
test) wanted=("${build[@]}" "${test[@]}") ;;
*) echo "usage: $0 build|test" >&2; exit 2 ;;
esac

missing=()
for package in "${wanted[@]}"; do
    dpkg-query -W -f='${Status}' "$package" 2>/dev/null | grep -q '^install ok installed$' || missing+=("$package")
done
[ ${#missing[@]} -eq 0 ] && exit 0

echo "installing: ${missing[*]}"
as_root=()
[ "$(id -u)" -eq 0 ] || as_root=(sudo)
"${as_root[@]}" apt-get update -qq
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
