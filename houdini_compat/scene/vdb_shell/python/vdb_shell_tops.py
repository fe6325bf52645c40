# SPDX-License-Identifier: Apache-2.0
"""Task networks: one that builds the same mesh with several thicknesses, one work item each; and one that does what
`vdb_shell farm --engine tops` wrote."""

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


def farm_command(job, *words):
    """What each work item runs. Houdini would expand signs of its own in the name."""
    if any(sign in job for sign in "`$\"'\n"):
        raise ValueError(f"{job}: a name with ` $ or quotes would be expanded")
    script = os.path.abspath(tool.__file__)
    return " ".join(["__PDG_PYTHON__", shlex.quote(script), "farm-item", *words, shlex.quote(job)])


def create_farm(parent, job):
    """`job`: the list that `vdb_shell farm --engine tops` wrote. A work item for each task, and behind all of
    them one that joins their manifests."""
    job = os.path.abspath(job)
    tasks = tool.farm_list(job)["tasks"]
    network = parent.createNode("topnet", "vdb_shell_farm")
    run = network.createNode("genericgenerator", "tasks")
    run.parm("itemcount").set(len(tasks))
    run.parm("pdg_command").set(farm_command(job, "--index", "`@pdg_index`"))
    wait = network.createNode("waitforall", "all")
    wait.setInput(0, run)
    join = network.createNode("genericgenerator", "join")
    join.setInput(0, wait)
    join.parm("itemcount").set(1)
    join.parm("pdg_command").set(farm_command(job, "--join"))
    join.setDisplayFlag(True)
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
