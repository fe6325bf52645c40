# SPDX-License-Identifier: Apache-2.0
"""Which meshes paper.py measures, where they lie, and the half that each belongs to.

tuned: looked at while a number of the library was chosen. judging: only measured. The lists are docs/measurements/scan_meshes.txt
and shape_meshes.txt; a mesh that either of them tuned with is tuned here, as is all of paper/.
"""
import pathlib

from runs import CLEAN_MESHES

LISTS = [pathlib.Path(__file__).parent.parent / "measurements" / name for name in ("scan_meshes.txt", "shape_meshes.txt")]
# Of the collection odedstein-meshes (objects/*/NAME.obj at commit 8352132), six of the seven smallest of the judging half of scan_meshes.txt, so that
# exact counts of millions of overlapping pairs take seconds.
JUDGING = ["judging/fish_low_resolution", "judging/koala_low_resolution", "judging/scorpion_low_resolution", "judging/hand_closed",
           "judging/springer", "judging/mushroom"]
ALL_MESHES = [*CLEAN_MESHES, *JUDGING]
HALVES = ["tuned", "judging"]


class Meshes:
    """Files by name: paper/ and artist/ of one folder, judging/ of another, at any depth."""

    def __init__(self, folder, judging):
        self.folder, self.judging = folder, judging

    def path(self, name):
        """Raises FileNotFoundError, naming the mesh and the folder it was looked for in."""
        folder, _, mesh = name.partition("/")
        found = sorted(self.judging.rglob(f"{mesh}.obj")) if folder == "judging" else [self.folder / f"{name}.obj"]
        if not found or not found[0].exists():
            raise FileNotFoundError(f"{mesh}.obj is not in {self.judging if folder == 'judging' else self.folder / folder}")
        return found[0]


def half_of(name):
    folder, _, mesh = name.partition("/")
    if folder == "paper":
        return "tuned"
    halves = set()
    for path in LISTS:
        for words in (line.split() for line in path.read_text().splitlines() if line.strip() and not line.startswith("#")):
            if pathlib.PurePosixPath(words[1]).name == mesh:
                halves.add(words[0])
    if not halves:
        return "not listed"
    return "tuned" if "tuning" in halves else "judging"


def by_half(names):
    """{half: [name]} in the order of `names`."""
    return {half: [name for name in names if half_of(name) == half] for half in HALVES}
