#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""tidy.py [--alone] COMPILE_COMMANDS SCRATCH SOURCE...  clang-tidy over the sources, several of a folder as one.

Nine tenths of clang-tidy's time go to the templates of OpenVDB's and the standard library's headers, which it walks
again for each source. So sources of one folder are included into one, unless two of them give the same name to
different things: then the group is halved. --alone takes each by itself, which takes twice as long and proves that each includes
what it needs. Exit status 1 where anything is found.
"""
import collections
import concurrent.futures
import json
import os
import pathlib
import re
import shlex
import subprocess
import sys

# Sources in one group. From 8 on the time hardly falls; a group of 30 would leave a core idle at the end.
GROUP = 8


def flags_of(entry):
    """The compiler's options for a source, without what names the source, its object and its dependencies."""
    words = iter(shlex.split(entry["command"])[1:])
    kept = []
    for word in words:
        if word in ("-o", "-MF", "-MT"):
            next(words)
        elif word == "-c":
            break
        elif word not in ("-MD", "-MMD"):
            kept.append(word)
    # In a group a name of one source may be shadowed in a header that another includes; GCC looks at each source alone.
    return (*kept, "-Wno-shadow")


def clang(arguments):
    done = subprocess.run(arguments, capture_output=True, text=True, check=False)
    return done.returncode, done.stdout + done.stderr


def check_group(sources, flags, scratch):
    """What clang-tidy finds in these sources."""
    name = "+".join(pathlib.Path(source).stem for source in sources)[:150]
    group = scratch / f"{pathlib.Path(sources[0]).parent.name}_{name}.cpp"
    group.write_text("".join(f'#include "{source}" // NOLINT(bugprone-suspicious-include)\n' for source in sources))
    if len(sources) > 1:
        status, _ = clang(["clang++", *flags, "-w", "-fsyntax-only", str(group)])
        if status:
            half = len(sources) // 2
            return check_group(sources[:half], flags, scratch) + check_group(sources[half:], flags, scratch)
    # What is included counts as a header, sources among it.
    status, text = clang(["clang-tidy", "--quiet", r"--header-filter=/(include/vdb_shell|src|houdini_compat)/.*\.(h|cpp)$",
                          "--config-file=.clang-tidy", str(group), "--", *flags])
    noise = re.compile(r"^\d+ warnings? (generated|treated)|^Suppressed|^Use -header-filter")
    found = "\n".join(line for line in text.splitlines() if not noise.match(line))
    return found if status or "warning:" in found else ""


def main():
    alone = sys.argv[1] == "--alone"
    most = 1 if alone else GROUP
    commands, scratch, *sources = sys.argv[2 if alone else 1:]
    scratch = pathlib.Path(scratch)
    scratch.mkdir(parents=True, exist_ok=True)
    with open(commands, encoding="utf-8") as file:
        entries = {os.path.realpath(os.path.join(e["directory"], e["file"])): e for e in json.load(file)}
    folders = collections.OrderedDict()
    for source in map(os.path.realpath, sources):
        if source not in entries:
            sys.exit(f"tidy.py: {source} is not among the compile commands")
        flags = flags_of(entries[source])
        folders.setdefault((os.path.dirname(source), flags), []).append(source)

    jobs = []
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for (_, flags), members in folders.items():
            count = -(-len(members) // most)
            jobs += [pool.submit(check_group, members[i::count], flags, scratch) for i in range(count)]
        found = [text for text in (job.result() for job in jobs) if text]
    print("\n".join(found), end="\n" if found else "")
    sys.exit(1 if found else 0)


main()
