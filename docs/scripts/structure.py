#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Figures about the structure of the sources, of one checkout or of several side by side.

    structure.py CHECKOUT [CHECKOUT ...] [--write PAGE]

Counts lines, comments, long files, long functions, constants of growth, includes against the order
of docs/architecture.md (of the last checkout: earlier ones may not have had one), and folders that
include each other in a circle. Functions are found by their braces at the level of a namespace:
exact for sources that clang-format has laid out. Files that know an option are those with its flag, or
the field of its struct, outside of comments. --write puts the table between the marks in PAGE.
"""
import argparse
import pathlib
import re

BEGIN, END = "<!-- structure: begin -->", "<!-- structure: end -->"
# --thickness, as an example of an option that many stages have to do with.
OPTION = re.compile(r"--thickness(?![-\w])|\b(?:line_step|options|o)\.thickness\b")
INCLUDE = re.compile(r'^\s*#include "(?:vdb_shell/)?([a-z_]+)/', re.M)


def sources(top):
    for base in (top / "src", top / "include" / "vdb_shell"):
        for path in sorted(base.rglob("*")):
            if path.suffix in (".h", ".cpp"):
                yield base, path


def room(base, path):
    parts = path.relative_to(base).parts
    return parts[0] if len(parts) > 1 else {"main.cpp": "command"}.get(parts[0], "pipeline")


def includes(top):
    for base, path in sources(top):
        for other in INCLUDE.findall(path.read_text()):
            if other != room(base, path) and other != "houdini":
                yield room(base, path), other


def in_circles(pairs):
    """Rooms from which includes lead back to them."""
    after = {}
    for a, b in pairs:
        after.setdefault(a, set()).add(b)
    circles = set()
    for start in after:
        seen, open_ = set(), list(after[start])
        while open_:
            at = open_.pop()
            if at not in seen:
                seen.add(at)
                open_ += after.get(at, ())
        if start in seen:
            circles.add(start)
    return circles


def functions(text):
    """(lines, first line) of each function body that begins with a brace in the first column, or of a member's."""
    lines = text.splitlines()
    for k, line in enumerate(lines):
        indent = re.match(r"( {0,4})\{$", line)
        if not indent or k == 0:
            continue
        head = lines[k - 1]
        if re.match(r"\s*(namespace|struct|class|enum|union|extern)\b", head) or not re.search(r"[);]$|const$|override$|noexcept$", head):
            continue
        end = next((e for e in range(k + 1, len(lines)) if lines[e] == indent[1] + "}"), None)
        if end:
            yield end - k - 1, k


def know_the_option(top):
    """Files of library, command and Houdini's side."""
    paths = [path for _, path in sources(top)]
    paths += [p for p in (top / "houdini_compat").rglob("*") if p.suffix in (".h", ".cpp", ".py")]
    code = ["\n".join(line.split("//")[0] for line in path.read_text().splitlines()) for path in paths]
    return sum(bool(OPTION.search(text)) for text in code)


def figures(top, order):
    code = comments = long_files = long_functions = longest = 0
    for _, path in sources(top):
        text = path.read_text()
        long_files += text.count("\n") > 400
        lengths = [n for n, _ in functions(text)]
        long_functions += sum(n > 40 for n in lengths)
        longest = max([longest, *lengths])
        if path.suffix == ".cpp":
            filled = [line.strip() for line in text.splitlines() if line.strip()]
            code += len(filled)
            comments += sum(line.startswith("//") for line in filled)
    growth = top / "src/growth" if (top / "src/growth").exists() else top / "src/shell/grow"
    constants = [p for p in growth.rglob("*") if p.suffix in (".h", ".cpp")]
    if growth.name == "grow":
        constants.append(top / "src/shell/grow.cpp")
    pairs = list(includes(top))
    place = {name: k for k, name in enumerate(order)}
    known = [(a, b) for a, b in pairs if a in place and b in place]
    return {
        "lines of library and command": sum(p.read_text().count("\n") for _, p in sources(top)),
        "comment lines in sources, %": round(100 * comments / code, 1),
        "files over 400 lines": long_files,
        "functions over 40 lines": long_functions,
        "longest function, lines": longest,
        "constants in growth": sum(len(re.findall(r"^\s*(?:static |inline )*constexpr (?!.*\()", p.read_text(), re.M)) for p in constants),
        "files that know `--thickness`": know_the_option(top),
        "includes against the order": sum(place[b] > place[a] for a, b in known),
        "rooms in a circle of includes": len(in_circles(pairs)),
    }


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("checkouts", type=pathlib.Path, nargs="+")
    parser.add_argument("--write", type=pathlib.Path)
    arguments = parser.parse_args()
    tops = arguments.checkouts
    page = (tops[-1] / "docs/architecture.md").read_text()
    order = re.search(r"```rooms\n\s*rooms:([^`]*)```", page)[1].split()
    columns = [figures(top, order) for top in tops]
    rows = [f"| {name} | " + " | ".join(str(column[name]) for column in columns) + " |" for name in columns[0]]
    if not arguments.write:
        print("\n".join(rows))
        return
    before, _, rest = arguments.write.read_text().partition(BEGIN)
    heads = ["| | before | after |", "|---|---|---|"]
    arguments.write.write_text("\n".join([before + BEGIN, *heads, *rows, END]) + rest.partition(END)[2])


if __name__ == "__main__":
    main()
