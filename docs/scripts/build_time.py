#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Processor time of a clean build, source by source, without a compiler cache.

    build_time.py build FOLDER [--compiler g++] [--jobs N] [--target NAME] [CMAKE_OPTION ...]
    build_time.py check FOLDER MESHES
    build_time.py page PAGE FOLDER [FOLDER ...]

`build` empties FOLDER, makes a release build there, runs every compiler and every linker through
itself, and leaves one line for each in FOLDER/times.jsonl: user and system seconds of the process
and its children. They grow by a fifth or so when others use the machine, the wall clock without
bound. `check` runs the tests of the folder, and the checksums of the shells that its command makes
of MESHES (checksums.py). `page` writes the figures of the folders, one column each, between the two
marks in PAGE; checksums are held against the first folder's.
"""
import argparse
import collections
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys

TOP = pathlib.Path(__file__).resolve().parents[2]
BEGIN, END = "<!-- build times: begin -->", "<!-- build times: end -->"
LIMIT = 20 # seconds for one source, which is what a change of one costs who waits for it


def launch(log, words):
    """Runs a compiler or linker and notes its time; the exit status is its own."""
    process = subprocess.Popen(words)
    _, status, usage = os.wait4(process.pid, 0)
    made = words[words.index("-o") + 1] if "-o" in words else ""
    source = words[words.index("-c") + 1] if "-c" in words else ""
    line = json.dumps({"made": made, "source": source, "seconds": round(usage.ru_utime + usage.ru_stime, 2),
                       "megabytes": usage.ru_maxrss // 1024})
    with open(log, "a", encoding="utf-8") as file: # one short write: appended whole
        file.write(line + "\n")
    return os.waitstatus_to_exitcode(status)


def build(arguments, options):
    folder = arguments.folder.resolve()
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    log = folder / "times.jsonl"
    launcher = f"{sys.executable};{pathlib.Path(__file__).resolve()};launch;{log}"
    version = subprocess.run([arguments.compiler, "--version"], capture_output=True, text=True, check=True)
    (folder / "compiler.txt").write_text(version.stdout.splitlines()[0] + "\n")
    subprocess.run(["cmake", "-S", TOP, "-B", folder, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release",
                    "-DCMAKE_EXPORT_COMPILE_COMMANDS=ON", f"-DCMAKE_CXX_COMPILER={arguments.compiler}",
                    f"-DCMAKE_CXX_COMPILER_LAUNCHER={launcher}", f"-DCMAKE_CXX_LINKER_LAUNCHER={launcher}",
                    *options], check=True, stdout=subprocess.DEVNULL)
    log.unlink(missing_ok=True) # what CMake tried
    environment = dict(os.environ, CCACHE_DISABLE="1")
    done = subprocess.run(["nice", "ninja", "-C", folder, "-k", "0", "-j", str(arguments.jobs), *arguments.target],
                          check=False, env=environment)
    print(table([figures(folder)]))
    return done.returncode


def check(arguments):
    folder = arguments.folder.resolve()
    tests = subprocess.run(["nice", "ctest", "--test-dir", folder, "-j", str(arguments.jobs)],
                           check=False, capture_output=True, text=True)
    (folder / "tests.txt").write_text(tests.stdout)
    print("\n".join(tests.stdout.splitlines()[-12:]), flush=True)
    shells = subprocess.run(["nice", sys.executable, TOP / "docs/scripts/checksums.py",
                             folder / "src/vdb_shell", arguments.meshes], check=True, capture_output=True, text=True)
    (folder / "checksums.txt").write_text(shells.stdout)
    return tests.returncode


def tests_of(folder):
    """What ctest said of the folder: 'N of M, K skipped'."""
    log = folder / "tests.txt"
    found = re.search(r"tests passed, (\d+) tests failed out of (\d+)", log.read_text()) if log.exists() else None
    if not found:
        return "not run"
    skipped = len(re.findall(r"^\s*\d+ - .*\(Skipped\)", log.read_text(), re.M))
    return f"{int(found[2]) - int(found[1]) - skipped} of {found[2]}" + (f", {skipped} skipped" if skipped else "")


def same_shells(folder, first):
    one, other = folder / "checksums.txt", first / "checksums.txt"
    if not one.exists() or not other.exists():
        return "not run"
    lines = one.read_text().splitlines()
    return f"{len(set(lines) & set(other.read_text().splitlines()))} of {len(lines)}"


def part_of(line, folder):
    """Library and command, or what else the build makes."""
    made = pathlib.Path(line["made"])
    where = made.relative_to(folder) if made.is_absolute() else made
    if where.parts[0] in ("src", "houdini_compat"):
        return "library and command"
    return where.parts[0]


def figures(folder, first=None):
    folder = folder.resolve()
    every = [json.loads(text) for text in (folder / "times.jsonl").read_text().splitlines()]
    lines = list({line["made"]: line for line in every}.values()) # the last of each, if built again
    parts = collections.Counter()
    for line in lines:
        parts[part_of(line, folder)] += line["seconds"]
    minutes = {part: f"{parts[part] / 60:.1f}" if part in parts else "not built" for part in ("tests", "samples")}
    sources = [line for line in lines if line["source"]]
    links = sum(line["seconds"] for line in lines if not line["source"])
    dearest = max(sources, key=lambda line: line["seconds"])
    return {
        "": (folder / "compiler.txt").read_text().strip(),
        "library and command, CPU minutes": f"{parts['library and command'] / 60:.1f}",
        "tests": minutes["tests"],
        "samples": minutes["samples"],
        "everything": f"{sum(parts.values()) / 60:.1f}" if len(parts) == 3 else "not built",
        "of it precompiled headers": f"{sum(s['seconds'] for s in sources if 'cmake_pch' in s['source']) / 60:.1f}",
        "of it links": f"{links / 60:.1f}",
        "sources compiled": str(sum("cmake_pch" not in line["source"] for line in sources)),
        f"sources over {LIMIT} s": str(sum(line["seconds"] > LIMIT for line in sources)),
        "dearest source": f"{name_of(dearest)}, {dearest['seconds']:.0f} s",
        "most memory of one compiler, MB": str(max(line["megabytes"] for line in lines)),
        "tests passed": tests_of(folder),
        "shells with the bytes of the first column": same_shells(folder, (first or folder).resolve()),
    }


def name_of(line):
    path = pathlib.Path(line["source"])
    return str(path.relative_to(TOP)) if path.is_relative_to(TOP) else path.name


def table(columns):
    rows = ["| | " + " | ".join(column[""] for column in columns) + " |", "|---" * (len(columns) + 1) + "|"]
    rows += [f"| {name} | " + " | ".join(column[name] for column in columns) + " |" for name in columns[0] if name]
    return "\n".join(rows)


def write_page(page, folders):
    text = page.read_text()
    if BEGIN not in text or END not in text:
        sys.exit(f"{page}: no line '{BEGIN}' and '{END}'")
    between = f"{BEGIN}\n{table([figures(folder, folders[0]) for folder in folders])}\n{END}"
    page.write_text(re.sub(f"{re.escape(BEGIN)}.*?{re.escape(END)}", lambda _: between, text, flags=re.S))


def main():
    if len(sys.argv) > 3 and sys.argv[1] == "launch":
        return launch(sys.argv[2], sys.argv[3:])
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(dest="command", required=True)
    one = commands.add_parser("build")
    one.add_argument("folder", type=pathlib.Path)
    one.add_argument("--compiler", default="g++")
    one.add_argument("--jobs", type=int, default=os.cpu_count())
    one.add_argument("--target", action="append", default=[])
    two = commands.add_parser("check")
    two.add_argument("folder", type=pathlib.Path)
    two.add_argument("meshes", type=pathlib.Path)
    two.add_argument("--jobs", type=int, default=os.cpu_count())
    three = commands.add_parser("page")
    three.add_argument("page", type=pathlib.Path)
    three.add_argument("folders", type=pathlib.Path, nargs="+")
    arguments, options = parser.parse_known_args()
    if arguments.command == "build":
        return build(arguments, options)
    if options:
        parser.error(f"unknown: {' '.join(options)}")
    if arguments.command == "check":
        return check(arguments)
    write_page(arguments.page, arguments.folders)
    return 0


if __name__ == "__main__":
    sys.exit(main())
