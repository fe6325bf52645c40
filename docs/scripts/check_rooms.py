#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks that includes go from later rooms to earlier ones only.

    check_rooms.py FOLDER

The order of the rooms is the fenced block marked ```rooms in docs/architecture.md. A room may include itself and rooms
before it; a folder of src or include/vdb_shell that is no room is an error, and so is an include of houdini_compat's
private headers, or of the command's, from elsewhere. houdini_compat includes public headers of any room.
Prints each include against the order and ends with status 1, or says how many includes there are.
"""
import pathlib
import re
import sys

BLOCK = re.compile(r"^```rooms\n\s*rooms:([^`]*)```", re.MULTILINE)
INCLUDE = re.compile(r'^\s*#\s*include\s+["<](vdb_shell/)?([a-z_]+(?:/[\w/]+)?\.h)[">]')
# Files that stand in no folder of their own.
PLACED = {"pipeline.h": "pipeline", "main.cpp": "command"}
BESIDE = {"houdini"}


def room_of(path, base):
    place = path.relative_to(base)
    return place.parts[0] if len(place.parts) > 1 else PLACED.get(place.name, place.name)


def against_order(path, base, folder, rooms):
    """Number of includes of a file, and those against the order, a line each."""
    room, count, wrong = room_of(path, base), 0, []
    where = path.relative_to(folder)
    if room not in rooms:
        return 0, [f"{where}: {room} is no room of docs/architecture.md"]
    for number, line in enumerate(path.read_text().splitlines(), 1):
        include = INCLUDE.match(line)
        if not include or not (include[1] or '"' in line):
            continue
        parts = include[2].split("/")
        if len(parts) == 1 and not include[1]:
            continue
        other = parts[0] if len(parts) > 1 else PLACED.get(parts[0], parts[0])
        if other in BESIDE:
            if room != "command":
                wrong.append(f"{where}:{number}: only the command includes {line.strip()}")
            continue
        count += 1
        if other not in rooms:
            wrong.append(f"{where}:{number}: {line.strip()}: no such room")
        elif rooms.index(other) > rooms.index(room):
            wrong.append(f"{where}:{number}: {room} includes {line.strip()}, a later room")
    return count, wrong


def against_privacy(path, folder):
    """houdini_compat's includes of headers that the library does not install."""
    own = {header.name for header in (folder / "houdini_compat" / "src").glob("*.h")}
    wrong = []
    for number, line in enumerate(path.read_text().splitlines(), 1):
        include = re.match(r'^\s*#\s*include\s+"([^"]+)"', line)
        if include and not include[1].startswith("vdb_shell/") and include[1] not in own:
            wrong.append(f"{path.relative_to(folder)}:{number}: houdini_compat includes a private header: {line.strip()}")
    return wrong


def sources(base):
    return sorted(path for path in base.rglob("*") if path.suffix in (".h", ".cpp"))


def main():
    folder = pathlib.Path(sys.argv[1]).resolve()
    found = BLOCK.search((folder / "docs" / "architecture.md").read_text())
    if not found:
        print("docs/architecture.md has no block ```rooms")
        return 1
    rooms, count, wrong = found[1].split(), 0, []
    for base in (folder / "src", folder / "include" / "vdb_shell"):
        for path in sources(base):
            number, lines = against_order(path, base, folder, rooms)
            count += number
            wrong += lines
    for path in sources(folder / "houdini_compat"):
        wrong += against_privacy(path, folder)
    print("\n".join(wrong) if wrong else f"{count} includes in {len(rooms)} rooms, none against the order")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
