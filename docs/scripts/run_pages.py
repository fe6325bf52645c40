#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs the commands of the tutorial and the recipes, so that a page that no longer works is found out.

    run_pages.py COMMAND PROJECT_FOLDER [--pages PAGE ...] [--timeout SECONDS] [--pictures]

Runs each fenced block whose first line is ```sh run in docs/tutorial.md and docs/recipes/*.md, one page after another,
each in an empty folder of its own with `samples` of the project in it and COMMAND on the PATH as vdb_shell. Blocks of a
page share their folder. A word after `run` says more about a block:

    status=7        its last command ends with this status; 0 where nothing is said
    needs=NAME      it is left out where the program NAME is missing
    module=NAME     it is left out where python3 has no module NAME

With --pictures the .png files that blocks have written go where their page shows files of the same names.

Ends with status 1 if a block ends with another status than it should, and prints what that block printed.
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

BLOCK = re.compile(r"^```sh run([^\n]*)\n(.*?)^```\s*$", re.MULTILINE | re.DOTALL)


def blocks(page):
    """Line number, words after `run` and text of each block to run."""
    text = page.read_text()
    for found in BLOCK.finditer(text):
        words = dict(word.split("=", 1) for word in found[1].split())
        yield text.count("\n", 0, found.start()) + 1, words, found[2]


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


def run_page(page, project, command, timeout, pictures):
    """Numbers of blocks that ran, were left out, and failed."""
    counts = [0, 0, 0]
    with tempfile.TemporaryDirectory(prefix="vdb_shell_page_") as name:
        env = environment(pathlib.Path(name), command)
        work = pathlib.Path(name) / "work"
        work.mkdir()
        (work / "samples").symlink_to(project / "samples")
        for line, words, text in blocks(page):
            where = f"{page.relative_to(project)}:{line}"
            lacking = missing(words, env)
            if lacking:
                print(f"{where}: left out, {lacking} is missing")
                counts[1] += 1
                continue
            began = time.monotonic()
            status, printed = run_block(text, work, env, timeout)
            print(f"{where}: {time.monotonic() - began:.1f} s")
            counts[0] += 1
            wanted = int(words.get("status", 0))
            if status != wanted:
                print(f"{where}: ended with {status}, not {wanted}:\n{printed}")
                counts[2] += 1
        if pictures:
            take_pictures(page, work)
    return counts


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("command", type=pathlib.Path)
    parser.add_argument("project", type=pathlib.Path)
    parser.add_argument("--pages", nargs="+", type=pathlib.Path)
    parser.add_argument("--timeout", type=float, default=120, help="seconds for one block")
    parser.add_argument("--pictures", action="store_true", help="keep those that the pages show")
    given = parser.parse_args()
    project, command = given.project.resolve(), given.command.resolve()
    pages = given.pages or [project / "docs" / "tutorial.md", *sorted((project / "docs" / "recipes").glob("*.md"))]
    totals = [0, 0, 0]
    for page in pages:
        totals = [sum(pair) for pair in zip(totals, run_page(page.resolve(), project, command, given.timeout, given.pictures))]
    print(f"{totals[0]} blocks ran, {totals[1]} were left out, {totals[2]} failed")
    return 1 if totals[2] or not totals[0] else 0


if __name__ == "__main__":
    sys.exit(main())
