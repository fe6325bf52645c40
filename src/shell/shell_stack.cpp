// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/shell/shell_stack.h"

#include <utility>

namespace vdb_shell
{

ShellStack one_layer(PrismShell shell, PrismSplit split)
{
    ShellStack stack;
    stack.layers.push_back(std::move(shell));
    stack.splits.push_back(std::move(split));
    return stack;
}

PrismShell hull_of(const ShellStack& stack)
{
    const bool outward = stack.skin == stack.layers.size();
    const PrismShell& end = outward ? stack.layers.front() : stack.layers.back();
    return {stack.layers.front().outer, stack.layers.back().inner, stack.triangles(), end.stop};
}

} // namespace vdb_shell
