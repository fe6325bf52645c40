// SPDX-License-Identifier: Apache-2.0

// Takes files of a surface in a pose, gives its points in the order of the shell's vertices. That
// the triangles are the same, one for one, proves that the points are; so do polygons that fill the
// same outlines, for a polygon that is not convex in every pose is not cut alike in all of them.
// Where neither holds, ids say which point is which, whatever their order.

#include "command/posed_surface.h"

#include "vdb_shell/core/error.h"
#include "vdb_shell/pose/bind_surface.h"

#include <algorithm>
#include <iterator>
#include <numeric>
#include <string>
#include <utility>

namespace vdb_shell::command
{
namespace
{

using openvdb::Vec3s;

/// The mesh in the frame of the shell's.
ReadResult read_placed(const std::filesystem::path& path, InputFormat format,
                       const Placement& placement, bool weld)
{
    ReadOptions options;
    options.weld = weld;
    // Where the shell keeps digits of its own, so must the pose.
    options.recentre = placement.moves();
    ReadResult read = read_surface(path, options, format);
    bring_into(placement, read.report.placement, read.mesh.points);
    return read;
}

/// What a mesh has to have, and whose it is.
struct Wanted {
    std::size_t vertices;
    const std::vector<openvdb::Vec3I>& triangles;
    std::vector<std::int64_t> ids; ///< by vertex
    std::string whose;
};

[[noreturn]] void refuse(const PosedSurface& posed, const TriangleMesh& mesh, const Wanted& wanted)
{
    throw GeometryError(posed.mesh.string() + ": it has " + std::to_string(mesh.points.size()) +
                        " vertices and " + std::to_string(mesh.triangles.size()) +
                        " triangles that are not those of " + wanted.whose + ", which has " +
                        std::to_string(wanted.vertices) + " and " +
                        std::to_string(wanted.triangles.size()) +
                        ", and its points have no ids; --rest-mesh gives the same surface at rest "
                        "where the shell's was repaired, wrapped, remeshed or retriangulated");
}

using DirectedEdge = std::pair<std::uint32_t, std::uint32_t>;

/// Sides of triangles [begin, end) that no other of them has the other way round, sorted.
std::vector<DirectedEdge> outline_of(const std::vector<openvdb::Vec3I>& triangles,
                                     std::size_t begin, std::size_t end)
{
    std::vector<DirectedEdge> sides, outline;
    for (std::size_t t = begin; t < end; ++t)
        for (int k = 0; k < 3; ++k)
            sides.emplace_back(triangles[t][k], triangles[t][(k + 1) % 3]);
    std::sort(sides.begin(), sides.end());
    std::copy_if(sides.begin(), sides.end(), std::back_inserter(outline),
                 [&](const DirectedEdge& side) {
                     return !std::binary_search(sides.begin(), sides.end(),
                                                DirectedEdge{side.second, side.first});
                 });
    return outline;
}

/// Whether each of the file's polygons has the outline of the wanted triangles in its place.
bool same_polygons(const ReadResult& read, const std::vector<openvdb::Vec3I>& wanted)
{
    const std::vector<openvdb::Vec3I>& triangles = read.mesh.triangles;
    const std::vector<std::uint32_t>& first = read.first_triangles;
    for (std::size_t face = 0; face < first.size(); ++face) {
        const std::size_t begin = first[face];
        const std::size_t end = face + 1 < first.size() ? first[face + 1] : triangles.size();
        if (!std::equal(&triangles[begin], &triangles[begin] + (end - begin), &wanted[begin]) &&
            outline_of(triangles, begin, end) != outline_of(wanted, begin, end))
            return false;
    }
    return !first.empty();
}

/// Equal vertices of the file are merged or not, whichever gives the triangles that are wanted: in
/// a pose other vertices can be equal than at rest. Standard input can be read only once.
std::vector<Vec3s> read_points(const PosedSurface& posed, const Placement& placement,
                               const Wanted& wanted)
{
    const auto fits = [&](const ReadResult& read) {
        const std::vector<openvdb::Vec3I>& triangles = read.mesh.triangles;
        return read.mesh.points.size() == wanted.vertices &&
               triangles.size() == wanted.triangles.size() &&
               (triangles == wanted.triangles || same_polygons(read, wanted.triangles));
    };
    ReadResult read = read_placed(posed.mesh, posed.format, placement, true);
    if (fits(read))
        return std::move(read.mesh.points);
    // Only standard input has another format, and it is at its end.
    if (posed.format == InputFormat::by_extension) {
        read = read_placed(posed.mesh, posed.format, placement, false);
        if (fits(read))
            return std::move(read.mesh.points);
    }
    // Ids are points' own names, which exporters keep when they write points in another order from
    // frame to frame.
    if (read.ids.empty() || wanted.ids.empty())
        refuse(posed, read.mesh, wanted);
    return in_order_of_ids(read.mesh.points, read.ids, wanted.ids, posed.mesh.string());
}

} // namespace

std::vector<Vec3s> read_posed_skin(const PosedSurface& posed, const ShellStack& at_rest,
                                   const Placement& placement, const std::filesystem::path& shell)
{
    const std::vector<Vec3s>& skin = at_rest.surface(at_rest.skin);
    if (posed.rest_mesh.empty()) {
        // A shell's vertices have the numbers of its mesh's points.
        std::vector<std::int64_t> numbers(skin.size());
        std::iota(numbers.begin(), numbers.end(), 0);
        return read_points(posed, placement,
                           {skin.size(), at_rest.triangles(), std::move(numbers),
                            "the surface of " + shell.string()});
    }
    // Welded, as the shell's surface was; the pose has to follow, whichever of its vertices are
    // equal.
    ReadResult rest = read_placed(posed.rest_mesh, InputFormat::by_extension, placement, true);
    TriangleMesh moved = rest.mesh;
    moved.points = read_points(posed, placement,
                               {rest.mesh.points.size(), rest.mesh.triangles, std::move(rest.ids),
                                posed.rest_mesh.string()});
    // The tie is made at rest, where the two surfaces lie on each other, and kept in the pose.
    return move_bound(bind_surface(skin, rest.mesh), moved);
}

} // namespace vdb_shell::command
