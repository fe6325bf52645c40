#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks that every relative link in the project's pages leads somewhere.

    check_links.py FOLDER

Looks at each .md below FOLDER but those in build folders: the file or folder that a link or picture names exists, and
a page that it names with an anchor (`page.md#section`) has a heading of that name. Links to the web are not looked up.
Prints what is broken and ends with status 1, or says how many links there are.
"""
import pathlib
import re
import sys

LINK = re.compile(r"\[(?:[^\[\]]|\[[^\]]*\])*\]\(\s*<?([^)\s>]+)>?(?:\s+\"[^\"]*\")?\s*\)")
FENCE = re.compile(r"^(```|~~~).*?^\1\s*$", re.MULTILINE | re.DOTALL)
SKIPPED = {".git", "build", "node_modules"}


def pages(folder):
    return sorted(path for path in folder.rglob("*.md")
                  if not SKIPPED & set(path.relative_to(folder).parts))


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


def main():
    folder = pathlib.Path(sys.argv[1]).resolve()
    count, broken = 0, []
    for page in pages(folder):
        for line, address in links(page):
            if re.match(r"[a-z][a-z0-9+.-]*:", address):
                continue
            count += 1
            wrong = fault(folder, page, address)
            if wrong:
                broken.append(f"{page.relative_to(folder)}:{line}: {address}: {wrong}")
    print("\n".join(broken) if broken else f"{count} links, all of them lead somewhere")
    return 1 if broken else 0


if __name__ == "__main__":
    sys.exit(main())
