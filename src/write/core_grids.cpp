// SPDX-License-Identifier: Apache-2.0

// The tets that fill a shell, to two grids of points and back, bit for bit. As in point_grids.cpp
// every point carries its id, since OpenVDB decides the order, and its exact position in `rest`. A
// corner is told by the id of a point of the shell, as tets of the shell tell theirs, so that a
// reader needs one list of points: the shell's, and the core's behind it.

#include "write/core_grids.h"

#include "write/point_grid_builder.h"
#include "write/point_grid_reader.h"

namespace vdb_shell
{
namespace
{

using openvdb::Vec3d;
using openvdb::Vec3s;

/// Where a tet is drawn. Nothing is read back from it.
Vec3s centre_of(const TetMesh& all, const openvdb::Vec4I& tet)
{
    Vec3d sum(0.0);
    for (int corner = 0; corner < 4; ++corner)
        sum += Vec3d(all.points[tet[corner]]);
    return Vec3s(sum / 4.0);
}

} // namespace

CoreGrids make_core_grids(const ShellPoints& points, const TetMesh& tets, const CoreTets& core,
                          const RestPoints& rest)
{
    CoreGrids grids;
    PointGridBuilder own(kCorePointsGrid, core.points);
    own.add<std::int32_t>("id", [](std::size_t i) { return i; });
    // Houdini and its users take `rest` for places at rest. A posed shell has those under that
    // name, and its exact positions under another.
    own.add(position_attribute(rest.posed()), core.points);
    if (rest.posed())
        own.add("rest", rest.core);
    if (!rest.velocity.empty())
        own.add("v", rest.velocity.core);
    own.add<std::int32_t>("source_vertex", [&](std::size_t i) {
        const std::uint32_t v = core.source_vertex[i];
        return v == CoreTets::kNoVertex ? -1 : std::int32_t(v);
    });
    grids.points = own.take();

    const TetMesh all = joined_tets(tets, core);
    std::vector<Vec3s> centres;
    for (const openvdb::Vec4I& tet : core.tets)
        centres.push_back(centre_of(all, tet));
    PointGridBuilder filling(kCoreTetsGrid, centres);
    filling.add<std::int32_t>("id", [](std::size_t t) { return t; });
    filling.add_tuples("tet", 4, [&](std::size_t k) {
        // Three numberings meet here: that of the joined tets, that of the shell's points by id,
        // and that of the core's own points, which goes on behind the shell's.
        const std::uint32_t point = core.tets[k / 4][int(k % 4)];
        return point < tets.points.size() ? points.id_of_tet_point[point]
                                          : points.position.size() + (point - tets.points.size());
    });
    grids.tets = filling.take();
    return grids;
}

CoreTets read_core_grids(const CoreGrids& grids, const ShellCounts& counts,
                         const ShellPoints& shell, const std::string& name)
{
    const PointGridReader points(*grids.points, counts.core_points, name);
    const PointGridReader tets(*grids.tets, counts.core_tets, name);
    CoreTets core;
    points.positions(position_attribute(counts.posed), core.points);
    core.source_vertex.resize(core.points.size());
    // Shifted by one, so that -1 for "of the inside" becomes 0 and one test of range covers both.
    points.for_each_row<std::int32_t>(
        "source_vertex", 1, [&](std::size_t id, openvdb::Index, std::int32_t value) {
            core.source_vertex[id] =
                points.in_range(std::int64_t(value) + 1, std::size_t(counts.vertices) + 1,
                                "source_vertex", id) -
                1;
        });
    const std::size_t shell_points = shell.position.size();
    core.tets.resize(std::size_t(counts.core_tets));
    tets.indices("tet", 4, shell_points + core.points.size(),
                 [&](std::size_t id, openvdb::Index k, std::uint32_t value) {
                     // A point of the shell that no tet of it has is no point of the joined mesh;
                     // the core has a point of its own there.
                     if (value < shell_points && shell.tet_point[value] == ShellPoints::kUnused)
                         tets.fail("attribute \"tet\" of " + std::to_string(id) + ": point " +
                                   std::to_string(value) + " has no \"tet_point\"");
                     core.tets[id][int(k)] = value < shell_points
                                                 ? std::uint32_t(shell.tet_point[value])
                                                 : std::uint32_t(counts.tet_points) +
                                                       std::uint32_t(value - shell_points);
                 });
    return core;
}

} // namespace vdb_shell
