#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Flips single bits in the files of a small shell, gives each to `check`, `info` and `convert`, and counts: refused;
passed with the same answer and the same converted files as from the sound one; passed with other ones; crashed.

    flipped_bits.py COMMAND MESH [--flips N] [--kinds vdb unsealed.vdb ...] [--jobs N] [--seed N]
                    [--results FILE] [--page docs/reliability.md]

The last two counts must be 0. Bits are drawn at random over the whole file; in a .vdb the UUID is drawn like the rest.
An unsealed .vdb has another UUID, as one that another program wrote of the same grids: there the digest of the bytes
says nothing, and the walk before decoding and the digests of values have to do.
Prints a table and ends with status 1 at a violation. --results keeps what is finished, by kind and seed, and the table,
which --page writes, has the sums over all seeds."""
import argparse
import concurrent.futures
import pathlib
import random
import subprocess
import sys
import tempfile

sys.path.append(str(pathlib.Path(__file__).resolve().parents[2] / "docs" / "scripts"))
from runs import Results, replace_tables, table  # noqa: E402

KINDS = {"vdb": [], "unsealed.vdb": [], "layers.vdb": ["--layers", "2", "--side", "both"], "half.vdb": ["--half"], "geo": [], "bgeo": [], "bgeo.sc": []}
CRASH, REFUSED, SAME, CHANGED = "crashed", "refused", "no effect", "CHANGED"
UUID = 21
# Damage is a read error, or a failed check; nothing else of the documented ones may come of it.
REFUSALS = (1, 3)


def run(line):
    done = subprocess.run([str(word) for word in line], capture_output=True, timeout=120)
    return done.returncode, done.stdout, done.stderr


def answer(command, verb, file, out):
    """Status, and everything that a caller learns of the file."""
    if verb != "convert":
        status, text, error = run([command, verb, file])
        return status, text, error
    targets = [out / "c.vtu", out / ("c.vdb" if file.suffix == ".vdb" else "c.bgeo")]
    status, text, error = run([command, verb, file, "-o", targets[0], "-o", targets[1]])
    found = [target.read_bytes() if target.exists() else b"" for target in targets]
    for target in targets:
        target.unlink(missing_ok=True)
    return status, text + b"".join(found), error


def verdict(sound, status, text):
    if status < 0 or status >= 128:
        return CRASH
    if status in REFUSALS:
        return REFUSED
    return SAME if (status, text) == sound else CHANGED


def one_flip(command, name, sound_bytes, sound, bit, work):
    """What each verb makes of the file with that bit flipped."""
    data = bytearray(sound_bytes)
    data[bit // 8] ^= 1 << bit % 8
    with tempfile.TemporaryDirectory(dir=work) as folder:
        folder = pathlib.Path(folder)
        # The same name, for messages and outputs tell it.
        (folder / name).write_bytes(data)
        found = {}
        for verb, before in sound.items():
            status, text, error = answer(command, verb, folder / name, folder)
            found[verb] = verdict(before, status, text.replace(str(folder).encode(), b""))
            if found[verb] in (CRASH, CHANGED):
                print(f"VIOLATION: {name}, bit {bit}: {verb} {found[verb]}, status {status}, {error[:300]!r}", flush=True)
        return found


def flip_all(args, kind, work):
    folder = pathlib.Path(work) / kind
    folder.mkdir()
    file = folder / ("s." + kind)
    base = [args.command, "build", args.mesh, "--resolution", "12", "--samples", "0", "-q", "-o", file, *KINDS[kind]]
    status, _, error = run(base)
    if status:
        sys.exit(f"{kind}: no file to damage: {error.decode()}")
    data = file.read_bytes()
    if kind == "unsealed.vdb":
        data = data[:UUID] + b"3b241101-e2bb-4255-8caf-4136c566a962" + data[UUID + 36:]
        file.write_bytes(data)
    sound = {}
    for verb in ("check", "info", "convert"):
        status, text, error = answer(args.command, verb, file, folder)
        if status:
            sys.exit(f"{kind}: the sound file does not pass {verb}: {error.decode()}")
        sound[verb] = (status, text.replace(str(folder).encode(), b""))
    bits = random.Random(args.seed).sample(range(8 * len(data)), min(args.flips, 8 * len(data)))
    counts = {verb: dict.fromkeys((REFUSED, SAME, CHANGED, CRASH), 0) for verb in sound}
    with concurrent.futures.ThreadPoolExecutor(args.jobs) as pool:
        for found in pool.map(lambda bit: one_flip(args.command, file.name, data, sound, bit, work), bits):
            for verb, what in found.items():
                counts[verb][what] += 1
    return {"bytes": len(data), "flips": len(bits), "counts": counts}


def rows_of(kind, found):
    """One row for each command, or one for all of them where they agree."""
    counts = {tuple(row.values()) for row in found["counts"].values()}
    verbs = ["all three"] if len(counts) == 1 else list(found["counts"])
    return [[f"`.{kind}`", f"{found['bytes']:,}", verb, f"{found['flips']:,}",
             *(f"{n:,}" for n in found["counts"]["check" if verb == "all three" else verb].values())] for verb in verbs]


def sums_by_kind(runs):
    """What the runs of all seeds found together."""
    sums = {}
    for key, run_of_seed in runs.items():
        kind = key.split()[0]
        both = sums.setdefault(kind, {"bytes": run_of_seed["bytes"], "flips": 0,
                                      "counts": {verb: dict.fromkeys(row, 0) for verb, row in run_of_seed["counts"].items()}})
        both["flips"] += run_of_seed["flips"]
        for verb, row in run_of_seed["counts"].items():
            for what, count in row.items():
                both["counts"][verb][what] += count
    return sums


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("command")
    parser.add_argument("mesh")
    parser.add_argument("--flips", type=int, default=2000)
    parser.add_argument("--kinds", nargs="+", default=list(KINDS), choices=list(KINDS))
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--results")
    parser.add_argument("--page", type=pathlib.Path)
    args = parser.parse_args()
    results = Results(args.results)
    with tempfile.TemporaryDirectory() as work:
        for kind in args.kinds:
            key = f"{kind} {args.seed}"
            if key not in results.runs:
                results.keep(key, flip_all(args, kind, work))
    sums = sums_by_kind(results.runs)
    lines = table(["file", "bytes", "commands", "flips", REFUSED, SAME, "other values", CRASH],
                  [row for kind in KINDS if kind in sums for row in rows_of(kind, sums[kind])])
    print("\n".join(lines))
    if args.page:
        replace_tables(args.page, lines, "flipped bits")
    wrong = sum(row[CHANGED] + row[CRASH] for found in results.runs.values() for row in found["counts"].values())
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
