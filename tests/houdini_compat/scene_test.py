#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The Houdini scene side with a stand-in for Houdini.

    scene_test.py COMMAND MESH

COMMAND is the real program, MESH a closed .obj that it can make a shell of.
"""

import json
import os
import re
import shutil
import stat
import subprocess
import sys
import tempfile
import unittest
import warnings
import xml.etree.ElementTree

HERE = os.path.dirname(os.path.abspath(__file__))
SCENE = os.path.join(HERE, "..", "..", "houdini_compat", "scene")
PYTHON = os.path.join(SCENE, "vdb_shell", "python")
COMMAND, MESH = (os.path.abspath(path) for path in sys.argv[1:3])
sys.dont_write_bytecode = True
sys.path[:0] = [PYTHON, os.path.join(HERE, "stand_in")]
os.environ["VDB_SHELL_COMMAND"] = COMMAND

import hou  # noqa: E402
import vdb_shell_sop as sop  # noqa: E402
import vdb_shell_tool as tool  # noqa: E402
import vdb_shell_tops as tops  # noqa: E402


def with_program(folder, script):
    """A program of a few lines of shell in the command's place."""
    path = os.path.join(folder, "program")
    with open(path, "w", encoding="utf-8") as file:
        file.write("#!/bin/sh\n" + script)
    os.chmod(path, os.stat(path).st_mode | stat.S_IXUSR)
    return path


class Scene(unittest.TestCase):
    def setUp(self):
        holder = tempfile.TemporaryDirectory()
        self.addCleanup(holder.cleanup)
        self.addCleanup(os.environ.__setitem__, "VDB_SHELL_COMMAND", COMMAND)
        self.addCleanup(setattr, hou.InterruptableOperation, "interrupt_after", None)
        self.folder = holder.name
        tool.parameters()  # asked of the real program, whatever a test puts in its place

    def in_place(self, script):
        os.environ["VDB_SHELL_COMMAND"] = with_program(self.folder, script)

    def houdini_mesh(self, turned=True):
        """The mesh as Houdini's own file: polygons turned the other way, as Houdini has them."""
        step = -1 if turned else 1
        points, faces = [], []
        with open(MESH, encoding="ascii") as file:
            for words in map(str.split, file):
                if words[:1] == ["v"]:
                    points.append([float(word) for word in words[1:4]])
                elif words[:1] == ["f"]:
                    faces.append([int(word.split("/")[0]) - 1 for word in words[1:]][::step])
        corners = [corner for face in faces for corner in face]
        sizes = []
        for face in faces:
            if sizes and sizes[-2] == len(face):
                sizes[-1] += 1
            else:
                sizes += [len(face), 1]
        document = [
            "fileversion", "20.5.550", "hasindex", False, "pointcount", len(points),
            "vertexcount", len(corners), "primitivecount", len(faces), "info", {"software": "a test"},
            "topology", ["pointref", ["indices", corners]],
            "attributes", ["pointattributes", [[
                ["scope", "public", "type", "numeric", "name", "P",
                 "options", {"type": {"type": "string", "value": "point"}}],
                ["size", 3, "storage", "fpreal32",
                 "defaults", ["size", 1, "storage", "fpreal64", "values", [0]],
                 "values", ["size", 3, "storage", "fpreal32", "tuples", points]]]]],
            "primitives", [[["type", "Polygon_run"],
                            ["startvertex", 0, "nprimitives", len(faces), "nvertices_rle", sizes]]]]
        path = os.path.join(self.folder, "mesh.geo")
        with open(path, "w", encoding="ascii") as file:
            json.dump(document, file)
        return path

    def node(self, **values):
        node = sop.create({})
        for name, value in values.items():
            items = node.parm(name)._items
            node.parm(name).set(items.index(value) if items else value)
        return node

    # Files

    def test_package_is_relocatable(self):
        with open(os.path.join(SCENE, "vdb_shell.json"), encoding="utf-8") as file:
            package = json.load(file)
        places = [package["hpath"]]
        for entry in package["env"]:
            (name, change), = entry.items()
            self.assertIn(change["method"], ("prepend", "append"), f"{name} would be lost")
            places.append(change["value"])
        for place in places:
            self.assertTrue(place.startswith("$HOUDINI_PACKAGE_PATH/"), place)
            self.assertTrue(os.path.isdir(place.replace("$HOUDINI_PACKAGE_PATH", SCENE)), place)
        self.assertRegex(package["enable"], r"^houdini_version >= '\d+\.\d+'$")

    def test_shelf_is_well_formed_and_its_scripts_run(self):
        shelf = xml.etree.ElementTree.parse(os.path.join(SCENE, "vdb_shell", "toolbar", "vdb_shell.shelf"))
        self.assertEqual(shelf.getroot().tag, "shelfDocument")
        members = [member.get("name") for member in shelf.iter("memberTool")]
        tools = {entry.get("name"): entry for entry in shelf.iter("tool")}
        self.assertEqual(members, list(tools))
        hou.ui.answer = (1, ())
        for name, entry in tools.items():
            self.assertTrue(entry.get("label"))
            script = entry.find("script")
            self.assertEqual(script.get("scriptType"), "python")
            exec(compile(script.text, name, "exec"), {"kwargs": {}})

    def test_nothing_but_the_thin_modules_knows_hou(self):
        with open(tool.__file__, encoding="utf-8") as file:
            self.assertIsNone(re.search(r"^\s*(import|from) hou\b", file.read(), re.MULTILINE))
        code = "import sys; sys.path[:] = [p for p in sys.path if 'stand_in' not in p]; import vdb_shell_tool"
        subprocess.run([sys.executable, "-B", "-c", code], cwd=PYTHON, check=True)

    def test_the_stand_in_refuses_what_it_does_not_know(self):
        with self.assertRaises(AttributeError):
            hou.Geometry().loadEverything("x")
        with self.assertRaises(TypeError):
            hou.Geometry().loadFromFile("x", "y")
        with self.assertRaises(AttributeError):
            hou.selectedThings()

    # The command line

    def test_every_option_is_one_of_the_command(self):
        text = subprocess.run([COMMAND, "build", "--help"], capture_output=True, text=True, check=True).stdout
        self.assertGreater(len(tool.parameters()), 50)
        for parameter in tool.parameters():
            if parameter.flag:
                self.assertRegex(text, rf"(^|[\s,]){parameter.flag}\b", parameter.flag)
            if parameter.flag and parameter.choices:
                self.assertRegex(text, rf"{parameter.flag} NAME={parameter.default}\b")
                choices = re.search(rf"{parameter.flag} NAME.*?\(([^)]*)\)", text, re.DOTALL)[1]
                self.assertEqual(sorted(choices.split(", ")), sorted(parameter.choices))
            if parameter.kind == "int" and parameter.unset is None:
                self.assertRegex(text, rf"{parameter.flag} U?INT(:\S+)?={parameter.default}\b")

    def test_every_value_that_means_none_is_impossible(self):
        options = {option["flag"]: option for option in tool.schema()["commands"]["build"]["options"]}
        unset = [parameter for parameter in tool.parameters() if parameter.unset is not None]
        self.assertIn("thickness", [parameter.name for parameter in unset])
        for parameter in unset:
            refused = subprocess.run([COMMAND, "build", "none.obj", "-q", "-o", "none.vtu", parameter.flag,
                                      str(parameter.unset)], capture_output=True, text=True)
            self.assertEqual(refused.returncode, 2, parameter.name)
            self.assertIn(f"{parameter.flag} is ", refused.stderr)
            self.assertIsNone(options[parameter.flag]["default"])

    def test_defaults_give_no_options(self):
        self.assertEqual(tool.option_words(tool.defaults()), [])
        self.assertEqual(tool.option_words({"thickness": 0.1, "half": True, "method": "raw", "flips": False}),
                         ["--half", "--thickness", "0.1", "--method", "raw", "--no-flips"])

    def test_wrong_values_are_named(self):
        with self.assertRaisesRegex(ValueError, "method.*'fast'"):
            tool.option_words({"method": "fast"})
        with self.assertRaisesRegex(ValueError, "no such parameters: colour"):
            tool.option_words({"colour": 3})
        with self.assertRaisesRegex(ValueError, "result.*'picture'"):
            tool.replace_by_shell(self.geometry(MESH), {"result": "picture"}, hou.Geometry)

    def test_names_with_blanks_and_dashes_arrive(self):
        words = tool.command_line("-mesh 1.obj", ["a b.vdb"], {})
        self.assertTrue(words[-1].endswith("/-mesh 1.obj") and os.path.isabs(words[-1]))
        self.assertTrue(words[words.index("--output") + 1].endswith("/a b.vdb"))

    # Running

    def geometry(self, mesh):
        geometry = hou.Geometry()
        geometry.mesh_file = mesh
        return geometry

    def test_report_of_the_real_command(self):
        output = os.path.join(self.folder, "with blank.vtu")
        report = tool.build(MESH, [output], {"resolution": 32, "thickness": 0.05})
        self.assertGreater(os.path.getsize(output), 0)
        self.assertLessEqual(report["lines"]["length"]["max"], 0.05)
        self.assertRegex(tool.summary(report), r"^\d+ tets, [\d.]+% of the solid, certified$")

    def test_refusal_is_the_commands_own_line(self):
        with open(os.path.join(self.folder, "open.obj"), "w", encoding="ascii") as file:
            file.write("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
        with self.assertRaisesRegex(tool.ShellError, "open.obj.*boundary") as caught:
            tool.build(file.name, [os.path.join(self.folder, "a.vtu")], {})
        self.assertEqual(caught.exception.status, 4)

    def test_a_bound_that_is_not_met_is_a_warning(self):
        output = os.path.join(self.folder, "wanted.vtu")
        values = {"resolution": 32, "want_amips": 3.0}
        with self.assertWarnsRegex(tool.ShellWarning, rf"^{os.path.basename(MESH)}: wanted amips 3, reached [\d.]+$"):
            report = tool.build(MESH, [output], values)
        self.assertGreater(os.path.getsize(output), 0)
        self.assertEqual([(bound["bound"], bound["met"]) for bound in report["wanted"]["bounds"]], [("amips", False)])
        self.assertRegex(tool.summary(report), r"certified, wanted amips 3, reached [\d.]+$")
        # The node has its shell all the same, and a warning.
        node = self.node(**values)
        node.geometry().mesh_file = MESH
        self.addCleanup(setattr, tool, "MESH_EXTENSION", tool.MESH_EXTENSION)
        tool.MESH_EXTENSION = ".obj"
        with self.assertWarns(tool.ShellWarning), self.assertRaisesRegex(hou.NodeWarning, r"^wanted amips 3, reached"):
            sop.cook(node)
        self.assertEqual([name for name, _ in node.geometry()._contents], ["shell.bgeo.sc"])

    def test_a_shell_that_is_not_valid_is_there_all_the_same(self):
        output = os.path.join(self.folder, "raw.vtu")
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            report = tool.build(MESH, [output], {"resolution": 32, "method": "raw", "stop_test": "none", "thickness": 3.0})
        self.assertGreater(os.path.getsize(output), 0)
        self.assertRegex(tool.summary(report), "not certified$")

    def test_a_program_that_is_not_there(self):
        os.environ["VDB_SHELL_COMMAND"] = os.path.join(self.folder, "none")
        with self.assertRaisesRegex(tool.ShellError, "none cannot be started"):
            tool.build(MESH, ["a.vtu"], {})

    def test_a_silent_failure_has_a_status(self):
        self.in_place("exit 9\n")
        with self.assertRaisesRegex(tool.ShellError, "status 9"):
            tool.build(MESH, ["a.vtu"], {})

    def test_an_interrupted_program_is_ended(self):
        self.in_place("echo $$ > '" + self.folder + "/pid'\nexec sleep 60\n")
        hou.InterruptableOperation.interrupt_after = 20
        node = self.node()
        node.geometry().mesh_file = MESH
        with self.assertRaises(hou.OperationInterrupted):
            sop.cook(node)
        with open(os.path.join(self.folder, "pid"), encoding="ascii") as file:
            with self.assertRaises(ProcessLookupError):
                os.kill(int(file.read()), 0)

    # The node

    def test_node_has_the_parameters_and_its_code_cooks(self):
        node = self.node(resolution=32, result="both")
        self.assertEqual(node._type, "python")
        node.geometry().mesh_file = self.houdini_mesh()
        # The stand-in copies its file under any name, so the node is told which form it is.
        self.addCleanup(setattr, tool, "MESH_EXTENSION", tool.MESH_EXTENSION)
        tool.MESH_EXTENSION = ".geo"
        hou._current.append(node)
        self.addCleanup(hou._current.pop)
        exec(node.evalParm("python"), {"hou": hou})
        (shell_name, shell), (volume_name, volume) = node.geometry()._contents
        self.assertEqual((shell_name, volume_name), ("shell.bgeo.sc", "shell.vdb"))
        self.assertEqual(shell[:4], b"scf1")
        self.assertEqual(volume[:4], b" BDV")

    def test_orientation_of_houdini_is_understood(self):
        shell = os.path.join(self.folder, "shell.vtu")
        by_houdini = tool.build(self.houdini_mesh(), [shell], {"resolution": 32})
        by_obj = tool.build(MESH, [shell], {"resolution": 32})
        # Quads may be cut along their other diagonal.
        self.assertEqual(by_houdini["volume"]["solid"], by_obj["volume"]["solid"])
        self.assertEqual(by_houdini["tets"], by_obj["tets"])
        with self.assertRaisesRegex(tool.ShellError, "--turn-outward"):
            tool.build(self.houdini_mesh(turned=False), [shell], {"resolution": 32})

    def test_node_says_what_the_command_says_and_keeps_its_geometry(self):
        self.in_place("echo 'vdb_shell: mesh: 3 boundary edges' >&2\nexit 4\n")
        node = self.node()
        node.geometry().mesh_file = MESH
        with self.assertRaisesRegex(hou.NodeError, "3 boundary edges"):
            sop.cook(node)
        self.assertEqual(node.geometry()._contents, [])

    # Tasks

    def test_task_network(self):
        network = tops.create(hou.node("/obj"), "/my mesh.obj", "/out", 4, 0.1, 0.4)
        item, = network._children
        self.assertEqual((item._type, item.evalParm("itemcount")), ("genericgenerator", 4))
        command = item.evalParm("pdg_command")
        self.assertTrue(command.startswith("__PDG_PYTHON__ "))
        self.assertIn("--index `@pdg_index` --count 4 --from 0.1 --to 0.4 '/my mesh.obj' /out", command)

    def test_dialog_can_be_cancelled_and_expands_variables(self):
        hou.ui.answer = (1, ("", "", "", "", ""))
        self.assertIsNone(tops.create_from_dialog())
        hou.ui.answer = (0, ("$HIP/m.obj", "$HIP/out", "2", "0.1", "0.2"))
        item, = tops.create_from_dialog()._children
        self.assertIn("/hip/m.obj /hip/out", item.evalParm("pdg_command"))

    def test_work_items_run_as_the_network_says(self):
        network = tops.create(hou.node("/obj"), MESH, self.folder, 3, 0.02, 0.06)
        command = network._children[0].evalParm("pdg_command")
        command = command.replace("__PDG_PYTHON__", sys.executable + " -B").replace("`@pdg_index`", "2")
        result = subprocess.run(command + " --resolution 32", shell=True, capture_output=True, text=True)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("thickness 0.06", result.stdout)
        self.assertTrue(os.path.isfile(os.path.join(self.folder, "shell.0002.bgeo.sc")))
        failed = subprocess.run(command.replace("--index 2", "--index 3"), shell=True, capture_output=True)
        self.assertNotEqual(failed.returncode, 0)

    # Farms

    def farm(self, *words):
        """The network of a job of three frames, in tasks of two, and the program's call for a node and an index."""
        for frame in (1, 2, 3):
            shutil.copy(MESH, os.path.join(self.folder, f"it's.{frame}.obj"))
        subprocess.run([COMMAND, "farm", "--engine", "tops", "-o", "job.json", "--chunk", "2", *words, "--", "build",
                        "it's.#.obj", "-o", "t.#.vtu", "--frames", "1-3", "--voxel-size", "0.1", "--samples", "0", "-q"],
                       cwd=self.folder, check=True, capture_output=True)
        network = tops.create_farm(hou.node("/obj"), os.path.join(self.folder, "job.json"))

        def call(node, index=0):
            command = node.evalParm("pdg_command").replace("`@pdg_index`", str(index))
            return subprocess.run(command.replace("__PDG_PYTHON__", sys.executable + " -B"), shell=True, capture_output=True,
                                  text=True)
        return network, call

    def test_farm_network_does_a_sequence(self):
        network, call = self.farm()
        run, wait, join = network._children
        self.assertEqual([run._type, wait._type, join._type], ["genericgenerator", "waitforall", "genericgenerator"])
        self.assertEqual([wait._inputs, join._inputs], [{0: run}, {0: wait}])
        self.assertEqual([run.evalParm("itemcount"), join.evalParm("itemcount")], [2, 1])
        self.assertEqual(call(run, 1).returncode, 0)
        early = call(join)
        self.assertEqual((early.returncode, "not done: 1-2" in early.stdout), (7, True), early.stdout)
        self.assertEqual(call(run, 0).returncode, 0)
        whole = call(join)
        self.assertEqual((whole.returncode, "3 of 3 frames done" in whole.stdout), (0, True), whole.stdout)
        self.assertTrue(all(os.path.isfile(os.path.join(self.folder, f"t.{frame}.vtu")) for frame in (1, 2, 3)))
        self.assertNotEqual(call(run, 2).returncode, 0)

    def test_farm_tasks_pass_their_status_on(self):
        network, call = self.farm()
        with open(os.path.join(self.folder, "it's.1.obj"), "w", encoding="ascii") as file:
            file.write("v 0 0 zero\n")
        self.assertEqual(call(network._children[0], 0).returncode, 3)
        with self.assertRaisesRegex(ValueError, "expanded"):
            tops.farm_command("/a$b/job.json", "--join")

    def test_thicknesses_span_the_range(self):
        values = [tool.thickness_of(i, 5, 0.1, 0.5) for i in range(5)]
        self.assertEqual((values[0], values[-1]), (0.1, 0.5))
        self.assertTrue(all(a < b for a, b in zip(values, values[1:])))
        self.assertEqual(tool.thickness_of(0, 1, 0.1, 0.5), 0.1)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0]])
