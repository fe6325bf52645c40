# SPDX-License-Identifier: Apache-2.0
"""The paper's figures 4 and 5: shells of its authors' meshes (and of others) raw, with the adaptive thin-shell limit, and certified.
Called by paper.py."""
import concurrent.futures
import pathlib

from paper_halves import ALL_MESHES, HALVES, by_half, half_of
from paper_runs import build, figures, triangles_of, with_tables

WAYS = {"raw": ["--method", "raw"], "limited": ["--method", "raw", "--limit", "adaptive"], "certified": [],
        "relative": ["--method", "raw", "--stop-test", "relative-normal"]}
FLAGS = ["--resolution", "256", "--rho", "0.9", "--samples", "100000"]
# The axis that each picture cuts along, and where.
SECTIONS = {"paper/teapot": ("x", 0.5), "paper/cow": ("x", 0.45), "paper/bunny_low_resolution": ("x", 0.5), "paper/sphere": ("z", 0.5),
            "artist/cheburashka": ("z", 0.5), "judging/hand_closed": ("z", 0.5), "judging/springer": ("x", 0.5)}
PICTURES = {"raw": "figure_4", "limited": "figure_5", "certified": "certified"}


def flags_of(way):
    # rho belongs to the tests that read it; the certified shell is the default's, at the same resolution.
    return [*WAYS[way], *(FLAGS if way != "certified" else [f for f in FLAGS if f not in ("--rho", "0.9")])]


def measure(command, files, name, way, images):
    output = []
    if name in SECTIONS and way in PICTURES:
        axis, position = SECTIONS[name]
        picture = images / f"{PICTURES[way]}_{pathlib.Path(name).name}.png"
        output = ["-o", str(picture), "--section-axis", axis, "--section-position", str(position), "--picture-width", "420"]
    report, seconds = build(command, files.path(name), [*flags_of(way), *output])
    return dict(figures(report), triangles=triangles_of(files.path(name)), half=half_of(name), seconds=seconds)


def totals(meshes):
    """Sums and means over the meshes of one way."""
    count = len(meshes)
    return {"meshes": count, "fill": sum(m["fill"] for m in meshes) / count, "least_fill": min(m["fill"] for m in meshes),
            "overlapping_pairs": sum(m["overlapping_pairs"] for m in meshes), "inverted": sum(m["inverted"] for m in meshes),
            "with_overlaps": sum(m["overlapping_pairs"] > 0 for m in meshes), "certified": sum(m["certified"] for m in meshes),
            "pinned": sum(m["pinned"] for m in meshes), "demanded_pins": sum(m["demanded_pins"] for m in meshes),
            "nothing": sum(m["tets"] == 0 for m in meshes)}


def make(command, files, page_folder):
    images = page_folder / "images"
    images.mkdir(parents=True, exist_ok=True)
    jobs = [(name, way) for name in ALL_MESHES for way in WAYS]
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        done = dict(zip(jobs, pool.map(lambda job: measure(command, files, *job, images), jobs)))
    meshes = {name: {way: done[name, way] for way in WAYS} for name in ALL_MESHES}
    drawn = [name for name in ALL_MESHES if name in SECTIONS]
    answer = {"meshes": meshes, "drawn": drawn, "all": {way: totals([m[way] for m in meshes.values()]) for way in WAYS}}
    for half, names in by_half(ALL_MESHES).items():
        answer[half] = {way: totals([meshes[name][way] for name in names]) for way in WAYS}
    return with_tables(answer, main=table(answer), halves=halves_table(answer))


def halves_table(results):
    head = ["half", "meshes", "way", "fill: mean", "least", "meshes with overlaps", "overlapping pairs", "inverted", "no shell", "proven"]
    rows = [[half, str(about["meshes"]), way, f"{about['fill']:.3f}", f"{about['least_fill']:.3f}", str(about["with_overlaps"]),
             str(about["overlapping_pairs"]), str(about["inverted"]), str(about["nothing"]), str(about["certified"])]
            for half in HALVES for way, about in results[half].items()]
    return head, rows


def table(results):
    head = ["mesh", "half", "triangles", "raw: stuck %", "fill", "inverted", "overlapping pairs", "limited: fill", "inverted",
            "overlapping pairs", "relative test: fill", "inverted", "overlapping pairs", "certified: fill", "pinned %", "proven"]
    rows = []
    for name, m in results["meshes"].items():
        row = [name, m["raw"]["half"], f"{m['raw']['triangles']}", f"{m['raw']['stuck_percent']:.0f}"]
        for way in ("raw", "limited", "relative"):
            row += [f"{m[way]['fill']:.3f}", str(m[way]["inverted"]), str(m[way]["overlapping_pairs"])]
        rows.append(row + [f"{m['certified']['fill']:.4f}", f"{m['certified']['stuck_percent']:.1f}",
                           "yes" if m["certified"]["certified"] else "**no**"])
    return head, rows
