// SPDX-License-Identifier: Apache-2.0

// Takes the three point grids of a file and the counts of its metadata; gives stack and tets, or
// ReadError that names grid, attribute and row. The file is not trusted: every index is held
// against its limit before it is used, memory is taken only for rows that have been counted, and
// what the file says twice has to agree. What passes fits together as make_tets leaves it
// (require_consistent has the last word); whether it is the shell that was written is for the
// checksum, which the caller compares.

#include "vdb_shell/core/error.h"

#include "write/point_grid_reader.h"
#include "write/point_grids.h"

#include <array>
#include <cmath>
#include <utility>

namespace vdb_shell
{
namespace
{

using openvdb::Vec3I;
using openvdb::Vec3s;
using Reader = PointGridReader;

/// The points by id, as the file has them. The redundant ones are kept until they have been
/// compared.
struct Rows {
    std::vector<Vec3s> rest, opposite;
    std::vector<std::uint32_t> vertex, layer, stop;
    std::vector<std::uint32_t> outer_stop; ///< empty unless there are layers on both sides
    std::vector<std::uint32_t> tet_point;  ///< index + 1 into TetMesh::points; 0: none
};

Rows read_rows(const Reader& reader, const ShellCounts& counts)
{
    Rows rows;
    reader.positions(position_attribute(counts.posed), rows.rest);
    reader.positions("opposite", rows.opposite);
    const auto read = [&](const char* name, std::size_t limit, std::vector<std::uint32_t>& into) {
        into.resize(std::size_t(counts.points));
        reader.indices(name, 1, limit, [&](std::size_t id, openvdb::Index, std::uint32_t value) {
            into[id] = value;
        });
    };
    read("source_vertex", std::size_t(counts.vertices), rows.vertex);
    read("layer", std::size_t(counts.layers) + 1, rows.layer);
    read("stop_reason", kStopReasonCount, rows.stop);
    // As the writer does: the column is there only where there are layers on both sides of the
    // skin.
    if (counts.skin > 0 && counts.skin < counts.layers)
        read(kOuterStop, kStopReasonCount, rows.outer_stop);
    // Shifted by one, so that -1 for "no tet uses it" becomes 0 and one test of range covers both.
    rows.tet_point.resize(std::size_t(counts.points));
    const auto limit = std::size_t(counts.tet_points) + 1;
    reader.for_each_row<std::int32_t>(
        "tet_point", 1, [&](std::size_t id, openvdb::Index, std::int32_t value) {
            rows.tet_point[id] = reader.in_range(std::int64_t(value) + 1, limit, "tet_point", id);
        });
    return rows;
}

/// Where the point of each surface and vertex stands in the rows; kNone where it has none of its
/// own.
using OwnRows = std::vector<std::vector<std::uint32_t>>;
constexpr std::uint32_t kNone = ~std::uint32_t(0);

/// Rows are in the order of surfaces, then of vertices, and the outermost surface has all vertices.
/// The order is demanded rather than accepted as it comes, because ids are part of the format:
/// `prism_pts` and `tet` name them, and number_points would give others.
OwnRows find_own_rows(const Reader& reader, const Rows& rows, const ShellCounts& counts)
{
    const auto vertices = std::size_t(counts.vertices);
    OwnRows own(std::size_t(counts.layers) + 1, std::vector<std::uint32_t>(vertices, kNone));
    std::pair<std::uint32_t, std::uint32_t> last{0, 0};
    for (std::uint32_t id = 0; id < rows.rest.size(); ++id) {
        const std::pair<std::uint32_t, std::uint32_t> here{rows.layer[id], rows.vertex[id]};
        const bool outermost = id < vertices;
        if ((outermost && (here.first != 0 || here.second != id)) ||
            (!outermost && (here.first == 0 || here <= last)))
            reader.fail("point " + std::to_string(id) + ": layer " + std::to_string(here.first) +
                        " of vertex " + std::to_string(here.second) +
                        " does not belong at this id");
        own[here.first][here.second] = id;
        last = here;
    }
    return own;
}

/// The next surface below `above`, whose points' rows are `own_above`.
std::vector<Vec3s> surface_below(const Reader& reader, const Rows& rows,
                                 const std::vector<Vec3s>& above,
                                 const std::vector<std::uint32_t>& own_above,
                                 const std::vector<std::uint32_t>& own)
{
    std::vector<Vec3s> surface = above;
    for (std::size_t v = 0; v < surface.size(); ++v) {
        if (own_above[v] != kNone)
            // The point above says where its pillar ends; if it has no row of its own either, the
            // pillar is pinned and the surface above already has the place.
            surface[v] = rows.opposite[own_above[v]];
        else if (own[v] != kNone)
            surface[v] = rows.rest[own[v]];
        if (own[v] != kNone && !same_bits(rows.rest[own[v]], surface[v]))
            reader.fail("point " + std::to_string(own[v]) +
                        ": \"rest\" is not \"opposite\" of the outer point " +
                        std::to_string(own_above[v]));
    }
    return surface;
}

std::vector<StopReason> reasons(const std::vector<std::uint32_t>& rows, std::size_t vertices)
{
    std::vector<StopReason> stop(vertices);
    for (std::size_t v = 0; v < vertices; ++v)
        stop[v] = StopReason(rows[v]);
    return stop;
}

/// All points of every pillar.
void read_pillars(const Reader& reader, const Rows& rows, const ShellCounts& counts,
                  ShellStack& stack)
{
    const auto vertices = std::size_t(counts.vertices);
    const OwnRows own = find_own_rows(reader, rows, counts);
    stack.skin = std::size_t(counts.skin);
    stack.tapered = counts.tapered;
    // find_own_rows has made sure that the first rows are the vertices of the outermost surface;
    // read_point_grids that there are as many.
    std::vector<Vec3s> above(rows.rest.begin(), rows.rest.begin() + counts.vertices);
    for (std::size_t k = 0; k < std::size_t(counts.layers); ++k) {
        PrismShell layer;
        layer.outer = above;
        layer.inner = surface_below(reader, rows, above, own[k], own[k + 1]);
        layer.stop = reasons(
            k < stack.skin && !rows.outer_stop.empty() ? rows.outer_stop : rows.stop, vertices);
        above = layer.inner;
        stack.layers.push_back(std::move(layer));
    }
}

/// The tets' own list of points. In a tapered shell several rows may name one of them: the first
/// has it, and the others lie in its place.
void read_tet_points(const Reader& reader, const Rows& rows, const ShellCounts& counts,
                     TetMesh& tets)
{
    const auto count = std::size_t(counts.tet_points);
    tets.points.resize(count);
    tets.source_vertex.resize(count);
    tets.layer.resize(count);
    std::size_t found = 0;
    std::vector<bool> seen(count, false);
    for (std::size_t id = 0; id < rows.rest.size(); ++id) {
        // A point that no tet has, as that of a vertex all of whose triangles are pinned.
        if (rows.tet_point[id] == 0)
            continue;
        const std::size_t point = rows.tet_point[id] - 1;
        if (seen[point] && counts.tapered && same_bits(tets.points[point], rows.rest[id]))
            continue;
        if (seen[point])
            reader.fail("attribute \"tet_point\": " + std::to_string(point) + " appears twice");
        seen[point] = true;
        tets.points[point] = rows.rest[id];
        tets.source_vertex[point] = rows.vertex[id];
        tets.layer[point] = std::uint8_t(rows.layer[id]);
        ++found;
    }
    if (found != count)
        reader.fail("attribute \"tet_point\" names " + std::to_string(found) +
                    " points, the metadata says " + std::to_string(count));
}

std::vector<std::array<std::uint32_t, 6>> read_prisms(const Reader& reader,
                                                      const ShellCounts& counts, ShellStack& stack)
{
    const auto prisms = std::size_t(counts.prisms), layers = std::size_t(counts.layers);
    // Before the division, which would round a wrong number to a plausible one.
    if (prisms % layers != 0)
        reader.fail("the metadata says " + std::to_string(prisms) + " prisms in " +
                    std::to_string(layers) + " layers");
    std::vector<std::array<std::uint32_t, 6>> corners(prisms);
    reader.indices(
        "prism_pts", 6, std::size_t(counts.points),
        [&](std::size_t id, openvdb::Index i, std::uint32_t value) { corners[id][i] = value; });
    // Prisms are numbered layer by layer, so quotient and remainder are the layer and the triangle.
    const std::size_t faces = prisms / layers;
    stack.splits.resize(layers);
    for (PrismSplit& split : stack.splits)
        split.order.resize(faces);
    reader.indices("split_order", 3, 3, [&](std::size_t id, openvdb::Index i, std::uint32_t value) {
        stack.splits[id / faces].order[id % faces][i] = std::uint8_t(value);
    });
    // The outermost prisms have the triangles: there ids of points are numbers of vertices.
    std::vector<Vec3I> triangles(faces);
    for (std::size_t p = 0; p < faces; ++p)
        for (int corner = 0; corner < 3; ++corner)
            triangles[p][corner] = corners[p][std::size_t(corner)];
    for (PrismShell& layer : stack.layers)
        layer.triangles = triangles;
    return corners;
}

/// The corners of each prism must be those of its triangle, on the surfaces of its layer.
void require_pillars(const Reader& reader, const ShellStack& stack,
                     const std::vector<std::array<std::uint32_t, 6>>& corners)
{
    // Numbered afresh by the function that the writer used, without tets, as only the points are
    // compared.
    const ShellPoints expected = number_points(stack, {});
    const std::vector<Vec3I>& triangles = stack.triangles();
    for (std::size_t p = 0; p < corners.size(); ++p)
        for (std::size_t corner = 0; corner < 3; ++corner) {
            const std::uint32_t above = corners[p][corner], below = corners[p][corner + 3];
            const std::uint32_t v = triangles[p % triangles.size()][int(corner)];
            const std::size_t k = p / triangles.size();
            if (v >= stack.surface(0).size() || above != expected.id[k][v] ||
                below != expected.id[k + 1][v])
                reader.fail("attribute \"prism_pts\" of " + std::to_string(p) + ": point " +
                            std::to_string(below) + " is not below point " + std::to_string(above));
        }
}

void read_tets(const Reader& reader, const Rows& rows, const ShellCounts& counts, TetMesh& tets)
{
    tets.tets.resize(std::size_t(counts.tets));
    tets.prism.resize(std::size_t(counts.tets));
    tets.prism_layer.resize(std::size_t(counts.tets));
    reader.indices("tet", 4, std::size_t(counts.points),
                   [&](std::size_t id, openvdb::Index i, std::uint32_t value) {
                       if (rows.tet_point[value] == 0)
                           reader.fail("attribute \"tet\" of " + std::to_string(id) + ": point " +
                                       std::to_string(value) + " has no \"tet_point\"");
                       tets.tets[id][int(i)] = rows.tet_point[value] - 1;
                   });
    reader.indices("prism", 1, std::size_t(counts.prisms),
                   [&](std::size_t id, auto, std::uint32_t value) {
                       const auto faces = std::uint32_t(counts.prisms / counts.layers);
                       tets.prism[id] = value % faces;
                       // Below 256, for the metadata allow no more layers
                       // (ShellStack::kMostLayers).
                       tets.prism_layer[id] = std::uint8_t(value / faces);
                   });
}

bool has_attribute(const openvdb::points::PointDataGrid& grid, const std::string& name)
{
    const auto leaf = grid.tree().cbeginLeaf();
    return leaf && leaf->attributeSet().find(name) != openvdb::points::AttributeSet::INVALID_POS;
}

} // namespace

RestPoints read_rest_points(const PointGrids& grids, const CoreGrids& core,
                            const ShellCounts& counts, const ShellStack& stack,
                            const std::string& name)
{
    RestPoints rest;
    std::vector<Vec3s> by_id;
    Reader(*grids.points, counts.points, name).positions("rest", by_id);
    const ShellPoints points = number_points(stack, {});
    rest.surface = vectors_by_surface(points, by_id);
    if (core.points)
        Reader(*core.points, counts.core_points, name).positions("rest", rest.core);
    if (!has_attribute(*grids.points, "v"))
        return rest;
    Reader(*grids.points, counts.points, name).positions("v", by_id);
    rest.velocity.surface = vectors_by_surface(points, by_id);
    if (core.points)
        Reader(*core.points, counts.core_points, name).positions("v", rest.velocity.core);
    return rest;
}

void read_point_grids(const PointGrids& grids, const ShellCounts& counts, const std::string& name,
                      ShellStack& stack, TetMesh& tets)
{
    // All three constructors count their rows first. Only then do the metadata's numbers decide on
    // any allocation.
    const Reader points(*grids.points, counts.points, name);
    const Reader prisms(*grids.prisms, counts.prisms, name);
    const Reader tet_rows(*grids.tets, counts.tets, name);
    if (counts.tet_points > counts.points)
        points.fail("the metadata says " + std::to_string(counts.tet_points) +
                    " points of tets but only " + std::to_string(counts.points) + " points");
    if (counts.vertices > counts.points)
        points.fail("the metadata says " + std::to_string(counts.vertices) + " vertices but only " +
                    std::to_string(counts.points) + " points");
    const Rows rows = read_rows(points, counts);
    read_pillars(points, rows, counts, stack);
    read_tet_points(points, rows, counts, tets);
    const auto corners = read_prisms(prisms, counts, stack);
    require_pillars(prisms, stack, corners);
    read_tets(tet_rows, rows, counts, tets);
    try {
        require_consistent(stack, tets);
        // To the writer an inconsistent shell is a wrong argument, here it is a damaged file.
    } catch (const InvalidOption& error) {
        throw ReadError(name + ": the point grids do not fit together: " + error.what());
    }
}

} // namespace vdb_shell
