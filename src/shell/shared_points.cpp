// SPDX-License-Identifier: Apache-2.0

// Takes: a stack. Gives: which vertices of which surfaces share a point. It is the one place that
// decides it; tets, the certificate and the files go by its answer. Coordinates are compared as
// numbers and not as bits: a pillar from -0 to 0 has no length, and in two points its tets would be
// flat.

#include "vdb_shell/shell/shared_points.h"

#include "mesh/equal_points.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <limits>
#include <map>
#include <utility>

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

/// The corners in ascending order, and whether that takes an even permutation.
std::pair<std::array<std::uint32_t, 3>, bool> turn_of(const openvdb::Vec3I& face)
{
    const int least = face[0] < face[1] ? (face[0] < face[2] ? 0 : 2) : (face[1] < face[2] ? 1 : 2);
    const std::uint32_t a = face[least], b = face[(least + 1) % 3], c = face[(least + 2) % 3];
    return {{a, std::min(b, c), std::max(b, c)}, b < c};
}

/// The faces, in their order, less pairs of the same corners and opposite turn.
std::vector<openvdb::Vec3I> without_opposite(const std::vector<openvdb::Vec3I>& faces)
{
    std::map<std::array<std::uint32_t, 3>, int> sum;
    for (const openvdb::Vec3I& face : faces) {
        const auto [corners, even] = turn_of(face);
        sum[corners] += even ? 1 : -1;
    }
    std::vector<openvdb::Vec3I> left;
    for (const openvdb::Vec3I& face : faces) {
        const auto [corners, even] = turn_of(face);
        int& more = sum[corners];
        if (even ? more <= 0 : more >= 0)
            continue;
        more -= even ? 1 : -1;
        left.push_back(face);
    }
    return left;
}

/// Replaces the places in the triangles by points in the order of the vertices.
void number_points(const std::vector<openvdb::Vec3s>& surface, const std::uint32_t* place,
                   TriangleMesh& mesh)
{
    std::map<std::uint32_t, std::uint32_t> number;
    for (const openvdb::Vec3I& face : mesh.triangles)
        for (int k = 0; k < 3; ++k)
            number.emplace(face[k], 0);
    for (std::size_t v = 0; v < surface.size(); ++v) {
        const auto found = number.find(place[v]);
        // The first vertex that has the point gives it its number.
        if (found == number.end() || found->second != 0)
            continue;
        mesh.points.push_back(surface[v]);
        found->second = static_cast<std::uint32_t>(mesh.points.size());
    }
    for (openvdb::Vec3I& face : mesh.triangles)
        for (int k = 0; k < 3; ++k)
            face[k] = number.at(face[k]) - 1;
}

} // namespace

std::vector<std::uint32_t> first_places(const PrismShell* layers, std::size_t count, bool tapered)
{
    assert(count > 0);
    assert((count + 1) * layers->outer.size() < std::numeric_limits<std::uint32_t>::max());
    return tapered ? equal_places(layers, count) : ends_of_pins(layers, count);
}

TriangleMesh inner_surface(const ShellStack& stack)
{
    const std::size_t last = stack.layers.size();
    if (!stack.tapered)
        return {stack.surface(last), stack.triangles()};
    const std::vector<std::uint32_t> first = first_places(stack);
    const std::uint32_t* place = first.data() + last * stack.surface(0).size();
    std::vector<openvdb::Vec3I> faces;
    for (const openvdb::Vec3I& t : stack.triangles()) {
        const openvdb::Vec3I face(place[t[0]], place[t[1]], place[t[2]]);
        if (face[0] != face[1] && face[1] != face[2] && face[2] != face[0])
            faces.push_back(face);
    }
    TriangleMesh mesh;
    mesh.triangles = without_opposite(faces);
    number_points(stack.surface(last), place, mesh);
    return mesh;
}

std::vector<std::uint32_t> first_places(const ShellStack& stack)
{
    return first_places(stack.layers.data(), stack.layers.size(), stack.tapered);
}

} // namespace vdb_shell
