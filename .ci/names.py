#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""names.py COMPILE_COMMANDS SCRATCH [FOLDER ...]  whether all sources of a folder can be compiled as one.

With VDB_SHELL_UNITY several are (docs/building.md), and which those are changes with every new file. So Clang parses all
sources of a target that stand in one folder together, and says which names mean two things there. Without FOLDERs: all.
Exit status 1 where anything is found.
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

# Compiled alone always: kernels that include themselves once for each kind of processor.
ALONE = {"vdb_shell_simd"}


def groups_of(commands, top):
    """{(target, folder, flags): sources} of what stands in the project's folders. A source with definitions of its own
    has other flags, and is compiled alone."""
    groups = collections.OrderedDict()
    for entry in json.loads(commands.read_text()):
        source = pathlib.Path(entry["directory"], entry["file"]).resolve()
        target = re.search(r"(\w+)\.dir/", entry["command"])
        if not source.is_relative_to(top) or source.is_relative_to(top / "build") or not target or target[1] in ALONE:
            continue
        words = shlex.split(entry["command"])
        words = words[:words.index("-o")]
        flags = tuple(word for word in words if re.match("-D|-I|-std|-isystem|/usr/include", word))
        groups.setdefault((target[1], source.parent.relative_to(top), flags), []).append(source)
    return groups


def check(group, scratch, top):
    (target, folder, flags), sources = group
    whole = scratch / f"{target}_{str(folder).replace('/', '_')}.cpp"
    whole.write_text("".join(f'#include "{source}"\n' for source in sources))
    done = subprocess.run(["clang++", *flags, "-w", "-ferror-limit=0", "-fsyntax-only", "-fno-caret-diagnostics", str(whole)],
                          capture_output=True, text=True, check=False)
    lines = [line.replace(f"{top}/", "") for line in done.stderr.splitlines() if ": error:" in line or "previous" in line]
    return "\n".join(lines) if done.returncode else ""


def main():
    commands, scratch, *folders = map(pathlib.Path, sys.argv[1:])
    top = pathlib.Path(__file__).resolve().parents[1]
    scratch.mkdir(parents=True, exist_ok=True)
    groups = [group for group in groups_of(commands, top).items() if len(group[1]) > 1 and (not folders or group[0][1] in folders)]
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        found = [text for text in pool.map(lambda group: check(group, scratch, top), groups) if text]
    print("\n".join(found) if found else f"{len(groups)} folders, each of which compiles as one")
    return 1 if found else 0


sys.exit(main())
