#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs the fuzzers of a build with the preset `fuzz`, one after the other.

    run.py BUILD_FOLDER [--seconds N] [--targets NAME ...] [--work FOLDER] [--page docs/security.md]
    run.py BUILD_FOLDER --runs N [--seed S] [--targets NAME ...] [--work FOLDER]

Each begins with the inputs in tests/fuzz/inputs/NAME and with what earlier runs found (WORK/NAME). An input that breaks
something is kept as WORK/NAME-crash-*, -timeout-* or -oom-*; `BUILD_FOLDER/tests/fuzz_NAME FILE` runs it again. Inputs and
processor seconds of all runs are added up in WORK/counts.json. Prints a table, and fails if anything broke; with --page the
sums are written there as well (--seconds 0: nothing is run for it).

With --runs each makes so many inputs from a seed, beginning with those in tests/fuzz/inputs alone: the same again, whatever
ran before and however fast the machine is. Then a fuzzer that somebody ends, or that makes too few inputs, is an error.
"""
import argparse
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
sys.path.append(str(HERE.parents[1] / "docs" / "scripts"))
from runs import replace_tables, table  # noqa: E402

# Bytes of an input at most: the smaller, the faster; a .vdb of one voxel has some thousand.
LONGEST = {"tiny_meshes": 160, "vdb": 30000, "houdini": 4000}

# To count how rare each of thousands of features is takes two fifths of the time of a whole build, and to look for what other
# processes have found an eighth of that of a reader.
ALWAYS = ["-entropic=0", "-reload=0"]

# What comparisons saw is kept by addresses, which are others in every process, and a smaller input in the place of a larger one
# differs too from run to run: without both, two runs keep the same inputs, to the byte.
THE_SAME_AGAIN = ["-use_cmp=0", "-reduce_inputs=0"]

# Freed memory that is kept back stays in the processor's cache, and no block remembers where it was asked for: a fifth of the time
# of a file of options. One input run by itself tells that all the same.
SANITIZER = "quarantine_size_mb=16:malloc_context_size=0"

INTERRUPTED = 72 # libFuzzer's status when somebody ended it


def run(build, name, work, corpus, length):
    corpus.mkdir(parents=True, exist_ok=True)
    dictionary = HERE / "dictionaries" / f"{name}.dict"
    line = [build / "tests" / f"fuzz_{name}", corpus, HERE / "inputs" / name, *length,
            f"-max_len={LONGEST.get(name, 2000)}", "-timeout=30", "-rss_limit_mb=3000", "-print_final_stats=1",
            "-verbosity=1", f"-artifact_prefix={work / name}-", *([f"-dict={dictionary}"] if dictionary.exists() else []), *ALWAYS]
    before = os.times()
    done = subprocess.run([str(word) for word in line], capture_output=True, text=True, errors="replace",
                          env={"ASAN_OPTIONS": SANITIZER, **os.environ})
    after = os.times()
    # Of the processor: runs of hours share the machine with other work.
    spent = after.children_user + after.children_system - before.children_user - before.children_system
    count = re.search(r"stat::number_of_executed_units:\s*(\d+)", done.stderr)
    ways = re.findall(r"cov: (\d+)", done.stderr)
    return {"inputs": int(count[1]) if count else 0, "seconds": spent, "status": done.returncode,
            "edges": int(ways[-1]) if ways else 0, "said": done.stderr}


def run_for(seconds, build, name, work):
    """As long as that, on with what earlier runs have found."""
    found = run(build, name, work, work / name, [f"-max_total_time={seconds}"])
    found["broken"] = int(found["status"] not in (0, INTERRUPTED))
    return found


def run_fixed(runs, seed, build, name, work):
    """The same inputs every time."""
    with tempfile.TemporaryDirectory() as corpus:
        found = run(build, name, work, pathlib.Path(corpus), [f"-runs={runs}", f"-seed={seed}", *THE_SAME_AGAIN])
    found["broken"] = int(found["status"] != 0 or found["inputs"] < runs)
    return found


def page_table(sums):
    head = ["target", "inputs", "minutes", "inputs a second", "edges", "broken"]
    rows = [[f"`{name}`", f"{of['inputs']:,}", f"{of['seconds'] / 60:.1f}", f"{of['inputs'] / of['seconds']:,.0f}",
             f"{of['edges']:,}", str(of["broken"])] for name, of in sorted(sums.items())]
    return table(head, rows)


def main():
    names = sorted(path.name for path in (HERE / "inputs").iterdir())
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--seconds", type=int, default=30)
    parser.add_argument("--runs", type=int, default=0)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--targets", nargs="+", choices=names, default=names)
    parser.add_argument("--work", type=pathlib.Path, help="default: fuzz in the build's folder")
    parser.add_argument("--page", type=pathlib.Path)
    options = parser.parse_args()
    work = options.work or options.build / "fuzz"
    work.mkdir(parents=True, exist_ok=True)
    counts = work / "counts.json"
    sums = json.loads(counts.read_text()) if counts.exists() and not options.runs else {}
    broken = 0
    print("| target | inputs | seconds | broken | all inputs | all hours |\n|---|---|---|---|---|---|")
    for name in options.targets if options.seconds or options.runs else []:
        if options.runs:
            found = run_fixed(options.runs, options.seed, options.build, name, work)
        else:
            found = run_for(options.seconds, options.build, name, work)
        broken += found["broken"]
        if found["broken"]:
            print(f"{name}: status {found['status']}, {found['inputs']} inputs\n{found['said'][-4000:]}")
        both = sums.setdefault(name, {"inputs": 0, "seconds": 0, "broken": 0, "edges": 0})
        for key in ("inputs", "seconds", "broken"):
            both[key] += found[key]
        both["edges"] = max(both["edges"], found["edges"])
        if not options.runs:
            counts.write_text(json.dumps(sums, indent=1) + "\n")
        print(f"| {name} | {found['inputs']:,} | {found['seconds']:.0f} | {found['broken']} | {both['inputs']:,} | "
              f"{both['seconds'] / 3600:.2f} |", flush=True)
    if options.page:
        replace_tables(options.page, page_table(sums), "fuzzers")
    return 1 if broken else 0


if __name__ == "__main__":
    sys.exit(main())
