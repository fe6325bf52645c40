#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Measures fill against the number of tets under resampling; writes the tables and the picture of the page.

    resampling.py COMMAND MESH_FOLDER docs/measurements/resampling.md docs/measurements/images/resampling.svg [RESULTS.json]

COMMAND is the vdb_shell binary. RESULTS.json keeps the finished runs, which are taken from there the next time; delete
it when the command has changed.
"""
import json
import math
import pathlib
import subprocess
import sys
import tempfile
import time

from runs import Results, replace_tables, table

# Mesh, its triangles, and the most tets that refinement may make: those of the first uniform level, or the second.
MESHES = {"paper/cow": (1500, 18000), "paper/diku": (288, 13824)}
FLAGS = ["--resolution", "128", "--samples", "20000"]
ROUNDS = ["--refine-rounds", "6"]
SERIES = {"uniform": "#c03030", "uniform, grown on": "#d08a20", "contacts": "#207040", "voids": "#3060b0", "area": "#808080",
          "decimated": "#202020"}
PAPER = {"raw, normal": ["--method", "raw", "--refine-by", "voids"],
         "raw, relative-normal": ["--method", "raw", "--stop-test", "relative-normal", "--refine-by", "voids"],
         "thickest": ["--method", "thickest"]}


def run(command, mesh, flags):
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / "report.json"
        begin = time.monotonic()
        done = subprocess.run([command, "--threads", "1", "build", "-q", *FLAGS, *flags, "--report", str(path), str(mesh)])
        if done.returncode != 7:  # written, but not valid, as the raw method may be
            done.check_returncode()
        report = json.loads(path.read_text())
    kept = {key: report[key] for key in ("refine", "decimate")}
    kept.update(certified=report["certificate"]["certified"], tets=report["tets"]["tets"], fill=report["volume"]["fill"],
                triangles=report["mesh"]["triangles"], several=report["coverage"]["in_several"],
                covered=report["coverage"]["covered_share"], inverted=report["tets"]["inverted"],
                twice=report["coverage"]["overlap_share"], seconds=time.monotonic() - begin)
    return kept


def jobs(name):
    triangles, most = MESHES[name]
    limit = [*ROUNDS, "--max-tets", str(most)]
    for level in range(3):
        yield f"uniform {level}", ["--subdivide", str(level)]
    yield "uniform, grown on", [*limit, "--refine-by", "area", "--refine-share", "1"]
    for by in ("contacts", "voids", "area"):
        yield by, [*limit, "--refine-by", by]
    for share in (2, 4):
        yield f"decimated {share}", ["--decimate-to", str(triangles // share)]
    for title, flags in PAPER.items():
        yield title, [*limit, *flags]


def points_of(runs, name, series):
    """Tets and fill of a series, in the order of its rounds or levels."""
    if series in ("uniform", "decimated"):
        found = [runs[f"{name}, {series} {k}"] for k in ((0, 1, 2) if series == "uniform" else (4, 2))]
        return [(r["tets"], r["fill"]) for r in found]
    return [(r["tets"], r["fill"]) for r in runs[f"{name}, {series}"]["refine"]["rounds"]]


def sound(run_):
    return "yes" if run_["certified"] and not run_["several"] else "**no**"


def uniform_rows(runs, name):
    rows = []
    for key in ["uniform 0", "uniform 1", "uniform 2", "decimated 2", "decimated 4"]:
        r, d = runs[f"{name}, {key}"], runs[f"{name}, {key}"]["decimate"]
        apart = [f"{d[side]['mean']:.1e}, {d[side]['max']:.1e}" for side in ("input_to_result", "result_to_input")] if d else ["0", "0"]
        rows.append([name, key, str(r["triangles"]), str(r["tets"]), f"{r['fill']:.4f}", sound(r), *apart, f"{r['seconds']:.0f}"])
    return rows


def round_rows(runs, name, series):
    rows = []
    r = runs[f"{name}, {series}"]
    refine = r["refine"]
    for k, step in enumerate(refine["rounds"]):
        last = k + 1 == len(refine["rounds"])
        rows.append([name if k == 0 else "", series if k == 0 else "", f"{k}{', kept' if k == refine['kept'] else ''}",
                     str(step["triangles"]), str(step["tets"]), f"{step['fill']:.4f}",
                     f"{step['gain_per_tet']:.1e}" if k else "", sound(r) if last else "",
                     f"{refine['end']}, {r['seconds']:.0f} s" if last else ""])
    return rows


def paper_rows(runs, name):
    rows = []
    for title in PAPER:
        r = runs[f"{name}, {title}"]
        first = r["refine"]["rounds"][0]
        kept = r["refine"]["rounds"][r["refine"]["kept"]]
        rows.append([name, title, str(first["tets"]), f"{first['fill']:.3f}", str(kept["tets"]), f"{kept['fill']:.3f}",
                     f"{r['covered']:.3f}", f"{100 * r['twice']:.2f}", str(r["inverted"])])
    return rows


def panel(runs, name, left, size):
    """Fill against tets, tets on a logarithmic scale."""
    curves = {series: points_of(runs, name, series) for series in SERIES}
    every = [p for curve in curves.values() for p in curve]
    low, high = math.log(min(t for t, _ in every) * 0.9), math.log(max(t for t, _ in every) * 1.1)
    least, most = min(f for _, f in every), max(f for _, f in every)
    room = 0.08 * (most - least)
    least, most = least - room, most + room

    def at(tets, fill):
        return (left + size * (math.log(tets) - low) / (high - low), 40 + size - size * (fill - least) / (most - least))
    parts = [f'<rect x="{left}" y="40" width="{size}" height="{size}" fill="none" stroke="#303848"/>',
             f'<text x="{left}" y="28" font-size="14">{name}: fill against tets</text>']
    step = 0.005 if most - least < 0.04 else 0.01
    for i in range(math.ceil(least / step), math.floor(most / step) + 1):
        y = at(math.exp(low), i * step)[1]
        parts.append(f'<line x1="{left}" y1="{y:.1f}" x2="{left + size}" y2="{y:.1f}" stroke="#d8dce4"/>')
        parts.append(f'<text x="{left - 6}" y="{y + 4:.1f}" font-size="11" text-anchor="end">{i * step:.3f}</text>')
    tets = 100
    while tets < math.exp(high):
        if tets > math.exp(low):
            x = at(tets, least)[0]
            parts.append(f'<line x1="{x:.1f}" y1="40" x2="{x:.1f}" y2="{40 + size}" stroke="#d8dce4"/>')
            parts.append(f'<text x="{x:.1f}" y="{56 + size}" font-size="11" text-anchor="middle">{tets}</text>')
        tets *= 2
    for series, curve in curves.items():
        spots = ["%.1f,%.1f" % at(*p) for p in curve]
        dash = ' stroke-dasharray="5 4"' if series in ("uniform, grown on", "area") else ""
        parts.append(f'<polyline points="{" ".join(spots)}" fill="none" stroke="{SERIES[series]}" stroke-width="2"{dash}/>')
        parts += ['<circle cx="%.1f" cy="%.1f" r="3.5" fill="%s"/>' % (*at(*p), SERIES[series]) for p in curve]
    return parts


def draw(runs, path):
    size, gap = 420, 64
    parts = []
    for column, name in enumerate(MESHES):
        parts += panel(runs, name, gap + column * (size + gap), size)
    height, width = size + 110, gap + len(MESHES) * (size + gap)
    for i, (series, colour) in enumerate(SERIES.items()):
        parts.append(f'<text x="{gap + 155 * i}" y="{height - 14}" font-size="13" fill="{colour}">{series}</text>')
    path.write_text(f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" font-family="sans-serif">\n'
                    f'<rect width="{width}" height="{height}" fill="white"/>\n' + "\n".join(parts) + "\n</svg>\n")


def main():
    command, root = sys.argv[1], pathlib.Path(sys.argv[2])
    page, picture = pathlib.Path(sys.argv[3]), pathlib.Path(sys.argv[4])
    results = Results(sys.argv[5] if len(sys.argv) > 5 else None)
    for name in MESHES:
        for title, flags in jobs(name):
            if f"{name}, {title}" not in results.runs:
                results.keep(f"{name}, {title}", run(command, root / f"{name}.obj", flags))
                print(f"{name}, {title}", flush=True)
    runs = results.runs
    draw(runs, picture)
    whole = table(["mesh", "surface", "triangles", "tets", "fill", "certified", "input to result: mean, max", "result to input: mean, max", "s"],
                  [row for name in MESHES for row in uniform_rows(runs, name)])
    rounds = table(["mesh", "marked by", "round", "triangles", "tets", "fill", "gained per added tet", "certified", "ended by"],
                   [row for name in MESHES for series in ("contacts", "uniform, grown on", "voids", "area")
                    for row in round_rows(runs, name, series)])
    paper = table(["mesh", "method", "tets before", "fill before", "tets after", "fill after", "covered after", "covered twice after, %",
                   "inverted after"], [row for name in MESHES for row in paper_rows(runs, name)])
    replace_tables(page, ["### The whole surface", "", *whole, "", "### Rounds", "", *rounds, "", "### Other methods", "", *paper])


if __name__ == "__main__":
    main()
