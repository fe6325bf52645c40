#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes what `--help` and `options` say into docs/command_line.md, between its markers.

    command_line.py COMMAND docs/command_line.md
"""
import pathlib
import subprocess
import sys

command, page = sys.argv[1], pathlib.Path(sys.argv[2])
begin, end = "<!-- help: begin -->", "<!-- help: end -->"
text = page.read_text()
blocks = []
for subcommand in ([], ["build"], ["inspect"], ["repair"], ["pose"], ["volumes"], ["deform"], ["map"], ["page"], ["usd"], ["info"], ["convert"], ["check"], ["compare"], ["estimate"], ["farm"], ["join"], ["doctor"], ["options"]):
    out = subprocess.run([command, *subcommand, "--help"], capture_output=True, text=True, check=True).stdout
    blocks.append("## " + " ".join(["vdb_shell", *subcommand]) + "\n\n```\n" + out + "```\n")
table = subprocess.run([command, "options"], capture_output=True, text=True, check=True).stdout
blocks.append("## Options of build, in files too\n\nWhat `vdb_shell options` prints. [options.md](options.md) "
              "has more on files of options.\n\n" + table)
page.write_text(text[:text.index(begin) + len(begin)] + "\n\n" + "\n".join(blocks) + "\n" + text[text.index(end):])
