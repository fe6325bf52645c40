#!/usr/bin/env bash
# Installs what is missing, builds with warnings as errors, checks format, runs every test.
set -euo pipefail
cd "$(dirname "$0")/.."
bash .ci/install_packages.sh test
bash .ci/lint.sh format
# A clean build takes less by folders; a folder that somebody works in keeps the way it is built.
[ -e build/dev/CMakeCache.txt ] || unity=-DVDB_SHELL_UNITY=ON
cmake --preset dev ${unity:-}
cmake --build --preset dev
ctest --preset dev -j "$(nproc)"
bash .ci/lint.sh tidy
bash .ci/sanitize.sh readers
# All of this has to end within 40 minutes, on a busy machine as well.
if ((SECONDS < 1800)); then
    bash .ci/sanitize.sh races
else
    echo "left out: the thread sanitizer (.ci/sanitize.sh races), as $((SECONDS / 60)) minutes are gone already"
fi
