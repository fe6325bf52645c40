# SPDX-License-Identifier: Apache-2.0
"""Which meshes paper.py measures, where they lie, and the half that each belongs to.

Halves are those of halves.py, but that all of paper/ counts as tuned here.
"""
import halves
from runs import CLEAN_MESHES

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
    half = "tuning" if folder == "paper" else halves.half_of(mesh)
    return "tuned" if half == "tuning" else half


def by_half(names):
    """{half: [name]} in the order of `names`."""
    return {half: [name for name in names if half_of(name) == half] for half in HALVES}
