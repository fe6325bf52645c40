// SPDX-License-Identifier: Apache-2.0
#include "field/cavities.h"

#include "mesh/components.h"

#include <openvdb/tools/Prune.h>
#include <openvdb/tree/LeafManager.h>

#include <algorithm>

namespace vdb_shell
{
namespace
{

/// out = combine(out, other) over the union of both active sets; what ends at or beyond the
/// exterior band is background again.
template <typename Combine>
void combine_into(openvdb::FloatGrid& out, const openvdb::FloatGrid& other, const Combine& combine)
{
    out.tree().topologyUnion(other.tree());
    const float background = out.background();
    openvdb::tree::LeafManager<openvdb::FloatTree> leaves(out.tree());
    leaves.foreach ([&](openvdb::FloatTree::LeafNodeType& leaf, std::size_t) {
        const auto values = other.getConstAccessor();
        for (auto value = leaf.beginValueOn(); value; ++value) {
            const float combined = combine(*value, values.getValue(value.getCoord()));
            value.setValue(std::min(combined, background));
            if (combined >= background)
                value.setValueOff();
        }
    });
    openvdb::tools::pruneLevelSet(out.tree());
}

} // namespace

std::vector<TriangleMesh> split_by_nesting(const TriangleMesh& mesh)
{
    const std::vector<EdgeUse> uses = sorted_edge_uses(mesh.triangles);
    const std::vector<std::uint32_t> component_of =
        component_of_triangles(uses, mesh.triangles.size());
    if (std::all_of(component_of.begin(), component_of.end(), [](auto c) { return c == 0; }))
        return {mesh};
    const std::vector<Component> components = describe_components(mesh, uses, component_of, {});
    std::vector<TriangleMesh> parts;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const auto depth = static_cast<std::size_t>(components[component_of[t]].nesting_depth);
        if (parts.size() <= depth)
            parts.resize(depth + 1, {mesh.points, {}});
        parts[depth].triangles.push_back(mesh.triangles[t]);
    }
    return parts;
}

void subtract_cavity(openvdb::FloatGrid& solid, const openvdb::FloatGrid& cavity)
{
    combine_into(solid, cavity, [](float a, float b) { return std::max(a, -b); });
}

void add_solid(openvdb::FloatGrid& solid, const openvdb::FloatGrid& added)
{
    combine_into(solid, added, [](float a, float b) { return std::min(a, b); });
}

} // namespace vdb_shell
