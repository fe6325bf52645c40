#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Seconds for a sequence of frames one after the other and several at once, for docs/frames.md.

    frames_at_once.py COMMAND [--frames 20] [--triangles 1000 10000 100000] [--at-once 2]

The frames are a torus whose tube swells and shrinks along its round. Both ways are run in turn, twice; the better time counts.
"""
import argparse
import math
import pathlib
import subprocess
import tempfile
import time


def write_torus(path, triangles, phase):
    across = round(math.sqrt(triangles / 2.5))
    around = triangles // (2 * across)
    points, faces = [], []
    for i in range(around):
        u = 2 * math.pi * i / around
        tube = 0.3 + 0.05 * math.sin(3 * u + phase)
        for j in range(across):
            v = 2 * math.pi * j / across
            ring = 1 + tube * math.cos(v)
            points.append((ring * math.cos(u), ring * math.sin(u), tube * math.sin(v)))
            a, b = i * across + j + 1, i * across + (j + 1) % across + 1
            c, d = ((i + 1) % around) * across + j + 1, ((i + 1) % around) * across + (j + 1) % across + 1
            faces += [(a, c, d), (a, d, b)]
    with open(path, "w") as out:
        out.writelines("v %.7g %.7g %.7g\n" % p for p in points)
        out.writelines("f %d %d %d\n" % f for f in faces)
    return len(faces)


def seconds(command, folder, frames, at_once):
    start = time.monotonic()
    subprocess.run([command, "build", f"{folder}/a.####.obj", "--frames", f"1-{frames}", "-q", "-o",
                    f"{folder}/a.####.vdb", "--frames-at-once", str(at_once), "--log-level", "error"], check=True)
    return time.monotonic() - start


def main():
    arguments = argparse.ArgumentParser()
    arguments.add_argument("command", type=pathlib.Path)
    arguments.add_argument("--frames", type=int, default=20)
    arguments.add_argument("--triangles", type=int, nargs="+", default=[1000, 10000, 100000])
    arguments.add_argument("--at-once", type=int, default=2)
    a = arguments.parse_args()
    print(f"| triangles | one after the other, s | {a.at_once} at once, s |\n|---|---|---|")
    for triangles in a.triangles:
        with tempfile.TemporaryDirectory() as folder:
            for frame in range(1, a.frames + 1):
                made = write_torus(f"{folder}/a.{frame:04}.obj", triangles, 0.1 * frame)
            best = {1: math.inf, a.at_once: math.inf}
            for _ in range(2):
                for at_once in best:
                    best[at_once] = min(best[at_once], seconds(a.command, folder, a.frames, at_once))
        print(f"| {made} | {best[1]:.2f} | {best[a.at_once]:.2f} |", flush=True)


main()
