# SPDX-License-Identifier: Apache-2.0
"""The Python node that turns its input into a shell. Everything that does not need Houdini is in
vdb_shell_tool."""

import hou

import vdb_shell_tool as tool

# What stands in the node itself.
CODE = "import vdb_shell_sop\nvdb_shell_sop.cook(hou.pwd())\n"


def cook(node):
    # A node of an older scene has fewer parameters than the program knows.
    values = {parameter.name: value_of(node, parameter) for parameter in tool.parameters()
              if node.parm(parameter.name)}
    try:
        with hou.InterruptableOperation("Building the shell", open_interrupt_dialog=True) as operation:
            report = tool.replace_by_shell(node.geometry(), values, hou.Geometry,
                                           lambda: operation.updateProgress(0.0))
    except tool.ShellError as error:
        raise hou.NodeError(str(error))
    missed = tool.missed_bounds(report)
    if missed:
        # Last, so that the node has its shell.
        raise hou.NodeWarning(missed)


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
                                    [choice.replace("-", " ").capitalize() for choice in parameter.choices],
                                    default_value=parameter.choices.index(default), help=parameter.help)
    if parameter.kind == "flag":
        return hou.ToggleParmTemplate(name, label, default_value=default, help=parameter.help)
    if parameter.kind == "text":
        return hou.StringParmTemplate(name, label, 1, default_value=(default,), help=parameter.help)
    kind = hou.IntParmTemplate if parameter.kind == "int" else hou.FloatParmTemplate
    limits = {} if parameter.low is None else {"min": parameter.low, "min_is_strict": True}
    return kind(name, label, 1, default_value=(default,), help=parameter.help, **limits)


def add_parameters(node):
    """The result in front, a folder for each group of options behind."""
    group = node.parmTemplateGroup()
    folders = {}
    for parameter in tool.parameters():
        if parameter is tool.RESULT:
            group.append(template_of(parameter))
        else:
            folders.setdefault(parameter.group, []).append(template_of(parameter))
    for label, templates in folders.items():
        group.append(hou.FolderParmTemplate("folder_" + label.lower().replace(" ", "_"), label, templates))
    node.setParmTemplateGroup(group)


def create(kwargs):
    """For the shelf and the Tab menu."""
    import soptoolutils

    node = soptoolutils.genericTool(kwargs, "python")
    node.setName("vdb_shell", unique_name=True)
    add_parameters(node)
    node.parm("python").set(CODE)
    return node
