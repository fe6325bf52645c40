// SPDX-License-Identifier: Apache-2.0

// Takes: a stack. Gives: which vertices of which surfaces share a point. It is the one place that
// decides it; tets, the certificate and the files go by its answer. Coordinates are compared as
// numbers and not as bits: a pillar from -0 to 0 has no length, and in two points its tets would be
// flat.

#include "vdb_shell/shell/shared_points.h"

#include "mesh/equal_points.h"

#include <cassert>
#include <limits>

namespace vdb_shell
{
namespace
{

/// Surfaces from the outermost inward, so that a chain of pins ends at its top.
std::vector<std::uint32_t> ends_of_pins(const PrismShell* layers, std::size_t count)
{
    const std::size_t vertices = layers->outer.size();
    std::vector<std::uint32_t> first((count + 1) * vertices);
    for (std::size_t v = 0; v < vertices; ++v)
        first[v] = static_cast<std::uint32_t>(v);
    for (std::size_t k = 0; k < count; ++k)
        for (std::size_t v = 0; v < vertices; ++v) {
            const std::size_t above = k * vertices + v, below = above + vertices;
            first[below] = layers[k].pinned(v) ? first[above] : static_cast<std::uint32_t>(below);
        }
    return first;
}

std::vector<std::uint32_t> equal_places(const PrismShell* layers, std::size_t count)
{
    std::vector<openvdb::Vec3s> points = layers->outer;
    for (std::size_t k = 0; k < count; ++k)
        points.insert(points.end(), layers[k].inner.begin(), layers[k].inner.end());
    return first_equal_point(points);
}

} // namespace

std::vector<std::uint32_t> first_places(const PrismShell* layers, std::size_t count, bool tapered)
{
    assert(count > 0);
    assert((count + 1) * layers->outer.size() < std::numeric_limits<std::uint32_t>::max());
    return tapered ? equal_places(layers, count) : ends_of_pins(layers, count);
}

std::vector<std::uint32_t> first_places(const ShellStack& stack)
{
    return first_places(stack.layers.data(), stack.layers.size(), stack.tapered);
}

} // namespace vdb_shell
