#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Renders a small shell with Blender, without a window, and looks at the picture.

    render_in_blender.py COMMAND MESH SCRIPT

COMMAND makes the files of MESH's shell, SCRIPT is samples/blender/show_shell.py. Exit status: 0
when volume and tets can be seen where they belong, 1 when not, 77 when Blender is not there.
"""

import os
import shutil
import struct
import subprocess
import sys
import tempfile
import zlib

WIDTH, HEIGHT = 160, 90


def read_png(path):
    """Rows of (red, green, blue) of an 8-bit RGB picture."""
    with open(path, "rb") as file:
        data = file.read()
    assert data[:8] == b"\x89PNG\r\n\x1a\n", "no PNG"
    place, packed = 8, b""
    while place < len(data):
        length, kind = struct.unpack(">I4s", data[place:place + 8])
        body = data[place + 8:place + 8 + length]
        if kind == b"IHDR":
            width, height, depth, colours = struct.unpack(">IIBB", body[:10])
        elif kind == b"IDAT":
            packed += body
        place += 12 + length
    assert (depth, colours) == (8, 2), f"{depth} bits, colour type {colours}"
    raw, stride, rows, before = zlib.decompress(packed), 3 * width, [], bytes(3 * width)
    for y in range(height):
        start = y * (stride + 1)
        method, line = raw[start], bytearray(raw[start + 1:start + 1 + stride])
        for i in range(stride):
            left = line[i - 3] if i >= 3 else 0
            up, corner = before[i], before[i - 3] if i >= 3 else 0
            guess = left + up - corner
            nearest = min((left, up, corner), key=lambda c: abs(guess - c))
            line[i] = (line[i] + (0, left, up, (left + up) // 2, nearest)[method]) & 255
        rows.append([tuple(line[i:i + 3]) for i in range(0, stride, 3)])
        before = bytes(line)
    return rows


def seen(rows, columns):
    """Share of these columns' pixels that are not the background, and their mean colour."""
    background = rows[0][0]
    pixels = [row[x] for row in rows for x in columns]
    other = [p for p in pixels if max(abs(a - b) for a, b in zip(p, background)) > 12]
    mean = [sum(p[c] for p in other) / max(1, len(other)) for c in range(3)]
    return len(other) / len(pixels), mean


def render(script, volume, tets, picture):
    result = subprocess.run(
        ["blender", "--background", "--factory-startup", "--python-exit-code", "1", "--python", script,
         "--", volume, tets, picture, "--up", "y", "--size", str(WIDTH), str(HEIGHT), "--samples", "4"],
        capture_output=True, text=True, timeout=500)
    facts = [line for line in result.stdout.splitlines() if line.startswith(("Blender 3", "Blender 4", "tets:", "grids:"))]
    print("\n".join(facts))
    if result.returncode != 0:
        print(result.stdout[-800:], result.stderr[-800:])
    return result.returncode == 0, facts


def main():
    command, mesh, script = sys.argv[1:]
    if shutil.which("blender") is None:
        print("Blender is not there")
        return 77
    failures = []
    with tempfile.TemporaryDirectory() as folder:
        volume, tets, picture = (os.path.join(folder, "shell" + e) for e in (".vdb", ".node", ".png"))
        subprocess.run([command, "build", mesh, "--resolution", "32", "-q", "-o", volume, "-o", tets], check=True)
        good, facts = render(script, volume, tets, picture)
        if not good:
            return 1
        text = "\n".join(facts)
        for grid in ("depth (FLOAT)", "surface (FLOAT)", "shell_points (POINTS)"):
            if grid not in text:
                failures.append(f"grid {grid} is not listed")
        rows = read_png(picture)
        if (len(rows[0]), len(rows)) != (WIDTH, HEIGHT):
            failures.append(f"the picture has {len(rows[0])} x {len(rows)} pixels")
        for what, columns in (("volume", range(WIDTH // 2)), ("tets", range(WIDTH // 2, WIDTH))):
            share, colour = seen(rows, columns)
            print(f"{what}: covers {share:.1%}, mean colour {[round(c) for c in colour]}")
            if not 0.04 < share < 0.9:
                failures.append(f"{what}: covers {share:.1%}")
        # A grid that is not there has to be told, or the left side would only be empty.
        if render(script, os.path.join(folder, "none.vdb"), tets, picture)[0]:
            failures.append("a missing .vdb goes unnoticed")
    for failure in failures:
        print("FAILED: " + failure)
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
