#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Makes a shell, lets it move, renders the frames with Blender without a window, and looks at the sheet.

    render_soft_body.py COMMAND SOFT_BODY MESH SCRIPT

SCRIPT is samples/soft_body/render.py. Exit status: 0 when each picture of the sheet shows a body, 1 when not, 77 when
Blender is not there.
"""
import json
import os
import shutil
import subprocess
import sys
import tempfile

from render_in_blender import read_png, seen

SIZE, COLUMNS, SECONDS = 64, 2, .25


def main():
    command, soft_body, mesh, script = sys.argv[1:]
    failures = []
    with tempfile.TemporaryDirectory() as folder:
        shell, frames, sheet = (os.path.join(folder, name) for name in ("shell.vdb", "frames", "sheet.png"))
        subprocess.run([command, "build", mesh, "--resolution", "32", "-q", "-o", shell], check=True)
        done = subprocess.run([soft_body, shell, "--motion", frames, "--seconds", str(SECONDS)], check=True,
                              capture_output=True, text=True)
        facts = json.loads(done.stdout)
        if not facts["converged"] or facts["frames"] != 24 * SECONDS + 1 or len(os.listdir(frames)) != facts["frames"]:
            failures.append(f"unexpected: {facts}")
        missing = subprocess.run([soft_body, os.path.join(folder, "none.vdb")], capture_output=True, text=True)
        if missing.returncode != 1 or "none.vdb" not in missing.stderr:
            failures.append(f"a missing file: {missing.returncode} {missing.stderr}")
        if failures or shutil.which("blender") is None:
            print("\n".join(failures) or "Blender is not there")
            return 1 if failures else 77
        subprocess.run(["blender", "--background", "--factory-startup", "--python-exit-code", "1", "--python", script,
                        "--", sheet, frames, "--columns", str(COLUMNS), "--size", str(SIZE), "--samples", "4"],
                       check=True, capture_output=True, text=True, timeout=500)
        rows = read_png(sheet)
        if (len(rows[0]), len(rows)) != (COLUMNS * SIZE, SIZE):
            failures.append(f"the sheet has {len(rows[0])} x {len(rows)} pixels")
        for column in range(COLUMNS):
            share, colour = seen(rows, range(column * SIZE, (column + 1) * SIZE))
            print(f"picture {column}: covers {share:.1%}, mean colour {[round(c) for c in colour]}")
            if not .1 < share or colour[0] < colour[2]:  # the body is reddish
                failures.append(f"picture {column} shows no body")
    for failure in failures:
        print("FAILED: " + failure)
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
