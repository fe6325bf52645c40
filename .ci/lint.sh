#!/usr/bin/env bash
# lint.sh format: every C++ file is as clang-format leaves it.
# lint.sh tidy:   clang-tidy finds nothing in the library and the command, several
#                 sources as one. lint.sh tidy --alone takes each by itself, without precompiled headers: each then proves
#                 to include what it needs.
# lint.sh names:  the sources of each folder can be compiled as one, whichever of them CMake puts together.
set -euo pipefail
cd "$(dirname "$0")/.."

# Each source by itself, without the precompiled headers and the option that are GCC's alone.
configure() {
    cmake --preset dev -B build/tidy >/dev/null
    sed -i -E 's# -Winvalid-pch -include [^ ]*cmake_pch.hxx##; s# --param=[^ ]*##' build/tidy/compile_commands.json
}

case "${1:-}" in
format)
    git ls-files '*.h' '*.cpp' | xargs clang-format --dry-run -Werror
    ;;
tidy)
    configure
    git ls-files 'src/*.cpp' 'houdini_compat/*.cpp' | xargs python3 .ci/tidy.py "${@:2}" build/tidy/compile_commands.json build/tidy/groups
    ;;
names)
    configure
    python3 .ci/names.py build/tidy/compile_commands.json build/tidy/names "${@:2}"
    ;;
*) echo "usage: $0 format|tidy|names" >&2; exit 2 ;;
esac
