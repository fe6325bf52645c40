// SPDX-License-Identifier: Apache-2.0

// Reads the pillars of a shell from the points of a Houdini geometry: surface by surface from the
// outermost inwards, the places of all vertices and why their pillars end. What it leaves true:
// each vertex has one place on each surface, equal to that of the surface above exactly where its
// pillar has no length, and each point of the file is used once. Floats are taken bit for bit, as
// the checksum tells zeros of either sign apart.

#include "shell_columns.h"

#include <algorithm>
#include <cstring>
#include <map>
#include <utility>

namespace vdb_shell::houdini
{
namespace
{

using openvdb::Vec3s;

std::vector<StopReason> read_stops(const Columns& points, const char* attribute,
                                   std::size_t vertices)
{
    // Reasons are told by name in these files, so their numbers may change between versions.
    std::map<std::string, StopReason> by_name;
    for (int i = 0; i < kStopReasonCount; ++i)
        by_name.emplace(name_of(static_cast<StopReason>(i)), static_cast<StopReason>(i));
    const auto& strings = points.get<Strings>(attribute, 1);
    std::vector<StopReason> stops;
    for (std::size_t v = 0; v < vertices; ++v) {
        const auto found = by_name.find(strings.at(v));
        if (found == by_name.end())
            points.fail(attribute, "of point " + std::to_string(v) + " is " +
                                       vdb_shell::quoted(strings.at(v)) +
                                       ", which is no stop reason");
        stops.push_back(found->second);
    }
    return stops;
}

/// Stands for a point that a surface does not have of its own, because the pillar above it is
/// pinned.
constexpr std::uint32_t kNone = ~std::uint32_t(0);

/// The surface of each point. Files of one layer below the surface do not say it, and need not: the
/// first points are the vertices of the surface, all others are lower ends.
std::vector<std::size_t> read_surfaces(const HoudiniGeometry& geometry, const Columns& points,
                                       const Counts& counts)
{
    std::vector<std::size_t> surfaces(geometry.points, 1);
    std::fill_n(surfaces.begin(), counts.vertices, std::size_t(0));
    if (!counts.layered())
        return surfaces;
    const auto& stated = points.integers(kSurface);
    for (std::size_t i = 0; i < surfaces.size(); ++i) {
        const bool outermost = i < counts.vertices;
        const auto least = outermost ? 0 : 1;
        const auto most = outermost ? 0 : static_cast<std::int64_t>(counts.layers);
        if (stated[i] < least || stated[i] > most)
            points.fail(kSurface, "of point " + std::to_string(i) + " is " +
                                      std::to_string(stated[i]) + ", expected " +
                                      std::to_string(least) + " to " + std::to_string(most));
        surfaces[i] = static_cast<std::size_t>(stated[i]);
    }
    return surfaces;
}

/// By surface and vertex, the point that says it is there. A second one for the same place is
/// refused: one of them would never be looked at.
Ids find_own_points(const Columns& points, const std::vector<std::size_t>& surfaces,
                    const Counts& counts)
{
    const auto& source = points.integers(kSourceVertex);
    Ids own(counts.layers + 1, std::vector<std::uint32_t>(counts.vertices, kNone));
    for (std::size_t i = 0; i < surfaces.size(); ++i) {
        const auto vertex = static_cast<std::size_t>(source[i]);
        if (source[i] < 0 || vertex >= counts.vertices || (i < counts.vertices && vertex != i))
            points.fail(kSourceVertex, "of point " + std::to_string(i) + " is " +
                                           std::to_string(source[i]) + " of " +
                                           std::to_string(counts.vertices));
        std::uint32_t& place = own[surfaces[i]][vertex];
        if (place != kNone)
            points.fail(kSourceVertex, "of point " + std::to_string(i) + " is " +
                                           std::to_string(vertex) + ", as of point " +
                                           std::to_string(place) + " on the same surface");
        place = static_cast<std::uint32_t>(i);
    }
    return own;
}

/// Not equality of values: the checksum of a shell tells zeros of either sign apart.
bool same_bits(const Vec3s& a, const Vec3s& b)
{
    // NOLINTNEXTLINE(bugprone-suspicious-memory-comparison)
    return std::memcmp(a.asPointer(), b.asPointer(), 3 * sizeof(float)) == 0;
}

/// The next surface below `above`. A point above names the lower end of its pillar in `opposite`;
/// where there is none, the surface's own point says where it is, or the vertex stays where it was.
std::vector<Vec3s> surface_below(const Columns& points, const std::vector<Vec3s>& position,
                                 const std::vector<Vec3s>& opposite,
                                 const std::vector<Vec3s>& above,
                                 const std::vector<std::uint32_t>& own_above,
                                 const std::vector<std::uint32_t>& own)
{
    std::vector<Vec3s> surface = above;
    for (std::size_t v = 0; v < surface.size(); ++v) {
        if (own_above[v] != kNone)
            surface[v] = opposite[own_above[v]];
        else if (own[v] != kNone)
            surface[v] = position[own[v]];
        // Equal as numbers, as PrismShell has it: a pillar between zeros of different sign has no
        // length.
        const bool pinned = surface[v] == above[v];
        if (own[v] != kNone && (pinned || !same_bits(position[own[v]], surface[v])))
            points.fail("P", "of point " + std::to_string(own[v]) +
                                 " is not the one lower end of the pillar at vertex " +
                                 std::to_string(v));
        if (own[v] == kNone && !pinned)
            points.fail(kSourceVertex,
                        "names no lower end of the pillar at vertex " + std::to_string(v));
    }
    return surface;
}

} // namespace

Ids read_pillars(const HoudiniGeometry& geometry, const Columns& points, const Counts& counts,
                 ShellStack& stack)
{
    const std::vector<Vec3s> position = points.vectors("P"), opposite = points.vectors(kOpposite);
    Ids ids = find_own_points(points, read_surfaces(geometry, points, counts), counts);
    const auto stops = read_stops(points, kStopReason, counts.vertices);
    const bool both = counts.skin > 0 && counts.skin < counts.layers;
    const auto outer_stops = both ? read_stops(points, kOuterStop, counts.vertices) : stops;
    stack.skin = counts.skin;
    std::vector<Vec3s> above(position.begin(),
                             position.begin() + static_cast<std::ptrdiff_t>(counts.vertices));
    for (std::size_t k = 0; k < counts.layers; ++k) {
        PrismShell layer;
        layer.inner = surface_below(points, position, opposite, above, ids[k], ids[k + 1]);
        layer.outer = std::move(above);
        layer.stop = k < counts.skin ? outer_stops : stops;
        above = layer.inner;
        stack.layers.push_back(std::move(layer));
    }
    // Afterwards every place has a point: pinned ones that of the surface above, from the outermost
    // downwards so that chains of them are followed to their top.
    for (std::size_t k = 1; k <= counts.layers; ++k)
        for (std::size_t v = 0; v < counts.vertices; ++v)
            if (ids[k][v] == kNone)
                ids[k][v] = ids[k - 1][v];
    return ids;
}

} // namespace vdb_shell::houdini
