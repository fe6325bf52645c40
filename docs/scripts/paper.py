#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Makes all figures, tables and numbers of docs/paper: what the paper shows and says, measured.

    paper.py COMMAND MESHES JUDGING docs/paper [--plane-lines PROGRAM] [--parts figure_1 ...]

COMMAND is the vdb_shell binary, MESHES the folder with paper/ and artist/. JUDGING holds, at any depth, the meshes of
odedstein-meshes that paper_halves.py names: nothing was tuned with them. PROGRAM is plane_lines, built with
-DVDB_SHELL_BENCHMARKS=ON; by default the one of COMMAND's build folder. Each part writes NAME.json and its pictures; then the
pages' numbers and tables are put in from all files that are there. It needs numpy for figure_1.
"""
import argparse
import json
import pathlib
import resource
import tempfile
import time

import paper_figure_2
import paper_figure_3
import paper_figures_4_5
import paper_sentences
from paper_halves import ALL_MESHES, Meshes
from paper_pages import write_pages


def figure_1(arguments, scratch):
    import paper_figure_1  # here, so that the other parts need no numpy
    program = arguments.plane_lines or pathlib.Path(arguments.command).resolve().parent.parent / "tests" / "plane_lines"
    return paper_figure_1.make(str(program), scratch, arguments.folder)


PARTS = {"figure_1": figure_1,
         "figure_2": lambda a, scratch: paper_figure_2.make(a.command, scratch, a.folder),
         "figure_3": lambda a, scratch: paper_figure_3.make(a.command, scratch, a.folder),
         "figures_4_5": lambda a, scratch: paper_figures_4_5.make(a.command, a.files, a.folder),
         "sentences": lambda a, scratch: paper_sentences.make(a.command, a.files),
         "cost": lambda a, scratch: paper_sentences.make_cost(a.command, a.files)}


def processor_seconds():
    """Of this process and of all runs of the command that have ended."""
    used = [resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
    return sum(one.ru_utime + one.ru_stime for one in used)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("command")
    parser.add_argument("meshes", type=pathlib.Path)
    parser.add_argument("judging", type=pathlib.Path)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--plane-lines")
    parser.add_argument("--parts", nargs="*", choices=list(PARTS), default=list(PARTS))
    arguments = parser.parse_args()
    arguments.files = Meshes(arguments.meshes, arguments.judging)
    if set(arguments.parts) & {"figures_4_5", "sentences", "cost"}:
        for name in ALL_MESHES:
            arguments.files.path(name)  # what is missing is told now, not after minutes
    (arguments.folder / "images").mkdir(parents=True, exist_ok=True)
    for name in arguments.parts:
        before, spent = time.monotonic(), processor_seconds()
        with tempfile.TemporaryDirectory() as scratch:
            answer = PARTS[name](arguments, pathlib.Path(scratch))
        answer["wall_seconds"] = round(time.monotonic() - before)
        answer["processor_seconds"] = round(processor_seconds() - spent)
        (arguments.folder / f"{name}.json").write_text(json.dumps(answer, indent=1) + "\n")
        print(f"{name}: {answer['wall_seconds']} s, {answer['processor_seconds']} s of processor time", flush=True)
    write_pages(arguments.folder)


if __name__ == "__main__":
    main()
