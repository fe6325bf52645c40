// SPDX-License-Identifier: Apache-2.0

// Takes: a shell, or a stack of layers. Gives: the stack of one layer, or the two free surfaces of
// a stack as one shell. The layers share their triangles, so the hull is a shell like any other,
// and the certificate's tests of surfaces and regions run on it unchanged (docs/theory.md, "Several
// components"). It has no split of its own: its pillars run through all layers, and no tet of the
// result stands on them.

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

TriangleMesh skin_surface(const ShellStack& stack)
{
    return {stack.surface(stack.skin), stack.triangles()};
}

PrismShell hull_of(const ShellStack& stack)
{
    const bool outward = stack.skin == stack.layers.size();
    // The reason to stop is that of the grown end. For a shell on both sides there are two, and the
    // inward one is given.
    const PrismShell& end = outward ? stack.layers.front() : stack.layers.back();
    return {stack.layers.front().outer, stack.layers.back().inner, stack.triangles(), end.stop};
}

double pillar_length(const ShellStack& stack, std::size_t vertex)
{
    double sum = 0;
    for (const PrismShell& layer : stack.layers)
        sum += layer.length(vertex);
    return sum;
}

} // namespace vdb_shell
