# SPDX-License-Identifier: Apache-2.0
"""The Python node that turns its input into a shell. Everything that does not need Houdini is in
vdb_shell_tool."""

import hou

import vdb_shell_tool as tool

# What stands in the node itself.
CODE = "import vdb_shell_sop\nvdb_shell_sop.cook(hou.pwd())\n"


def cook(node):
    values = {parameter.name: value_of(node, parameter) for parameter in tool.PARAMETERS}
    try:
        with hou.InterruptableOperation("Building the shell", open_interrupt_dialog=True) as operation:
            tool.replace_by_shell(node.geometry(), values, hou.Geometry,
                                  lambda: operation.updateProgress(0.0))
    except tool.ShellError as error:
        raise hou.NodeError(str(error))


def value_of(node, parameter):
    if parameter.kind == "menu":
        # As a string: evalParm gives the index of a menu's entry.
        return node.parm(parameter.name).evalAsString()
    value = node.evalParm(parameter.name)
    return bool(value) if parameter.kind == "flag" else value


def template_of(parameter):
    name, label, default = parameter.name, parameter.label, parameter.default
    if parameter.kind == "menu":
        return hou.MenuParmTemplate(name, label, parameter.choices,
                                    [choice.capitalize() for choice in parameter.choices],
                                    default_value=parameter.choices.index(default), help=parameter.help)
    if parameter.kind == "flag":
        return hou.ToggleParmTemplate(name, label, default_value=default, help=parameter.help)
    kind = hou.IntParmTemplate if parameter.kind == "int" else hou.FloatParmTemplate
    return kind(name, label, 1, default_value=(default,), min=0, min_is_strict=True, help=parameter.help)


def add_parameters(node):
    group = node.parmTemplateGroup()
    for parameter in tool.PARAMETERS:
        group.append(template_of(parameter))
    node.setParmTemplateGroup(group)


def create(kwargs):
    """For the shelf and the Tab menu."""
    import soptoolutils

    node = soptoolutils.genericTool(kwargs, "python")
    node.setName("vdb_shell", unique_name=True)
    add_parameters(node)
    node.parm("python").set(CODE)
    return node
