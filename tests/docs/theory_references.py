#!/usr/bin/env python3
"""Every reference to docs/theory.md names something that is there.

    theory_references.py FOLDER

Sources cite by title, as in: docs/theory.md, "Separating planes". A title is a heading of the page,
without its number, or the bold words that begin one of its paragraphs; it may run over the end of a
comment's line. Pages link to headings, as in [theory.md](theory.md#7-growth), and so does the page
itself. Numbers of sections are not cited: they change. FOLDER is that of the project.
"""
import pathlib
import re
import sys

SOURCES = "src include houdini_compat samples tests docs/scripts".split()
SUFFIXES = (".h", ".cpp", ".py", ".cmake", ".txt", ".in", ".sh")


def titles_of(page):
    headings = [re.sub(r"^\d+\. ", "", h) for h in re.findall(r"^#+ (.+)$", page, re.M)]
    return set(headings) | set(re.findall(r"^(?:- )?\*\*(.+?)\.\*\*", page, re.M))


def anchors_of(page):
    """Those that GitHub gives the headings."""
    return {re.sub(r"[^\w\- ]", "", h.lower()).replace(" ", "-") for h in re.findall(r"^#+ (.+)$", page, re.M)}


def unwrapped(text):
    """Comments as running text."""
    return re.sub(r"\s*\n\s*(?:///?<?|#)?\s*", " ", text)


def faults_in_source(text, titles):
    for cited in re.finditer(r"docs/theory\.md(.{0,120})", unwrapped(text)):
        title = re.match(r', "([^"]+)"', cited[1])
        if not title:
            yield f"no title after: docs/theory.md{cited[1][:40]}"
        elif title[1] not in titles:
            yield f"no such title: {title[1]}"


def faults_in_page(text, anchors, is_theory):
    link = r"\]\(#([^)]*)\)" if is_theory else r"\]\((?:docs/)?theory\.md#([^)]*)\)"
    for anchor in re.findall(link, text):
        if anchor not in anchors:
            yield f"no such heading: #{anchor}"
    number = r"(?<!pipeline\.md\)), section \d|\([Ss]ection \d" if is_theory else r"theory\.md\)?,? section \d"
    for cited in re.findall(number, text):
        yield f"cites a number: {cited}"


def main():
    folder = pathlib.Path(sys.argv[1])
    theory = folder / "docs" / "theory.md"
    page = theory.read_text()
    titles, anchors = titles_of(page), anchors_of(page)
    this = pathlib.Path(__file__).resolve()
    faults, cited = [], 0
    for path in sorted(p for s in SOURCES for p in (folder / s).rglob("*") if p.suffix in SUFFIXES):
        if path.resolve() == this:
            continue
        text = path.read_text()
        cited += text.count("docs/theory.md")
        faults += [f"{path}: {fault}" for fault in faults_in_source(text, titles)]
    for path in [folder / "README.md", folder / "CHANGELOG.md", *sorted((folder / "docs").rglob("*.md"))]:
        faults += [f"{path}: {fault}" for fault in faults_in_page(path.read_text(), anchors, path == theory)]
    print("\n".join(faults) or f"{cited} references in sources, all of them to titles that are there")
    return 1 if faults or cited == 0 else 0


if __name__ == "__main__":
    sys.exit(main())
