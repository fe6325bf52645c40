// SPDX-License-Identifier: Apache-2.0
#include "resample/component_sides.h"

#include "core/disjoint_sets.h"
#include "mesh/exact_volume.h"

namespace vdb_shell
{
namespace
{

/// By vertex, numbered in the order of their first vertices; a vertex without triangles is one by
/// itself.
std::vector<std::uint32_t> component_of_vertices(const TriangleMesh& mesh, std::size_t& count)
{
    DisjointSets sets(mesh.points.size());
    for (const openvdb::Vec3I& t : mesh.triangles) {
        sets.join(t[0], t[1]);
        sets.join(t[0], t[2]);
    }
    std::vector<std::uint32_t> component(mesh.points.size());
    count = 0;
    for (std::uint32_t v = 0; v < component.size(); ++v) {
        const std::uint32_t root = sets.root_of(v);
        component[v] = root == v ? static_cast<std::uint32_t>(count++) : component[root];
    }
    return component;
}

/// `component`: of a triangle's first corner.
template <typename Component>
std::vector<int> volume_signs(const TriangleMesh& mesh, std::size_t count,
                              const Component& component)
{
    std::vector<std::vector<std::uint32_t>> triangles(count);
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
        triangles[component(mesh.triangles[t][0])].push_back(t);
    std::vector<int> signs(count);
    for (std::size_t c = 0; c < count; ++c)
        signs[c] = exact::volume_sign(mesh.points, mesh.triangles, triangles[c]);
    return signs;
}

} // namespace

ComponentSides::ComponentSides(const TriangleMesh& mesh)
{
    std::size_t count = 0;
    component_ = component_of_vertices(mesh, count);
    sign_ = volume_signs(mesh, count, [&](std::uint32_t v) { return component_[v]; });
}

bool ComponentSides::hold_turned(const Coarsened& left, std::vector<char>& fixed) const
{
    const std::vector<int> signs = volume_signs(
        left.mesh, sign_.size(), [&](std::uint32_t v) { return component_[left.from[v]]; });
    if (signs == sign_)
        return false;
    for (std::size_t v = 0; v < component_.size(); ++v)
        if (signs[component_[v]] != sign_[component_[v]])
            fixed[v] = 1;
    return true;
}

} // namespace vdb_shell
