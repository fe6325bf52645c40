# SPDX-License-Identifier: Apache-2.0
"""halves_test.py SCRIPTS: whatever list names a mesh, it belongs to the same half."""
import sys

sys.path.insert(0, sys.argv[1])
from halves import HALVES, all_halves  # noqa: E402

both = sorted(mesh for mesh, halves in all_halves().items() if len(halves) > 1)
assert not both, f"tuning in one list, judging in another: {', '.join(both)}"
named = {half for halves in all_halves().values() for half in halves}
assert named == set(HALVES), named
print(f"{len(all_halves())} meshes, each of one half")
