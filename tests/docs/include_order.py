#!/usr/bin/env python3
"""include_order.py CHECKOUT: includes go from later rooms to earlier ones only.

The order is the fenced block marked ```rooms in docs/architecture.md. houdini_compat stands beside
the rooms: it may include what is public and its own, and only `command` may include it. Prints every
include against the order and exits with 1 if there is one.
"""
import pathlib
import re
import sys

INCLUDE = re.compile(r'\s*#include\s+["<]((?:vdb_shell/)?[\w/]+\.h)[">]')
HOUDINI = "houdini"


def rooms_of(page):
    block = re.search(r"```rooms\n(.*?)```", page.read_text(), re.S)
    if not block:
        sys.exit(f"{page}: no block marked ```rooms")
    return block[1].split()


def room_of_file(path, order):
    """The room of a source or header below src/ or include/vdb_shell/."""
    if len(path.parts) > 1:
        return path.parts[0]
    # The library's front header, and main.
    return {"pipeline.h": "pipeline", "main.cpp": "command"}.get(path.name, order[0])


def room_of_include(name):
    parts = name.split("/")
    public = parts[0] == "vdb_shell"
    parts = parts[1:] if public else parts
    if len(parts) == 1:
        return "pipeline" if public and parts[0] == "pipeline.h" else None
    return parts[0]


def main():
    top = pathlib.Path(sys.argv[1])
    order = rooms_of(top / "docs/architecture.md")
    place = {room: k for k, room in enumerate(order)}
    against = []
    files = 0
    for base in (top / "src", top / "include/vdb_shell"):
        for path in sorted(base.rglob("*")):
            if path.suffix not in (".h", ".cpp"):
                continue
            files += 1
            room = room_of_file(path.relative_to(base), order)
            if room not in place:
                against.append(f"{path.relative_to(top)}: the room {room} is not in the order")
                continue
            for line in path.read_text().splitlines():
                found = INCLUDE.match(line)
                other = room_of_include(found[1]) if found else None
                if other == HOUDINI:
                    if room != "command":
                        against.append(f"{path.relative_to(top)}: {line.strip()}")
                elif other and place.get(other, len(order)) > place[room]:
                    against.append(f"{path.relative_to(top)}: {line.strip()}")
    for path in sorted((top / "houdini_compat").rglob("*")):
        if path.suffix not in (".h", ".cpp"):
            continue
        for line in path.read_text().splitlines():
            found = INCLUDE.match(line)
            if found and not found[1].startswith("vdb_shell/") and "/" in found[1]:
                against.append(f"{path.relative_to(top)}: {line.strip()} is not public")
    print("\n".join(against))
    print(f"{files} files in {len(order)} rooms, {len(against)} includes against the order")
    return 1 if against or files == 0 else 0


if __name__ == "__main__":
    sys.exit(main())
