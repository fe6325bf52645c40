// SPDX-License-Identifier: Apache-2.0

// Tets that fill a shell, behind the shell's own points and primitives, and back.

#include "filled_core.h"

#include "vdb_shell/io/read_file.h"
#include "vdb_shell/shell/quality.h"

#include "shell_columns.h"
#include "shell_names.h"

#include <cstdint>
#include <vector>

namespace vdb_shell::houdini
{
namespace
{

/// Of each tet its mean ratio.
std::vector<float> qualities(const TetMesh& all, std::size_t first)
{
    std::vector<float> quality;
    for (std::size_t t = first; t < all.tets.size(); ++t)
        quality.push_back(static_cast<float>(shape_of(all, t).mean_ratio));
    return quality;
}

} // namespace

void append_core(const ShellFile& file, const ShellPoints& points, HoudiniGeometry& geometry)
{
    const CoreTets& core = file.core;
    const std::size_t count = core.points.size(), tets = core.tets.size();
    const std::vector<float> position = as_floats(core.points);
    append_values(geometry.point_attributes, count,
                  {{"P", position},
                   {kRest, file.rest.posed() ? as_floats(file.rest.core) : position},
                   // It is the end of no pillar, so its other end is where it is.
                   {kOpposite, position},
                   {kVelocity, as_floats(file.rest.velocity.core)},
                   {"depth", std::vector<float>(count, 1.0f)},
                   {kSourceVertex, signed_numbers(core.source_vertex)}});
    append_group(geometry.point_groups, geometry.points, count, kCorePoints);
    append_values(geometry.primitive_attributes, tets,
                  {{"quality", qualities(joined_tets(file.tets, core), file.tets.tets.size())}});
    append_group(geometry.primitive_groups, geometry.primitives.size(), tets, kCoreTets);
    const std::size_t shared = file.tets.points.size();
    for (const openvdb::Vec4I& tet : core.tets) {
        // Houdini counts the corners of a tetrahedron with the other orientation.
        for (const int corner : {0, 1, 3, 2}) {
            const std::uint32_t p = tet[corner];
            geometry.vertex_point.push_back(
                p < shared ? points.id_of_tet_point[p]
                           : static_cast<std::uint32_t>(geometry.points + (p - shared)));
        }
        geometry.primitives.push_back({PrimitiveType::tetrahedron, 4});
    }
    geometry.points += count;
}

void read_core(const HoudiniGeometry& geometry, const AddedSize& size, const std::string& name,
               ShellFile& file)
{
    const Columns points(geometry.point_attributes, "point attribute", name);
    const std::size_t first = geometry.points - size.points;
    const std::size_t shared = file.tets.points.size();
    CoreTets& core = file.core;
    core.points = last_of(points.vectors("P"), size.points);
    const auto vertices = static_cast<std::int64_t>(file.stack.surface(0).size());
    for (const std::int32_t v : last_of(points.integers(kSourceVertex), size.points)) {
        if (v < -1 || v >= vertices)
            points.fail(kSourceVertex, "of a point of the core is " + std::to_string(v) + " of " +
                                           std::to_string(vertices));
        core.source_vertex.push_back(v < 0 ? CoreTets::kNoVertex : static_cast<std::uint32_t>(v));
    }
    const ShellPoints shell = number_points(file.stack, file.tets);
    const std::vector<std::uint32_t> corners = last_of(geometry.vertex_point, 4 * size.tets);
    const auto number = [&](std::size_t k) {
        const std::uint32_t p = corners[k];
        if (p < first && shell.tet_point[p] == ShellPoints::kUnused)
            refuse(name, "tet " + std::to_string(k / 4) + " of the core: point " +
                             std::to_string(p) + " is of no tet of the shell");
        return p < first ? static_cast<std::uint32_t>(shell.tet_point[p])
                         : static_cast<std::uint32_t>(shared + (p - first));
    };
    for (std::size_t k = 0; k < corners.size(); k += 4)
        core.tets.emplace_back(number(k), number(k + 1), number(k + 3), number(k + 2));
    if (file.rest.posed())
        file.rest.core = last_of(points.vectors(kRest), size.points);
    if (!file.rest.velocity.empty())
        file.rest.velocity.core = last_of(points.vectors(kVelocity), size.points);
}

} // namespace vdb_shell::houdini
