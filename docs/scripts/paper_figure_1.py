# SPDX-License-Identifier: Apache-2.0
"""The paper's figure 1: lines from random points of a plane shape, by the library's own field and line stepping, against the exact
medial axis (paper_plane.py). Called by paper.py."""
import concurrent.futures
import json
import math
import subprocess

import numpy

import charts
from paper_plane import cornered, crossings, exact_limits, polygon, random_points, rounded, staircase, write_solid
from paper_runs import with_tables

COUNT, SEED, SHOWN = 1000, 7, 170
RESOLUTION, STENCIL = 256, 2.0  # the interpolated gradient reads two voxels to either side
THRESHOLDS = [0.1, 0.25, 0.5, 1, 2, 4, 8, 16]
RHOS = [0.0, 0.3, 0.5, 0.7, 0.8, 0.9, 0.95, 0.98, 0.99, 0.999]
RESOLUTIONS = [64, 128, 256, 512, 1024]
COLOURS = {"there": "#207040", "short": "#3060b0", "beyond": "#c03030"}
TILTS = [0.0, 0.01, 0.03, 0.1, 0.3]
FLOWN = 10  # steps of curvature flow in picture (d)


# Each with its outline, whether the field is made of its staircase of pixels, rho of its pictures (at 0.9 hardly a line leaves a
# staircase), and the steps of flow without and with reinitialisation.
CASES = {"rounded": (rounded, False, 0.9, [2, 5, 10, 20], [10]), "cornered": (cornered, False, 0.9, [10], [10]),
         "pixels": (rounded, True, 0.5, [2, 5, 10, 20], [2, 10, 20])}


def lines(test, directions="gradient", **options):
    return {"test": test, "directions": directions, **options}


def normal(rho):
    return lines("start-gradient", rho=rho)


def pictures(rho):
    return [("a", "bisection_1", "bisection, threshold of one voxel"), ("b", "distance_1", "distance test, threshold of one voxel"),
            ("c", f"eq7_rho_{rho:g}", f"normal test, rho {rho:g}"),
            ("d", f"flow_{FLOWN}_rho_{rho:g}", f"the same after {FLOWN} steps of curvature flow")]


def field(resolution, smooth=0, reinitialise=True):
    # Deep voxels are made where lines read them, unless a flow needs all of them before.
    return {"resolution": resolution, "smooth": smooth, "reinitialise": reinitialise, "sparse": smooth == 0}


def fields(rho, flown, reinitialised, resolutions):
    """What is asked of each shape, with the name under which the answer is kept."""
    own = [("bisection_given", lines("bisection", "given")), ("distance_given", lines("distance", "given")),
           ("relative", lines("relative-normal", "given"))]
    own += [(f"bisection_{t:g}", lines("bisection", distance_threshold_voxels=t)) for t in THRESHOLDS]
    own += [(f"distance_{t:g}", lines("distance", distance_threshold_voxels=t)) for t in THRESHOLDS]
    own += [(f"rho_{r:g}", lines("normal", "given", rho=r)) for r in RHOS]
    own += [(f"eq7_rho_{r:g}", normal(r)) for r in RHOS]
    asked = [(dict(own), field(RESOLUTION))]
    for steps, made_anew, name in [*((n, False, "flow") for n in flown), *((n, True, "reinitialised") for n in reinitialised)]:
        asked.append(({f"{name}_{steps}_rho_{r:g}": normal(r) for r in {0.9, rho}}, field(RESOLUTION, steps, made_anew)))
    for resolution in resolutions:
        runs = [("normal", lines("normal", "given", rho=0.9)), ("distance", lines("distance", "given")),
                ("bisection", lines("bisection", "given"))]
        asked.append(({f"{name}_at_{resolution}": run for name, run in runs}, field(resolution)))
    return asked


def call(program, folder, solid, points, normals, asked):
    def three(vectors):
        return [[x, y, 0.0] for x, y in vectors.tolist()]
    job = {"solid": str(solid), "points": three(points), "normals": three(normals),
           "fields": [dict(about, lines=list(runs.values())) for runs, about in asked]}
    file = folder / "job.json"
    file.write_text(json.dumps(job))
    answer = json.loads(subprocess.run([program, str(file)], check=True, capture_output=True, text=True).stdout)
    found = {}
    for (runs, _), made in zip(asked, answer):
        for name, run in zip(runs, made["lines"]):
            found[name] = dict(run, voxel=made["voxel"], field_seconds=made["seconds"])
    return found


def judge(points, normals, limits, run):
    """Figures of one run; what is short or over counts from the stencil's reach on."""
    length, voxel = numpy.array(run["length"]), run["voxel"]
    inward = numpy.array(run["inward"])[:, :2]
    error = (length - limits) / voxel
    crossed = crossings(points, points + length[:, None] * inward)
    angles = numpy.degrees(numpy.arccos(numpy.clip(-(inward * normals).sum(1), -1, 1)))
    steps = numpy.array(run["steps"])
    return {"length_percent": 100 * length.sum() / limits.sum(), "short_percent": 100 * (error < -STENCIL).mean(),
            "half_percent": 100 * (length < limits / 2).mean(), "stuck_percent": 100 * (length == 0).mean(),
            "over_percent": 100 * (error > STENCIL).mean(), "crossing_percent": 100 * (crossed > 0).mean(),
            "crossing_pairs": int(crossed.sum()) // 2, "error_median_voxels": float(numpy.median(abs(error))),
            "error_p95_voxels": float(numpy.percentile(abs(error), 95)), "worst_over_voxels": float(error.max()),
            "angle_mean_degrees": float(angles.mean()), "angle_p99_degrees": float(numpy.percentile(angles, 99)),
            "steps_mean": float(steps.mean()), "steps_max": int(steps.max()), "seconds": run["seconds"],
            "field_seconds": run["field_seconds"]}


def tilted(normals, radians, seed):
    angle = numpy.random.default_rng(seed).uniform(-radians, radians, len(normals))
    c, s = numpy.cos(angle), numpy.sin(angle)
    return numpy.stack([c * normals[:, 0] - s * normals[:, 1], s * normals[:, 0] + c * normals[:, 1]], 1)


def measure_case(program, folder, name):
    make, pixels, rho, flown, reinitialised = CASES[name]
    folder = folder / name
    folder.mkdir(exist_ok=True)
    shape = make()
    points, normals = random_points(shape, COUNT, SEED)
    # The library's points are float32; what is exact starts from the same.
    points = points.astype(numpy.float32).astype(float)
    limits = exact_limits(shape, points, normals)
    voxel = float(numpy.ptp(polygon(shape), axis=0).max() / RESOLUTION)
    solid = folder / "solid.obj"
    write_solid(solid, staircase(shape, voxel) if pixels else shape, 1.1 * limits.max())
    asked = fields(rho, flown, reinitialised, [] if pixels else RESOLUTIONS)
    for _, about in asked:
        if about["resolution"] == RESOLUTION:
            about["voxel_size"] = voxel
    found = call(program, folder, solid, points, normals, asked)
    for tilt in TILTS:
        run = [({"tilt": lines("normal", "given", rho=0.9)}, dict(field(RESOLUTION), voxel_size=voxel))]
        found[f"tilt_{tilt:g}"] = call(program, folder, solid, points, tilted(normals, tilt, SEED), run)["tilt"]
    figures = {key: judge(points, normals, limits, run) for key, run in found.items()}
    ends = points - 0.999 * limits[:, None] * normals
    figures["exact"] = {"crossing_percent": 100 * (crossings(points, ends) > 0).mean(), "points": COUNT,
                        "limit_min_voxels": limits.min() / voxel, "limit_max_voxels": limits.max() / voxel}
    return figures, (shape, points, limits, found, pictures(rho))


def medial_points(shape):
    points, normals = random_points(shape, 4000, SEED + 1)
    return points - exact_limits(shape, points, normals)[:, None] * normals


def draw(path, shape, points, limits, found, shown):
    """The four pictures; lines that are much too short are blue, those that end beyond the axis red."""
    size, gap = 400, 16
    outline, axis = polygon(shape), medial_points(shape)
    low, high = outline.min(0), outline.max(0)
    scale = size / (high - low).max()
    height = scale * (high - low)[1]
    parts = []
    for i, (letter, name, words) in enumerate(shown):
        left, top = gap + (i % 2) * (size + gap), 30 + (i // 2) * (height + 44)

        def at(p):
            return left + scale * (p[0] - low[0]), top + scale * (high[1] - p[1])
        run = found[name]
        corners = " ".join("%.1f,%.1f" % at(p) for p in outline[::4 if len(outline) > 100 else 1])
        parts += [f'<polygon points="{corners}" fill="#f4f6fa" stroke="#303848"/>', charts.text(left, top - 8, f"({letter}) {words}", size=13)]
        dots = "".join("M%.1f %.1fh0" % at(q) for q in axis[:1500])
        parts.append(f'<path d="{dots}" stroke="#9098a8" stroke-width="1.6" stroke-linecap="round"/>')
        inward, length = numpy.array(run["inward"])[:, :2], numpy.array(run["length"])
        error = length - limits
        beyond = error > STENCIL * run["voxel"]
        short = -error > numpy.maximum(STENCIL * run["voxel"], 0.1 * limits)
        for these, colour in ((~beyond & ~short, COLOURS["there"]), (short, COLOURS["short"]), (beyond, COLOURS["beyond"])):
            drawn = [(*at(points[v]), *at(points[v] + length[v] * inward[v])) for v in numpy.flatnonzero(these) if v < SHOWN]
            path_data = "".join("M%.1f %.1fL%.1f %.1f" % line for line in drawn)
            parts.append(f'<path d="{path_data}" stroke="{colour}" stroke-width="1.2" stroke-linecap="round"/>')
    y = 30 + 2 * (height + 44) - 16
    for x, words, colour in ((gap, "to the axis, within two voxels or a tenth", COLOURS["there"]), (gap + 260, "short of it", COLOURS["short"]),
                             (gap + 345, "beyond it", COLOURS["beyond"]), (gap + 440, "dots: where exact lines end", "#606878")):
        parts.append(charts.text(x, y, words, colour=colour))
    charts.write_svg(path, round(2 * size + 3 * gap), round(y + 16), parts)


def make(program, folder, page_folder):
    answer = {"resolution": RESOLUTION, "points": COUNT, "stencil_voxels": STENCIL,
              "alpha": {"cos_of_alpha": math.cos(0.4363), "arccos_of_rho": math.acos(0.9), "cos_of_arccos_degrees": math.degrees(0.4363),
                        "arccos_of_rho_degrees": math.degrees(math.acos(0.9))}}
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        done = dict(zip(CASES, pool.map(lambda name: measure_case(program, folder, name), CASES)))
    for name, (figures, drawn) in done.items():
        answer[name] = figures
        draw(page_folder / "images" / f"figure_1_{name}.svg", *drawn)
    return with_tables(answer, **{f"tests_{name}": tests_table(answer[name], CASES[name][2]) for name in CASES}, thresholds=thresholds_table(answer),
                       rho=rho_table(answer), flow=flow_table(answer), resolution=resolution_table(answer), tilt=tilt_table(answer))


COLUMNS = [("length_percent", "length won %", ".1f"), ("half_percent", "less than half %", ".1f"), ("short_percent", "short %", ".1f"),
           ("over_percent", "over %", ".1f"), ("crossing_percent", "crossing %", ".1f"), ("error_median_voxels", "median error, voxels", ".2f"),
           ("steps_mean", "looks at the field, mean", ".0f"), ("steps_max", "most", ".0f")]


def cells(run, columns=None):
    return [f"{run[key]:{form}}" for key, _, form in columns or COLUMNS]


def heads(columns=None):
    return [words for _, words, _ in columns or COLUMNS]


def tests_table(case, rho):
    rows = [[f"({letter}) {words}", *cells(case[name])] for letter, name, words in pictures(rho)]
    rows += [[words, *cells(case[name])] for words, name in
             (("bisection along exact normals", "bisection_given"), ("distance test along exact normals", "distance_given"),
              ("eq. 10, rho 0.9, exact normals", "rho_0.9"), ("relative test, rho 0.9, exact normals", "relative"),
              (f"(d) reinitialised, rho {rho:g}", f"reinitialised_{FLOWN}_rho_{rho:g}"))]
    return ["test", *heads()], rows


SHORT = [column for column in COLUMNS if column[0] in ("length_percent", "half_percent", "over_percent", "crossing_percent")]


def side_by_side(answer, first, rows, cases):
    head = [first] + [f"{case}: {words}" for case in cases for words in heads(SHORT)]
    return head, [[words] + [cell for case in cases for cell in cells(answer[case][name], SHORT)] for words, name in rows]


def thresholds_table(answer):
    rows = [(f"{test}, {t:g}", f"{test}_{t:g}") for test in ("bisection", "distance") for t in THRESHOLDS]
    return side_by_side(answer, "test, threshold in voxels", rows, ("rounded", "pixels"))


def rho_table(answer):
    return side_by_side(answer, "rho", [(f"{r:g}", f"rho_{r:g}") for r in RHOS], ("rounded", "cornered", "pixels"))


def flow_table(answer):
    head = ["field", "steps of flow", "reinitialised", "rho", "angle to the normal, mean degrees", *heads(SHORT)]
    rows = []
    for name, (_, _, rho, flown, made_anew) in CASES.items():
        for r in sorted({0.9, rho}):
            runs = [(0, "", f"eq7_rho_{r:g}"), *((n, "no", f"flow_{n}_rho_{r:g}") for n in flown),
                    *((n, "yes", f"reinitialised_{n}_rho_{r:g}") for n in made_anew)]
            rows += [[name, str(n), words, f"{r:g}", f"{answer[name][key]['angle_mean_degrees']:.2f}", *cells(answer[name][key], SHORT)]
                     for n, words, key in runs]
    return head, rows


def resolution_table(answer):
    rows = [(f"{test}, {n}", f"{test}_at_{n}") for test in ("normal", "distance", "bisection") for n in RESOLUTIONS]
    return side_by_side(answer, "test, resolution", rows, ("rounded", "cornered"))


def tilt_table(answer):
    return side_by_side(answer, "largest tilt, radians", [(f"{t:g}", f"tilt_{t:g}") for t in TILTS], ("rounded", "cornered"))
