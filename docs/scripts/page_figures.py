#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Makes pages of some shells, measures them in a headless Chromium, and takes the pictures of docs/page.md.

    python3 docs/scripts/page_figures.py VDB_SHELL MESHES docs/page.md

MESHES is the folder of real meshes. Needs Debian's chromium. What is drawn is drawn by the processor, so a
computer with graphics of its own is quicker."""
import pathlib
import subprocess
import sys
import tempfile
import time

from browser import Browser

PROGRAM, MESHES, PAGE = sys.argv[1], pathlib.Path(sys.argv[2]), pathlib.Path(sys.argv[3])
ROOT = pathlib.Path(__file__).resolve().parents[2]
IMAGES = PAGE.parent / "images"
BEGIN, END = "<!-- figures: begin -->\n", "<!-- figures: end -->"
# what it is called, file, options
SHELLS = [("cow", MESHES / "artist/cow.obj", ["--repair", "--cut-crossings"]),
          ("cow, four layers", MESHES / "artist/cow.obj", ["--repair", "--cut-crossings", "--layers", "4"]),
          ("creature", ROOT / "samples/meshes/creature.obj", []),
          ("skull, a scan", MESHES / "scans/skull.obj", []),
          ("stanford-bunny, subdivided twice", MESHES / "artist/stanford-bunny.obj", ["--repair", "--subdivide", "2"])]
# picture, shell, what is set in the address, size, whether a vertex is clicked
PICTURES = [("page_creature.png", "creature", "#colour=depth&axis=x&view=50,16", (1280, 800), None),
            ("page_skull.png", "skull, a scan", "#colour=thickness&axis=x&theme=dark&edges=0", (1280, 800), (420, 420)),
            ("page_layers.png", "cow, four layers", "#colour=layer&axis=z&view=30,12", (1280, 800), None),
            ("page_phone.png", "creature", "#colour=stop&axis=none&view=40,12", (390, 844), None)]
CUT = """(() => { const slider = document.getElementById('cut'), times = [];
  document.querySelector('[data-axis=x]').click();
  for (let i = 1; i < 10; ++i) { slider.value = i / 10; const start = performance.now();
    slider.dispatchEvent(new Event('input', { bubbles: true })); times.push(performance.now() - start); }
  return times.sort((a, b) => a - b)[4]; })()"""
COUNTS = "document.querySelector('#title p').textContent"


def make(folder):
    pages = {}
    for name, mesh, options in SHELLS:
        shell, page = folder / f"{len(pages)}.vdb", folder / f"{len(pages)}.html"
        subprocess.run([PROGRAM, "build", mesh, "-q", *options, "-o", shell], check=True)
        seconds = []
        for _ in range(3):
            start = time.perf_counter()
            subprocess.run([PROGRAM, "convert", shell, "-o", page], check=True)
            seconds.append(time.perf_counter() - start)
        pages[name] = (page, min(seconds))
        shell.unlink()
    return pages


def table(browser, pages):
    rows = ["| shell | triangles | tets | page, MB | `convert`, s | first picture, s | a step of the cut, ms |",
            "|---|---|---|---|---|---|---|"]
    for name, (page, seconds) in pages.items():
        first = min(browser.open(page) for _ in range(3))
        counts = browser.evaluate(COUNTS).split(" \u00b7 ")
        cut = browser.evaluate(CUT)
        rows.append(f"| {name} | {counts[1].split()[0]} | {counts[2].split()[0]} | {page.stat().st_size / 1e6:.2f} | "
                    f"{seconds:.1f} | {first / 1000:.1f} | {cut:.0f} |")
    return "\n".join(rows) + "\n"


with tempfile.TemporaryDirectory() as name, Browser() as browser:
    pages = make(pathlib.Path(name))
    text = PAGE.read_text()
    before, rest = text.split(BEGIN)
    PAGE.write_text(before + BEGIN + table(browser, pages) + END + rest.split(END)[1])
    for picture, shell, address, size, click in PICTURES:
        browser.resize(*size, phone=size[0] < 700)
        browser.open(pages[shell][0], address)
        if click:
            browser.click(*click)
        (IMAGES / picture).write_bytes(browser.picture())
    if browser.console:
        sys.exit(f"the console says {browser.console}")
