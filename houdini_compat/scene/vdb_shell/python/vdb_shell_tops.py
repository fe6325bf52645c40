# SPDX-License-Identifier: Apache-2.0
"""A task network that builds the same mesh with several thicknesses, one work item each."""

import os
import shlex

import hou

import vdb_shell_tool as tool


def command(mesh, folder, count, low, high):
    """What each work item runs; TOPs replaces the backquotes by the item's own index."""
    script = os.path.abspath(tool.__file__)
    words = ["work-item", "--index", "`@pdg_index`", "--count", str(count), "--from", repr(low),
             "--to", repr(high), mesh, folder]
    quoted = [word if word == "`@pdg_index`" else shlex.quote(word) for word in words]
    return " ".join(["__PDG_PYTHON__", shlex.quote(script), *quoted])


def create(parent, mesh, folder, count, low, high):
    network = parent.createNode("topnet", "vdb_shell_thicknesses")
    shells = network.createNode("genericgenerator", "shells")
    shells.parm("itemcount").set(count)
    shells.parm("pdg_command").set(command(mesh, folder, count, low, high))
    shells.setDisplayFlag(True)
    network.layoutChildren()
    return network


def create_from_dialog():
    """For the shelf."""
    button, words = hou.ui.readMultiInput(
        "One shell for each thickness", ("Mesh", "Folder", "Count", "Smallest", "Largest"),
        buttons=("Create", "Cancel"), close_choice=1,
        initial_contents=("$HIP/mesh.obj", "$HIP/shells", "5", "0.05", "0.5"))
    if button != 0:
        return None
    mesh, folder, count, low, high = words
    return create(hou.node("/obj"), hou.text.expandString(mesh), hou.text.expandString(folder),
                  int(count), float(low), float(high))
