#!/usr/bin/env bash
# Installs what is missing, builds with warnings as errors, checks format, runs every test.
set -euo pipefail
cd "$(dirname "$0")/.."
bash .ci/install_packages.sh test
bash .ci/lint.sh format
cmake --preset dev
cmake --build --preset dev
ctest --preset dev -j "$(nproc)"
bash .ci/lint.sh tidy
bash .ci/sanitize.sh readers
