#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Frames at once where the system gives too few threads: threads.py COMMAND MESH FAIL_THREADS.so

Whatever number of threads can be made, all frames are done, with the bytes that one thread gives.
Libraries make threads before the command begins; a run that those end says nothing of the command,
and is passed over."""
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

FRAMES, AT_ONCE, MOST = 5, 3, 40


def main():
    command, mesh, library = sys.argv[1:]
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        log = folder / "log"
        for frame in range(1, FRAMES + 1):
            shutil.copy(mesh, folder / f"s.{frame}.obj")

        def frames_with(threads):
            line = [command, "build", str(folder / "s.#.obj"), "-q", "--resolution", "12", "--samples", "0", "-o",
                    str(folder / f"t{threads}.#.vtu"), "--frames", f"1-{FRAMES}", "--frames-at-once", str(AT_ONCE)]
            extra = {"LD_PRELOAD": library, "FAULT_THREADS": str(threads), "FAULT_LOG": str(log)}
            log.unlink(missing_ok=True)
            done = subprocess.run(line, env={**os.environ, **extra}, capture_output=True, text=True, timeout=120)
            return done, len(log.read_text().splitlines()) if log.exists() else 0

        seen = []
        for threads in range(MOST):
            done, refused = frames_with(threads)
            if "frame 1: done" not in done.stderr:
                continue
            said = f"{threads} threads, {refused} refused: status {done.returncode}, {done.stderr!r}"
            if done.returncode != 0 or f"{FRAMES} of {FRAMES} frames done" not in done.stderr:
                sys.exit(said)
            made = [(folder / f"t{threads}.{frame}.vtu").read_bytes() for frame in range(1, FRAMES + 1)]
            if len(set(made)) != 1:
                sys.exit(f"{said}: frames of one mesh differ")
            seen.append(refused)
            if refused == 0:
                break
        # None at all, some, and all of them: one is refused and the command asks for no more.
        if seen != [1] * AT_ONCE + [0]:
            sys.exit(f"refused threads were {seen}, must be {[1] * AT_ONCE + [0]}")
        print(f"with none to {AT_ONCE} threads all of {FRAMES} frames were done")


main()
