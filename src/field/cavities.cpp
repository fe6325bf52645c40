// SPDX-License-Identifier: Apache-2.0
// Sets of nested surfaces, for OpenVDB's mesh-to-volume, which takes everything inside the
// outermost surface for solid. The surfaces are split by their nesting depth, each depth becomes a
// level set of its own, and these are put together: odd depths are taken out as cavities, even ones
// added. For surfaces that do not touch, the maximum and the minimum of distances used for this are
// the exact distances to all surfaces together, because every segment from one side of a surface to
// the other crosses it.

#include "field/cavities.h"

#include "core/box_pairs.h"
#include "core/parallel.h"
#include "mesh/components.h"
#include "mesh/surface_defects.h"

#include <openvdb/tools/Prune.h>
#include <openvdb/tree/LeafManager.h>

#include <algorithm>
#include <utility>

namespace vdb_shell
{
namespace
{

/// out = combine(out, other) over the union of both active sets; what ends at or beyond the
/// exterior band is background again.
template <typename Combine>
void combine_into(openvdb::FloatGrid& out, const openvdb::FloatGrid& other, const Combine& combine)
{
    // After this every voxel that is active in one of the two grids exists in `out`. Voxels that
    // neither has active are not visited, so the caller has to make the bands meet wherever a sign
    // must change.
    out.tree().topologyUnion(other.tree());
    const float background = out.background();
    openvdb::tree::LeafManager<openvdb::FloatTree> leaves(out.tree());
    leaves.foreach ([&](openvdb::FloatTree::LeafNodeType& leaf, std::size_t) {
        const auto values = other.getConstAccessor();
        for (auto value = leaf.beginValueOn(); value; ++value) {
            const float combined = combine(*value, values.getValue(value.getCoord()));
            // Each leaf reads the other grid and writes its own voxels only, so the order of the
            // leaves and the number of threads do not matter.
            value.setValue(std::min(combined, background));
            if (combined >= background)
                value.setValueOff();
        }
    });
    openvdb::tools::pruneLevelSet(out.tree());
}

/// Marks triangles that are no triangles, and those beyond the boxes of all other components: they
/// cannot cross another one, and most triangles of most surfaces are such.
std::vector<char> cannot_cross_another(const TriangleMesh& mesh,
                                       const std::vector<std::uint32_t>& component_of)
{
    const std::vector<FloatBox> boxes = triangle_boxes(mesh.points, mesh.triangles);
    std::vector<FloatBox> box_of;
    for (std::size_t t = 0; t < boxes.size(); ++t)
        // Components are numbered by their first triangle.
        if (component_of[t] == box_of.size())
            box_of.push_back(boxes[t]);
        else
            box_of[component_of[t]].add(boxes[t]);
    BoxTree tree;
    tree.build(box_of);
    std::vector<char> left_out = find_degenerate(mesh.points, mesh.triangles);
    for_each_index(boxes.size(), [&](std::size_t t) {
        bool near = false;
        tree.for_each_overlap(boxes[t],
                              [&](int c) { near |= std::uint32_t(c) != component_of[t]; });
        left_out[t] |= !near;
    });
    return left_out;
}

} // namespace

std::vector<TriangleMesh> split_by_nesting(const TriangleMesh& mesh, Interrupter* interrupter)
{
    const EdgeUses uses = sorted_edge_uses(mesh.triangles);
    const std::vector<std::uint32_t> component_of =
        component_of_triangles(uses, mesh.triangles.size());
    if (std::all_of(component_of.begin(), component_of.end(), [](auto c) { return c == 0; }))
        return {mesh};
    // Of bodies that cross no single point tells which is in which.
    const std::vector<TrianglePair> contacts =
        find_self_intersections(mesh, cannot_cross_another(mesh, component_of), interrupter);
    const std::vector<Component> components =
        describe_components(mesh, uses, component_of, crossing_components(contacts, component_of));
    std::vector<TriangleMesh> parts;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        // Components of one depth do not enclose each other, so they can share a level set. The
        // points are the same for all parts; those that a part does not use do no harm.
        const auto depth = static_cast<std::size_t>(components[component_of[t]].nesting_depth);
        if (parts.size() <= depth)
            parts.resize(depth + 1, {mesh.points, {}});
        parts[depth].triangles.push_back(mesh.triangles[t]);
    }
    // Two bodies of one place are each within the other, and none is outermost.
    const auto outermost = std::find_if(parts.begin(), parts.end(), [](const TriangleMesh& part) {
        return !part.triangles.empty();
    });
    parts.erase(parts.begin(), outermost);
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
