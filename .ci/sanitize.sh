#!/usr/bin/env bash
# sanitize.sh address [ROOM ...]  tests under the address and undefined-behaviour sanitizers, with Clang
# sanitize.sh thread [ROOM ...]   tests under the thread sanitizer
# sanitize.sh fuzz [SECONDS]      every fuzzer for so many seconds (20)
# sanitize.sh readers             what continuous integration has time for: the first of mesh readers and options, and every
#                                 fuzzer of a mesh reader with a fixed number of inputs, the same every time
# sanitize.sh races               the same of the second: field, steps, growth, layers and certificate on small surfaces with
#                                 four threads, and a race of our own that has to be reported
# sanitize.sh threads             more of the second, in a quarter of an hour: every test that a stage does the same with any
#                                 number of threads, as those are made to share its loops; the slowest are left to
#                                 `thread resample field step growth layers`
# Without rooms: readers, exact tests, shells, certificates and the kept inputs of all fuzzers with the first, the stages whose loops are parallel
# with the second. `all` is every test.
set -euo pipefail
cd "$(dirname "$0")/.."
export TSAN_OPTIONS="suppressions=$PWD/tests/tsan_suppressions.txt halt_on_error=1 ${TSAN_OPTIONS:-}"
export LSAN_OPTIONS="suppressions=$PWD/tests/lsan_suppressions.txt:print_suppressions=0:${LSAN_OPTIONS:-}"

run_tests() { # PRESET ROOM...
    local preset=$1
    shift
    cmake --preset "$preset"
    if [ "$*" = all ]; then
        cmake --build --preset "$preset"
        ctest --preset "$preset" -j "$(nproc)"
    else
        cmake --build --preset "$preset" --target "${@/%/_test}"
        ctest --preset "$preset" -j "$(nproc)" -R "^($(IFS='|'; echo "$*"))\."
    fi
}

what=${1:-}
shift || true
case "$what" in
address)
    rooms=(core options mesh io shell certify fuzz)
    ;;
thread)
    rooms=(core field step growth layers)
    ;;
readers)
    rooms=(options io)
    cmake --preset readers
    cmake --build --preset readers --target "${rooms[@]/%/_test}" mesh_fuzzers
    ctest --preset readers -j "$(nproc)" -R "^($(IFS='|'; echo "${rooms[*]}"))\."
    # Some ten seconds each. Neither chance nor time nor what earlier runs found decides whether this passes.
    exec python3 tests/fuzz/run.py build/readers --runs 250000 --seed 1 --targets obj ply off stl obj_texture ply_texture
    ;;
races)
    cmake --preset races
    cmake --build --preset races --target races_test own_race
    exec ctest --preset races -R '^races\.' # one after the other, as each takes several threads
    ;;
threads)
    [ -e build/threads/CMakeCache.txt ] || unity=-DVDB_SHELL_UNITY=ON # as in tests/run.sh
    cmake --preset threads ${unity:-}
    cmake --build --preset threads --target chosen_tests
    # These take one to ten minutes each.
    slow='Decimate|Remesh|Wrap|SparseStep|GrownFromCoarse|CutLayers'
    exec ctest --preset threads -j "$(nproc)" -R Threads -E "$slow"
    ;;
fuzz)
    cmake --preset fuzz
    cmake --build --preset fuzz --target fuzzers
    exec python3 tests/fuzz/run.py build/fuzz --seconds "${1:-20}"
    ;;
*)
    echo "usage: $0 address|thread [ROOM ...]|readers|races|threads|fuzz [SECONDS]" >&2
    exit 2
    ;;
esac
[ $# -eq 0 ] || rooms=("$@")
if [ "$what" = address ]; then run_tests fuzz "${rooms[@]}"; else run_tests tsan "${rooms[@]}"; fi
