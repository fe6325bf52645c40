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
std::vector<int> component_of_vertices(const TriangleMesh& mesh, int& count)
{
    DisjointSets sets(mesh.points.size());
    for (const openvdb::Vec3I& t : mesh.triangles) {
        sets.join(t[0], t[1]);
        sets.join(t[0], t[2]);
    }
    std::vector<int> component(mesh.points.size());
    count = 0;
    for (std::uint32_t v = 0; v < component.size(); ++v) {
        const std::uint32_t root = sets.root_of(v);
        component[v] = root == v ? count++ : component[root];
    }
    return component;
}

} // namespace

ComponentSides::ComponentSides(const TriangleMesh& mesh)
{
    int count = 0;
    component_ = component_of_vertices(mesh, count);
    sign_ = exact::volume_signs(mesh.points, mesh.triangles, component_, count);
}

bool ComponentSides::hold_turned(const Coarsened& left, std::vector<char>& fixed) const
{
    std::vector<int> component;
    component.reserve(left.from.size());
    for (const std::uint32_t v : left.from)
        component.push_back(component_[v]);
    const std::vector<int> signs = exact::volume_signs(left.mesh.points, left.mesh.triangles,
                                                       component, static_cast<int>(sign_.size()));
    if (signs == sign_)
        return false;
    for (std::size_t v = 0; v < component_.size(); ++v) {
        const auto c = std::size_t(component_[v]);
        fixed[v] = fixed[v] || signs[c] != sign_[c];
    }
    return true;
}

} // namespace vdb_shell
