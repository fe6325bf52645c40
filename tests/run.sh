#!/usr/bin/env bash
# Installs what is missing, builds with warnings as errors, checks format, runs every test.
set -euo pipefail
cd "$(dirname "$0")/.."

# All of this has to end within 50 minutes, and machines differ by a factor of two: what follows the tests is left out where
# it would end after 45. room_for SHARE COMMAND: it takes so many percent of the time before it (docs/building.md).
room_for() {
    if ((SECONDS * (100 + $1) / 100 < 45 * 60)); then
        "${@:2}"
    else
        echo "left out: ${*:2}, as $((SECONDS / 60)) minutes are gone already"
    fi
}

bash .ci/install_packages.sh test
bash .ci/lint.sh format
# A clean build takes less by folders; a folder that somebody works in keeps the way it is built.
[ -e build/dev/CMakeCache.txt ] || unity=-DVDB_SHELL_UNITY=ON
cmake --preset dev -DVDB_SHELL_ALL_TESTS=ON ${unity:-}
cmake --build --preset dev
ctest --preset dev -j "$(nproc)"
room_for 60 bash .ci/lint.sh tidy
room_for 20 bash .ci/sanitize.sh readers
room_for 10 bash .ci/sanitize.sh races
