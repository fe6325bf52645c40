#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks that every relative link in the project's pages leads somewhere.

    check_links.py FOLDER

Looks at each .md below FOLDER but those in build folders: the file or folder that a link or picture names exists, and
a page that it names with an anchor (`page.md#section`) has a heading of that name. Links to the web are not looked up.
Pages that a source or a script names by their path must exist as well, and so must what a page names in backticks by
a path that begins with a folder of the project (`src/main.cpp`), but for patterns (`src/*.h`) and placeholders (`tests/NAME_test.cpp`).
Prints what is broken and ends with status 1, or says how many links there are.
"""
import os
import pathlib
import re
import sys

LINK = re.compile(r"\[(?:[^\[\]]|\[[^\]]*\])*\]\(\s*<?([^)\s>]+)>?(?:\s+\"[^\"]*\")?\s*\)")
FENCE = re.compile(r"^(```|~~~).*?^\1\s*$", re.MULTILINE | re.DOTALL)
CODE = re.compile(r"(?<!`)`([^`]+)`(?!`)")
PLACE = re.compile(r"(?:src|include|tests|docs|samples|houdini_compat)/[^\s:,;()]*")
PATTERN = re.compile(r"[*?<>{}$]|\.\.\.|(?<![A-Za-z])[A-Z][A-Z_]+(?![A-Za-z0-9.])")
MENTION = re.compile(r"(?<![\w./-])docs/[\w/]+\.(?:md|py)\b")
SOURCES = {".h", ".cpp", ".py", ".sh", ".cmake", ".txt", ".json"}
SKIPPED = {".git", ".cache", "node_modules"}


def files(folder):
    for place, folders, names in os.walk(folder):
        folders[:] = sorted(name for name in folders if name not in SKIPPED and not name.startswith("build"))
        yield from (pathlib.Path(place) / name for name in sorted(names))


def mentions(source):
    """Line number and path of each page or script that a source names."""
    for number, line in enumerate(source.read_text(errors="replace").splitlines(), 1):
        for found in MENTION.finditer(line):
            yield number, found[0]


def places(page):
    """Line number and path of each place in the project that a page names in backticks."""
    text = FENCE.sub(lambda block: "\n" * block[0].count("\n"), page.read_text())
    for number, line in enumerate(text.splitlines(), 1):
        if line.startswith("    "):
            continue
        for code in CODE.findall(line):
            found = PLACE.match(code)
            if found and not PATTERN.search(found[0]):
                yield number, found[0]


def anchors(page):
    """The anchors that GitHub and GitLab give a page's headings: lower case, punctuation left out, blanks to hyphens;
    a heading that comes again gets a number."""
    found = set()
    for line in FENCE.sub("", page.read_text()).splitlines():
        heading = re.match(r"#{1,6}\s+(.*?)\s*#*$", line)
        if not heading:
            continue
        text = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading[1])
        name = re.sub(r"[^\w\- ]", "", text.lower()).replace(" ", "-")
        number = 1
        unique = name
        while unique in found:
            unique = f"{name}-{number}"
            number += 1
        found.add(unique)
    return found


def links(page):
    """Line number and address of each link outside code."""
    text = FENCE.sub(lambda block: "\n" * block[0].count("\n"), page.read_text())
    for number, line in enumerate(text.splitlines(), 1):
        if line.startswith("    "):
            continue
        for found in LINK.finditer(re.sub(r"(?<!\[)`[^`]*`(?!\])", "", line)):
            yield number, found[1]


def fault(folder, page, address):
    """What is wrong with a link, or nothing."""
    path, _, anchor = address.partition("#")
    target = (page.parent / path).resolve() if path else page
    if not target.exists():
        return "no such file"
    if folder != target and folder not in target.parents:
        return "leads out of the project"
    if anchor and target.suffix == ".md" and anchor not in anchors(target):
        return "no such heading"
    return None


def broken_in(folder, path):
    """How many links a file has, and what is wrong with them, a line each."""
    count, broken = 0, []
    place = path.relative_to(folder)
    if path.suffix == ".md":
        for line, address in links(path):
            if re.match(r"[a-z][a-z0-9+.-]*:", address):
                continue
            count += 1
            wrong = fault(folder, path, address)
            if wrong:
                broken.append(f"{place}:{line}: {address}: {wrong}")
        for line, named in places(path):
            count += 1
            if not (folder / named).exists():
                broken.append(f"{place}:{line}: `{named}`: no such file")
    elif path.suffix in SOURCES:
        for line, page in mentions(path):
            count += 1
            if not (folder / page).exists():
                broken.append(f"{place}:{line}: {page}: no such file")
    return count, broken


def main():
    folder = pathlib.Path(sys.argv[1]).resolve()
    found = [broken_in(folder, path) for path in files(folder)]
    broken = [line for _, lines in found for line in lines]
    count = sum(number for number, _ in found)
    print("\n".join(broken) if broken else f"{count} links, all of them lead somewhere")
    return 1 if broken else 0


if __name__ == "__main__":
    sys.exit(main())
