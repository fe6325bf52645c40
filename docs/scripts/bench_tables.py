# SPDX-License-Identifier: Apache-2.0
"""The tables and charts of docs/measurements/benchmarks.md, from the figures that benchmarks.py keeps."""
import statistics

from bench_commands import DEEP, GMSH, LEVEL_SET, OURS, RIVALS, TETGEN
from charts import fitted_exponent, log_chart, ratio_bars
from runs import CLEAN_MESHES, replace_tables, table

MIB = 2**20
MANY_FACES, MILLION = 50_000, 1_000_000
LIMITS = {"level set": 1.5, "memory": 2.0, "tetgen": 1.0, "exponent": 1.1, "seconds": 60, "GiB": 6, "speed-up": 1.7}
TITLES = {OURS: "vdb_shell", LEVEL_SET: "vdb_tool -mesh2ls", TETGEN: "tetgen -pY", GMSH: "gmsh -3",
          DEEP: "deep meshToVolume"}


def median(figures, key):
    """None where a command failed or says nothing about it."""
    values = [value for value in (figures or {}).get(key, []) if value is not None] \
        if "failed" not in (figures or {"failed": ""}) else []
    return statistics.median(values) if values else None


def number(value):
    """Three digits, about."""
    return f"{value:.{3 if value < 0.0995 else 2 if value < 9.995 else 1 if value < 99.95 else 0}f}"


def why_not(figures):
    return figures["failed"] if figures and "failed" in figures else "not run"


def seconds(figures, key="wall"):
    value = median(figures, key)
    if value is None:
        return "" if key != "wall" and figures and "failed" not in figures else why_not(figures)
    flaw = "" if figures.get("certified", True) else " **NOT CERTIFIED**"
    return number(value) + flaw


def memory(figures):
    peak = median(figures, "peak")
    if peak is None:
        return ""
    return f"{'at most ' if peak <= median(figures, 'floor') else ''}{peak / MIB:.0f}"


def ratio(found, rival, key="wall"):
    """Ours over the rival's, round by round. None where either has none."""
    ours, theirs = found.get(OURS), found.get(rival)
    if median(ours, key) is None or median(theirs, key) is None:
        return None
    return statistics.median(a / b for a, b in zip(ours[key], theirs[key]))


def ratio_cell(found, rival, key="wall"):
    value = ratio(found, rival, key)
    return "" if value is None else number(value)


def those(runs, prefix):
    """What follows the prefix -> the bout, in the order of measuring."""
    return {key[len(prefix):]: found for key, found in runs.items() if key.startswith(prefix)}


def remark(bouts):
    """What kind of figures these are: the table must not be taken for more than it is."""
    rounds = [len(figures["wall"]) for found in bouts for figures in found.values()
              if isinstance(figures, dict) and isinstance(figures.get("wall"), list)]
    if not rounds:
        return ["Not measured yet.", ""]
    count = f"{min(rounds)} to {max(rounds)}" if min(rounds) < max(rounds) else str(max(rounds))
    words = f"Rounds: {count}."
    if any(found.get("quick") for found in bouts):
        words = f"**A first look (`--quick`): few surfaces, one round each; no figures to quote.** {words}"
    return [words, ""]


def picture_of(page, name):
    return page.parent / "images" / f"benchmark_{name}.svg"


def comparison(bouts, rivals, first):
    """Rows of wall seconds with ratios, and of CPU seconds and memory. `first`: heading and cells before them."""
    wall_head = [*first, f"{TITLES[OURS]} s"] + [text for name in rivals for text in (f"{TITLES[name]} s", "ratio")]
    cost_head = [*first] + [f"{TITLES[name]} {what}" for name in [OURS, *rivals] for what in ("CPU s", "MiB")
                            if (name, what) != (DEEP, "CPU s")] + [f"memory over {LEVEL_SET}'s"]
    walls, costs = [], []
    for cells, found in bouts:
        walls.append([*cells, seconds(found[OURS])] + [text for name in rivals for text in (
            seconds(found.get(name)), ratio_cell(found, name))])
        costs.append([*cells] + [text for name in [OURS, *rivals] for text in (
            [seconds(found.get(name), "cpu")] if name != DEEP else []) + [memory(found.get(name))]] +
            [ratio_cell(found, LEVEL_SET, "peak")])
    return [*table(wall_head, walls), "", *table(cost_head, costs)]


def write_clean(page, runs):
    bouts = those(runs, "clean, ")
    rows = [([name, str(found["faces"]), fill(found)], found) for name, found in bouts.items()]
    ratios = {name: ratio(found, LEVEL_SET) for name, found in bouts.items()}
    ratio_bars(picture_of(page, "clean"), f"Wall seconds of a certified shell over those of {TITLES[LEVEL_SET]}, "
               "resolution 256", {name: value for name, value in ratios.items() if value}, LIMITS["level set"])
    replace_tables(page, [*remark(bouts.values()), *comparison(rows, RIVALS, ["mesh", "faces", "fill"]), "",
                          *geometric_means(bouts.values())], "clean")


def fill(found):
    return f"{found[OURS]['fill']:.3f}" if found[OURS].get("fill") is not None else ""


def geometric_means(bouts):
    words = []
    for name in RIVALS:
        ratios = [value for value in (ratio(found, name) for found in bouts) if value]
        if ratios:
            words.append(f"{TITLES[name]}: {statistics.geometric_mean(ratios):.2f} ({min(ratios):.2f} to "
                         f"{max(ratios):.2f}, {len(ratios)} surfaces)")
    return [f"Ratios, geometric mean (least to greatest): {'; '.join(words)}."] if words else []


def points_of(bouts, name):
    found = [(bout["faces"], median(bout.get(name), "wall")) for bout in bouts]
    return [(faces, value) for faces, value in found if value]


def stage_rows(bouts):
    """Stage -> our seconds in each bout, None where it did not run; at the end what no stage accounts for."""
    stages = {}
    for found in bouts:
        for stages_of_run in found[OURS].get("stages", []):
            stages.update(dict.fromkeys(stages_of_run))
    rows = {stage: [stage_seconds(found[OURS], stage) for found in bouts] for stage in stages}
    rows["start and end of the process"] = [rest_seconds(found[OURS]) for found in bouts]
    return {stage: cells for stage, cells in rows.items() if max((cell or 0 for cell in cells), default=0) >= 0.005}


def rest_seconds(figures):
    rest = [wall - sum(stages.values()) for wall, stages in zip(figures.get("wall", []), figures.get("stages", []))]
    return statistics.median(rest) if rest else None


def cell(value):
    return "" if value is None else number(value)


def stage_seconds(figures, stage):
    values = [stages[stage] for stages in figures.get("stages", []) if stage in stages]
    return statistics.median(values) if values else None


def large_exponent(points):
    """Without the sizes where the constant part of the time hides how the rest grows."""
    exponent = fitted_exponent([point for point in points if point[0] >= MANY_FACES])
    return "" if exponent is None else f"; from {MANY_FACES:,} faces up {exponent:.2f}"


def write_faces(page, runs):
    bouts = sorted(those(runs, "faces, ").values(), key=lambda found: found["faces"])
    rivals = [LEVEL_SET, TETGEN, GMSH]
    series, fits = {}, []
    for name in [OURS, *rivals]:
        points = points_of(bouts, name)
        exponent = fitted_exponent(points)
        if exponent is not None:
            series[f"{TITLES[name]}, exponent {exponent:.2f}"] = points
            fits.append(f"{TITLES[name]} {exponent:.2f} ({len(points)} sizes{large_exponent(points)})")
    log_chart(picture_of(page, "faces"), "Wall seconds against faces, resolution 256", "faces", "seconds", series,
              [found["faces"] for found in bouts])
    rows = [([str(found["faces"]), fill(found)], found) for found in bouts]
    replace_tables(page, [
        *remark(bouts), *comparison(rows, rivals, ["faces", "fill"]), "",
        f"Exponents of time against faces, least squares over all sizes: {', '.join(fits) or 'none yet'}.", "",
        "Where our time goes, seconds by stage (those of 0.005 s and more):", "",
        *table(["stage", *[f"{found['faces']} faces" for found in bouts]],
               [[stage, *map(cell, cells)] for stage, cells in stage_rows(bouts).items()])], "faces")


def write_threads(page, runs):
    found = runs.get("threads")
    bouts = [{OURS: found[count]} for count in ("1", "2")] if found else []
    rows = [[stage, *map(cell, cells), cell(cells[0] / cells[1]) if all(cells) else ""]
            for stage, cells in stage_rows(bouts).items()]
    if found:
        whole = [seconds(found[count]) for count in ("1", "2")]
        value = speed_up(runs)
        rows += [["**whole command**", *whole, "" if value is None else f"**{value:.2f}**"],
                 ["CPU seconds", *[seconds(found[count], "cpu") for count in ("1", "2")], ""],
                 ["peak MiB", *[memory(found[count]) for count in ("1", "2")], ""]]
    title = [f"{found['faces']} faces, resolution 256.", ""] if found else []
    replace_tables(page, [*remark([found] if found else []), *title,
                          *table(["stage", "1 thread, s", "2 threads, s", "speed-up"], rows)], "threads")


def speed_up(runs):
    found = runs.get("threads", {})
    if median(found.get("1"), "wall") is None or median(found.get("2"), "wall") is None:
        return None
    return statistics.median(one / two for one, two in zip(found["1"]["wall"], found["2"]["wall"]))


def write_resolutions(page, runs):
    bouts = those(runs, "resolutions, ")
    rows, series, ticks = [], {}, set()
    for key, found in bouts.items():
        mesh, resolution = key.split(", ")
        rows.append(([mesh, resolution, fill(found)], found))
        ticks.add(int(resolution))
        for name in (OURS, LEVEL_SET, DEEP):
            value = median(found.get(name), "wall")
            if value:
                series.setdefault(f"{TITLES[name]}, {mesh.split('/')[1]}", []).append((int(resolution), value))
    log_chart(picture_of(page, "resolutions"), "Wall seconds against resolution", "voxels along the longest side",
              "seconds", series, sorted(ticks))
    replace_tables(page, [*remark(bouts.values()),
                          *comparison(rows, [LEVEL_SET, DEEP], ["mesh", "resolution", "fill"])], "resolutions")


def write_starts(page, runs):
    bouts, rows, starts = those(runs, "starts, "), [], []
    for key, found in bouts.items():
        mesh, parts = key.split(", ")
        runs_of_start = {name: figures for name, figures in found.items() if isinstance(figures, dict)}
        starts = list(runs_of_start)
        cells = []
        for figures in runs_of_start.values():
            good = "failed" not in figures
            flaw = "" if figures.get("certified", True) else " **NOT CERTIFIED**"
            cells += [f"{figures['fill']:.4f}{flaw}" if good else why_not(figures),
                      cell(stage_seconds(figures, "growth")) if good else ""]
        rows.append([mesh if parts == "1" else f"{mesh}, edges cut into {parts}", str(found["faces"]), *cells])
    head = ["mesh", "faces", *[text for name in starts for text in (f"{name}: fill", "growth s")]]
    replace_tables(page, [*remark(bouts.values()), *(table(head, rows) if rows else [])], "starts")


def write_stages(page, runs):
    if "suite" not in runs:
        return
    stages, columns = {}, {}
    for run in runs["suite"]["runs"]:
        if run.get("aggregate_name", "median") != "median" or run.get("error_occurred"):
            continue
        stage, surface, faces = run["name"].split("/")[:3]
        columns[surface, int(faces)] = None
        stages.setdefault(stage, {})[surface, int(faces)] = run["real_time"]
    rows = [[f"`{stage}`"] + [f"{times[column]:.3g}" if column in times else "" for column in sorted(columns)]
            for stage, times in stages.items()]
    first = ["**A first look (`--quick`): small surfaces, once each; no figures to quote.**", ""] \
        if runs["suite"]["quick"] else []
    head = ["stage"] + [f"{surface} {faces}" for surface, faces in sorted(columns)]
    replace_tables(page, [*first, "Wall milliseconds:", "", *table(head, rows)], "stages")


def verdict(value, limit, at_least=False):
    if value is None:
        return ["not measured", ""]
    met = value >= limit if at_least else value <= limit
    return [number(value), "yes" if met else "**no**"]


def worst(values):
    return max((value for value in values if value is not None), default=None)


def aims(runs):
    clean, faces = those(runs, "clean, ").values(), list(those(runs, "faces, ").values())
    tetgen = [ratio(found, TETGEN) for found in [*faces, *clean] if found["faces"] >= MANY_FACES]
    tetgen = [value for value in tetgen if value]
    million = next((found[OURS] for found in faces if found["faces"] >= MILLION), None)
    peak = median(million, "peak")
    level_set = [value for value in (ratio(found, LEVEL_SET) for found in clean) if value]
    count = len(clean) + len(faces)
    good = sum(found[OURS].get("certified", False) for found in [*clean, *faces] if "failed" not in found[OURS])
    # Small sizes say nothing about how the time grows, nor about threads.
    points = points_of(faces, OURS) if million else []
    threads = speed_up(runs) if runs.get("threads", {}).get("faces", 0) >= MANY_FACES else None
    return [
        ["every shell certified", f"{count} of {count}", f"{good} of {count}", "yes" if good == count else "**no**"],
        [f"whole job over `{TITLES[LEVEL_SET]}`, worst of {len(level_set)} (of {len(CLEAN_MESHES)}) clean meshes",
         "at most 1.5", *verdict(worst(level_set), LIMITS["level set"])],
        ["its peak memory over vdb_tool's, worst of the same", "at most 2",
         *verdict(worst(ratio(found, LEVEL_SET, "peak") for found in clean), LIMITS["memory"])],
        [f"whole job over `{TITLES[TETGEN]}`, worst of {len(tetgen)} surfaces from {MANY_FACES:,} faces up", "at most 1.0",
         *verdict(worst(tetgen), LIMITS["tetgen"])],
        ["exponent of time against faces, up to a million", "at most 1.1", *verdict(fitted_exponent(points), LIMITS["exponent"])],
        [f"the same from {MANY_FACES:,} faces up", "at most 1.1",
         *verdict(fitted_exponent([point for point in points if point[0] >= MANY_FACES]), LIMITS["exponent"])],
        ["a million faces, s", "at most 60", *verdict(median(million, "wall"), LIMITS["seconds"])],
        ["a million faces, GiB", "at most 6", *verdict(peak and peak / 2**30, LIMITS["GiB"])],
        ["speed-up of a second thread, 96,000 faces", "at least 1.7", *verdict(threads, LIMITS["speed-up"], True)]]


def write_aims(page, runs):
    bouts = [found for found in runs.values() if isinstance(found, dict) and "faces" in found]
    machine = runs["machine"]
    replace_tables(page, [*remark(bouts), f"Hardware threads: {machine['threads']}. Load average before the first run: "
                          f"{machine['load']:.1f}.", "", *table(["aim", "limit", "measured", "met"], aims(runs))], "aims")


WRITERS = {"clean": write_clean, "faces": write_faces, "threads": write_threads, "resolutions": write_resolutions,
           "stages": write_stages, "starts": write_starts}
