// SPDX-License-Identifier: Apache-2.0

// Takes triangles without area, or lower than the user's sliver height, and removes them without
// opening the surface. The corner of a flat triangle that is between the other two lies on its
// longest side, so the neighbour there can be cut in two at that point and covers what both covered
// before; a needle with a short side is collapsed instead. Only where there is no single neighbour
// to cut is a triangle just dropped; the later steps close what that opens. Flat is decided exactly
// on the float32 points, heights in doubles. The trap is that a half may be flat or too low in its
// turn, so the work is bounded and what is left then is found by the check of the result. Triangles
// go by ascending index, so the result is determined.

#include "repair/working_surface.h"

#include "core/exact.h"
#include "core/parallel.h"
#include "mesh/surface_defects.h"
#include "mesh/triangle_height.h"

#include <algorithm>
#include <map>
#include <set>

namespace vdb_shell::repair
{
namespace
{

using openvdb::Vec3d;
using openvdb::Vec3I;

bool is_flat(const TriangleMesh& mesh, const Vec3I& t)
{
    return exact::collinear(mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]]);
}

struct Use {
    std::uint32_t triangle;
    int side;
};

bool has_repeated_corner(const Vec3I& t)
{
    return t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
}

/// The shortest side's ends, if that side is shorter than `length`.
bool find_short_side(const TriangleMesh& mesh, const Vec3I& t, double length, Edge& ends)
{
    double shortest = length;
    bool found = false;
    for (int k = 0; k < 3; ++k) {
        const std::uint32_t a = t[k], b = t[(k + 1) % 3];
        const double side = (Vec3d(mesh.points[a]) - Vec3d(mesh.points[b])).length();
        if (side < shortest) {
            shortest = side;
            // Smaller point first: it is the one that a collapse keeps, whichever way the side
            // runs.
            ends = {std::min(a, b), std::max(a, b)};
            found = true;
        }
    }
    return found;
}

/// Removes bad triangles one by one in the order of their indices. A triangle that goes is only
/// marked, and leaves the list at the end; a removal looks only at the triangles around its own
/// points. A pass over the whole mesh for each removal would be quadratic, since a mesh may have as
/// many bad triangles as it has triangles.
class Remover
{
public:
    Remover(WorkingSurface& surface, double sliver_height, RepairReport& report)
        : surface_(surface), mesh_(surface.mesh), sliver_height_(sliver_height), report_(report),
          dropped_(surface.mesh.triangles.size()), around_(surface.mesh.points.size())
    {
        std::vector<char> bad(dropped_.size());
        for_each_index(bad.size(), [&](std::size_t t) { bad[t] = is_bad(mesh_.triangles[t]); });
        for (std::uint32_t t = 0; t < bad.size(); ++t) {
            if (bad[t])
                // Indices ascend here, so each insertion at the end takes constant time.
                bad_.insert(bad_.end(), t);
            const Vec3I& corner = mesh_.triangles[t];
            for (int k = 0; k < 3; ++k)
                if ((k < 1 || corner[k] != corner[0]) && (k < 2 || corner[k] != corner[1]))
                    around_[corner[k]].push_back(t);
        }
    }

    void run()
    {
        // A removal may make the neighbour bad in turn. Rows of slivers could so cut each other for
        // ever, which this bound ends.
        const std::size_t most = 4 * dropped_.size();
        for (std::size_t removed = 0; removed < most && !bad_.empty(); ++removed)
            remove(*bad_.begin());
        drop_triangles(surface_, dropped_);
    }

private:
    bool is_bad(const Vec3I& t) const
    {
        return is_flat(mesh_, t) ||
               (sliver_height_ > 0 &&
                height_over(mesh_, t, longest_side(mesh_, t)) < sliver_height_);
    }

    void drop(std::uint32_t t)
    {
        dropped_[t] = 1;
        bad_.erase(t);
    }

    /// Gives a triangle other corners.
    void change(std::uint32_t t, const Vec3I& corners)
    {
        mesh_.triangles[t] = corners;
        surface_.source[t] = kNoSource;
        if (has_repeated_corner(corners))
            return drop(t);
        for (int k = 0; k < 3; ++k) {
            std::vector<std::uint32_t>& list = around_[corners[k]];
            if (std::find(list.begin(), list.end(), t) == list.end())
                list.push_back(t);
        }
        if (is_bad(corners))
            bad_.insert(t);
        else
            bad_.erase(t);
    }

    /// Calls look(triangle) for each triangle that has the point as a corner. The lists only grow,
    /// so they also hold triangles that had the point once; these are passed over.
    template <typename Look> void for_each_around(std::uint32_t point, const Look& look) const
    {
        for (const std::uint32_t t : around_[point]) {
            const Vec3I& corner = mesh_.triangles[t];
            if (!dropped_[t] && (corner[0] == point || corner[1] == point || corner[2] == point))
                look(t);
        }
    }

    /// The single other triangle at side k of triangle t. Of several none is given: to cut one of
    /// them and not the others would leave those with an edge that runs past the new corner.
    bool find_neighbour(std::uint32_t t, int k, Use& found) const
    {
        const std::uint32_t a = mesh_.triangles[t][k], b = mesh_.triangles[t][(k + 1) % 3];
        int count = 0;
        for_each_around(a, [&](std::uint32_t other) {
            const Vec3I& corner = mesh_.triangles[other];
            for (int side = 0; side < 3 && other != t; ++side) {
                const std::uint32_t p = corner[side], q = corner[(side + 1) % 3];
                if ((p == a && q == b) || (p == b && q == a)) {
                    found = {other, side};
                    ++count;
                }
            }
        });
        return count == 1;
    }

    /// For a cap: its corner over the longest side cuts the neighbour there in two, and the second
    /// half takes the triangle's place in the list. The halves turn as the neighbour does and take
    /// over the two short sides of the cap, so no edge is opened. Where the neighbour has that very
    /// corner itself, each half has a corner twice, and change() drops both.
    void cut_neighbour(std::uint32_t t, int side, const Use& neighbour)
    {
        const std::uint32_t middle = mesh_.triangles[t][(side + 2) % 3];
        Vec3I first = mesh_.triangles[neighbour.triangle], second = first;
        first[(neighbour.side + 1) % 3] = middle;
        second[neighbour.side] = middle;
        change(neighbour.triangle, first);
        change(t, second);
    }

    /// For a needle: the two ends of its shortest side become one point, the one of smaller index.
    /// The list of triangles is copied first, as change() adds to the lists.
    void collapse(std::uint32_t from, std::uint32_t to)
    {
        std::vector<std::uint32_t> moved;
        for_each_around(from, [&](std::uint32_t t) { moved.push_back(t); });
        for (const std::uint32_t t : moved) {
            Vec3I corners = mesh_.triangles[t];
            for (int k = 0; k < 3; ++k)
                corners[k] = corners[k] == from ? to : corners[k];
            change(t, corners);
        }
    }

    /// Whether the two points have no common neighbours but those across their edge; otherwise a
    /// collapse would fold the surface onto itself. This is the link condition of Dey and others
    /// 1999, "Topology preserving edge contraction". The triangles at the edge are counted and not
    /// taken to be two, so that it means the same at a rim.
    bool may_collapse(const Edge& ends) const
    {
        std::map<std::uint32_t, int> seen; // bit 0: neighbour of the first end, bit 1: of the other
        std::size_t at_edge = 0;
        for (std::size_t e = 0; e < 2; ++e)
            for_each_around(ends[e], [&](std::uint32_t t) {
                for (int k = 0; k < 3; ++k) {
                    const std::uint32_t point = mesh_.triangles[t][k];
                    seen[point] |= 1 << e;
                    at_edge += e == 0 && point == ends[1];
                }
            });
        std::size_t common = 0;
        for (const auto& [point, bits] : seen)
            common += bits == 3 && point != ends[0] && point != ends[1];
        return common == at_edge;
    }

    /// Removes one triangle that is flat or too low, and everything that follows from it.
    void remove(std::uint32_t t)
    {
        const Vec3I corners = mesh_.triangles[t];
        const bool flat = is_flat(mesh_, corners);
        if (surface_.source[t] != kNoSource)
            add_to(flat ? report_.degenerate : report_.slivers, surface_.source[t]);
        Edge ends{};
        // The limit of twice the sliver height bounds how far a collapse moves a point. A triangle
        // that is exactly flat is never collapsed, because the cut of its neighbour moves no point
        // at all.
        if (!flat && find_short_side(mesh_, corners, 2 * sliver_height_, ends) &&
            may_collapse(ends))
            return collapse(ends[1], ends[0]);
        const int side = longest_side(mesh_, corners);
        Use neighbour{};
        if (!find_neighbour(t, side, neighbour))
            return drop(t);
        if (surface_.source[neighbour.triangle] != kNoSource)
            add_to(report_.recut, surface_.source[neighbour.triangle]);
        cut_neighbour(t, side, neighbour);
    }

    WorkingSurface& surface_;
    TriangleMesh& mesh_;
    double sliver_height_;
    RepairReport& report_;
    std::vector<char> dropped_;
    std::vector<std::vector<std::uint32_t>> around_; ///< triangles by point, and former ones
    std::set<std::uint32_t> bad_;
};

} // namespace

void drop_degenerate(WorkingSurface& surface, double sliver_height, RepairReport& report)
{
    Remover(surface, sliver_height, report).run();
}

} // namespace vdb_shell::repair
