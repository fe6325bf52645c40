# SPDX-License-Identifier: Apache-2.0
"""Stands in for Houdini's module `hou` where Houdini is not there.

It has what our scripts call, with the arguments that the public documentation gives them, and
nothing else: any other name is an AttributeError, any other argument a TypeError. Each entry names
its page under https://www.sidefx.com/docs/houdini/hom/hou/.
"""

import os


class Error(Exception):  # Error.html
    pass


class NodeError(Error):  # NodeError.html
    pass


class NodeWarning(Error):  # NodeWarning.html
    pass


class OperationInterrupted(Error):  # OperationInterrupted.html
    pass


class InterruptableOperation:  # InterruptableOperation.html
    interrupt_after = None  # the test's own: how many updates until the user presses Escape

    def __init__(self, operation_name, long_operation_name=None, open_interrupt_dialog=False):
        self.updates = 0

    def __enter__(self):
        return self

    def __exit__(self, *unused):
        return False

    def updateProgress(self, percentage=-1.0):
        assert percentage == -1.0 or 0.0 <= percentage <= 1.0
        self.updates += 1
        if self.interrupt_after is not None and self.updates > self.interrupt_after:
            raise OperationInterrupted()


class Geometry:  # Geometry.html
    """The files it reads and writes are only passed through."""

    mesh_file = None  # the test's own: what is saved

    def __init__(self):
        self._contents = []

    def saveToFile(self, file_name):
        with open(self.mesh_file, "rb") as source, open(file_name, "wb") as target:
            target.write(source.read())

    def loadFromFile(self, file_name):
        with open(file_name, "rb") as file:
            self._contents = [(os.path.basename(file_name), file.read())]

    def merge(self, geometry):
        self._contents += geometry._contents


class ParmTemplate:  # ParmTemplate.html
    def __init__(self, name, label, default):
        assert name.isidentifier()
        self._name, self._label, self._default = name, label, default

    def name(self):
        return self._name


class IntParmTemplate(ParmTemplate):  # IntParmTemplate.html
    def __init__(self, name, label, num_components, default_value=(), min=0, max=10,
                 min_is_strict=False, max_is_strict=False, help=None):
        assert len(default_value) == num_components and all(type(v) is int for v in default_value)
        super().__init__(name, label, default_value[0])


class FloatParmTemplate(ParmTemplate):  # FloatParmTemplate.html
    def __init__(self, name, label, num_components, default_value=(), min=0.0, max=10.0,
                 min_is_strict=False, max_is_strict=False, help=None):
        assert len(default_value) == num_components and all(type(v) is float for v in default_value)
        super().__init__(name, label, default_value[0])


class StringParmTemplate(ParmTemplate):  # StringParmTemplate.html
    def __init__(self, name, label, num_components, default_value=(), help=None):
        assert len(default_value) == num_components and all(type(v) is str for v in default_value)
        super().__init__(name, label, default_value[0])


class ToggleParmTemplate(ParmTemplate):  # ToggleParmTemplate.html
    def __init__(self, name, label, default_value=False, help=None):
        assert type(default_value) is bool
        super().__init__(name, label, int(default_value))


class MenuParmTemplate(ParmTemplate):  # MenuParmTemplate.html
    def __init__(self, name, label, menu_items, menu_labels=(), default_value=0, help=None):
        assert 0 <= default_value < len(menu_items) and len(menu_labels) in (0, len(menu_items))
        super().__init__(name, label, default_value)
        self._items = tuple(menu_items)


class FolderParmTemplate(ParmTemplate):  # FolderParmTemplate.html
    def __init__(self, name, label, parm_templates=()):
        super().__init__(name, label, None)
        self._templates = list(parm_templates)

    def parmTemplates(self):
        return tuple(self._templates)


class ParmTemplateGroup:  # ParmTemplateGroup.html
    def __init__(self, parm_templates=()):
        self._templates = list(parm_templates)

    def _all(self):
        for template in self._templates:
            yield template
            if isinstance(template, FolderParmTemplate):
                yield from template.parmTemplates()

    def append(self, parm_template):
        self._templates.append(parm_template)
        names = [template.name() for template in self._all()]
        assert len(names) == len(set(names)), "name given twice"


class Parm:  # Parm.html
    def __init__(self, value, items=None):
        self._value, self._items = value, items

    def set(self, value):
        self._value = value

    def evalAsString(self):
        return self._items[self._value] if self._items else str(self._value)


class Node:  # Node.html, OpNode.html, SopNode.html
    # The parameters that these types have of their own.
    _OWN = {"python": ("python",), "genericgenerator": ("itemcount", "pdg_command"), "topnet": ()}

    def __init__(self, type_name, name):
        self._type, self._name = type_name, name
        self._parms = {parm: Parm("") for parm in self._OWN.get(type_name, ())}
        self._children, self._geometry, self._displayed = [], Geometry(), False
        self._inputs = {}

    def geometry(self):
        return self._geometry

    def parm(self, parm_path):
        return self._parms.get(parm_path)

    def evalParm(self, parm_path):
        return self._parms[parm_path]._value

    def parmTemplateGroup(self):
        return ParmTemplateGroup()

    def setParmTemplateGroup(self, parm_template_group, rename_conflicting_parms=False):
        for template in parm_template_group._all():
            if isinstance(template, FolderParmTemplate):
                continue
            self._parms[template.name()] = Parm(template._default, getattr(template, "_items", None))

    def setName(self, name, unique_name=False):
        self._name = name

    def createNode(self, node_type_name, node_name=None):
        child = Node(node_type_name, node_name)
        self._children.append(child)
        return child

    def setInput(self, input_index, item_to_become_input, output_index=0):
        self._inputs[input_index] = item_to_become_input

    def layoutChildren(self):
        pass

    def setDisplayFlag(self, on):
        self._displayed = on


_objects = Node("obj", "obj")
_current = []  # the test's own: the node that cooks


def node(path):  # node_.html
    return _objects if path == "/obj" else None


def pwd():  # pwd.html
    return _current[-1]


class ui:  # ui.html
    answer = None  # the test's own: button and texts

    @classmethod
    def readMultiInput(cls, message, input_labels, password_input_indices=(), buttons=("OK",),
                       default_choice=0, close_choice=-1, help=None, title=None, initial_contents=()):
        assert len(initial_contents) in (0, len(input_labels)) and close_choice < len(buttons)
        return cls.answer


class text:  # text.html
    @staticmethod
    def expandString(text):
        return text.replace("$HIP", "/hip")
