# SPDX-License-Identifier: Apache-2.0
"""Stands in for the module of the same name; https://www.sidefx.com/docs/houdini/hom/tool_script.html."""

import hou


def genericTool(scriptargs, nodetypename):
    assert isinstance(scriptargs, dict)
    return hou.Node(nodetypename, nodetypename + "1")
