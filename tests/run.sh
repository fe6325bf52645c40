#!/usr/bin/env bash
# Installs what is missing, checks format and names, builds with warnings as errors, runs every test.
set -euo pipefail
cd "$(dirname "$0")/.."
bash .ci/install_packages.sh test
bash .ci/lint.sh format
bash .ci/lint.sh names
cmake --preset dev -DVDB_SHELL_UNITY=ON
cmake --build --preset dev
ctest --preset dev -j "$(nproc)"
bash .ci/lint.sh tidy
bash .ci/sanitize.sh readers
