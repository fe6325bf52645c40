#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs the commands of the tutorial and the recipes, so that a page that no longer works is found out.

    run_pages.py COMMAND PROJECT_FOLDER [--pages PAGE ...] [--timeout SECONDS] [--pictures] [--outputs]

Runs each fenced block whose first line is ```sh run in docs/tutorial.md and docs/recipes/*.md, one page after another,
each in an empty folder of its own with `samples` of the project in it and COMMAND on the PATH as vdb_shell. Blocks of a
page share their folder. A word after `run` says more about a block:

    status=7        its last command ends with this status; 0 where nothing is said
    needs=NAME      it is left out where the program NAME is missing
    module=NAME     it is left out where python3 has no module NAME

What a page shows in the next fenced block that names no language is what the commands print: each of its lines has to be
among them, in this order, with anything where it says "...". Times and memory belong into a block ```text, which is not
compared.

With --pictures the .png files that blocks have written go where their page shows files of the same names; with --outputs the
lines shown that are no longer printed make way for those that begin alike.

Ends with status 1 if a block ends with another status than it should, and prints what that block printed, or if a page shows
a line that is not printed.
"""
import argparse
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import time

BLOCK = re.compile(r"^```([^\n]*)\n(.*?)^```\s*$", re.MULTILINE | re.DOTALL)


def blocks(page):
    """Line number, words after `run` and text of each block to run, and the lines that the page shows of its output."""
    text = page.read_text()
    found = list(BLOCK.finditer(text))
    for block, after in zip(found, found[1:] + [None]):
        if not block[1].startswith("sh run"):
            continue
        words = dict(word.split("=", 1) for word in block[1].split()[2:])
        shown = after[2].splitlines() if after and not after[1] else []
        yield text.count("\n", 0, block.start()) + 1, words, block[2], shown


def is_shown_as(shown, printed):
    """Whether a line that is printed is the one shown, "..." standing for anything."""
    return re.fullmatch(".*".join(map(re.escape, shown.rstrip().split("..."))), printed.rstrip()) is not None


def kind_of(line):
    """How a line begins, whatever its numbers are."""
    return re.sub(r"\d+", "0", line)[:10].rstrip()


def cut_like(shown, printed):
    """The line that is printed, cut at the same comma as the one shown."""
    if not shown.endswith("..."):
        return printed.rstrip()
    return ", ".join(printed.split(", ")[:shown.count(", ")] + ["..."])


def compare(shown, printed):
    """[(line shown that is not printed, what is printed in its place, or nothing)], each line looked for after the last."""
    lines, at, differing = printed.splitlines(), 0, []
    for line in (line for line in shown if line.strip(" .")):
        same = next((i for i in range(at, len(lines)) if is_shown_as(line, lines[i])), None)
        if same is None:
            same = next((i for i in range(at, len(lines)) if kind_of(lines[i]) == kind_of(line)), None)
            differing.append((line, None if same is None else cut_like(line, lines[same])))
        at = at if same is None else same + 1
    return differing


def environment(folder, command):
    """COMMAND first on the PATH, then the folder of the Python that runs this."""
    programs = folder / "programs"
    programs.mkdir()
    (programs / "vdb_shell").symlink_to(command)
    (programs / "python3").symlink_to(sys.executable)
    return {**os.environ, "PATH": f"{programs}{os.pathsep}{os.environ.get('PATH', os.defpath)}"}


def missing(words, env):
    """What a block needs and does not find, or nothing."""
    if "needs" in words and not shutil.which(words["needs"], path=env["PATH"]):
        return words["needs"]
    if "module" in words:
        found = subprocess.run(["python3", "-c", f"import {words['module']}"], env=env, capture_output=True)
        if found.returncode != 0:
            return f"Python's module {words['module']}"
    return None


def run_block(text, work, env, timeout):
    """Exit status, or what stood in its place, and what was printed."""
    try:
        done = subprocess.run(["bash", "-e", "-c", text], cwd=work, env=env, timeout=timeout, text=True,
                              stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    except subprocess.TimeoutExpired:
        return f"no status within {timeout:g} s", ""
    return done.returncode, done.stdout


def take_pictures(page, work):
    for shown in re.findall(r"!\[[^]]*\]\(([^)]*\.png)\)", page.read_text()):
        made = work / pathlib.Path(shown).name
        if made.exists():
            shutil.copy(made, page.parent / shown)


def report_differing(where, differing):
    for line, now in differing:
        print(f"{where}: the page shows\n    {line}\nand printed is\n    {'no such line' if now is None else now}")


def run_page(page, project, command, given):
    """Numbers of blocks that ran, were left out, and failed."""
    counts = [0, 0, 0]
    corrections = []
    with tempfile.TemporaryDirectory(prefix="vdb_shell_page_") as name:
        env = environment(pathlib.Path(name), command)
        work = pathlib.Path(name) / "work"
        work.mkdir()
        (work / "samples").symlink_to(project / "samples")
        for line, words, text, shown in blocks(page):
            where = f"{page.relative_to(project)}:{line}"
            lacking = missing(words, env)
            if lacking:
                print(f"{where}: left out, {lacking} is missing")
                counts[1] += 1
                continue
            began = time.monotonic()
            status, printed = run_block(text, work, env, given.timeout)
            print(f"{where}: {time.monotonic() - began:.1f} s")
            counts[0] += 1
            wanted = int(words.get("status", 0))
            if status != wanted:
                print(f"{where}: ended with {status}, not {wanted}:\n{printed}")
                counts[2] += 1
                continue
            differing = compare(shown, printed)
            if given.outputs:
                corrections += [pair for pair in differing if pair[1] is not None]
                differing = [pair for pair in differing if pair[1] is None]
            report_differing(where, differing)
            counts[2] += bool(differing)
        if given.pictures:
            take_pictures(page, work)
    for line, now in corrections:
        page.write_text(page.read_text().replace(f"\n{line}\n", f"\n{now}\n", 1))
    return counts


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("command", type=pathlib.Path)
    parser.add_argument("project", type=pathlib.Path)
    parser.add_argument("--pages", nargs="+", type=pathlib.Path)
    parser.add_argument("--timeout", type=float, default=120, help="seconds for one block")
    parser.add_argument("--pictures", action="store_true", help="keep those that the pages show")
    parser.add_argument("--outputs", action="store_true", help="put what is printed into the pages")
    given = parser.parse_args()
    project, command = given.project.resolve(), given.command.resolve()
    pages = given.pages or [project / "docs" / "tutorial.md", *sorted((project / "docs" / "recipes").glob("*.md"))]
    totals = [0, 0, 0]
    for page in pages:
        totals = [sum(pair) for pair in zip(totals, run_page(page.resolve(), project, command, given))]
    print(f"{totals[0]} blocks ran, {totals[1]} were left out, {totals[2]} failed")
    return 1 if totals[2] or not totals[0] else 0


if __name__ == "__main__":
    sys.exit(main())
