// SPDX-License-Identifier: Apache-2.0

// Takes tets and points. Gives for each point in how many tets it strictly lies. Points are sorted
// into cells, so that a tet looks only at those in its box. Floats, eight points at a time, exclude
// what lies outside a tet for certain; an exact sign decides the rest, so the counts have no
// tolerance. Inverted tets count like others, flat ones have no inside.

#include "certify/count_tets.h"

#include "certify/cell_grid.h"
#include "certify/points_in_planes.h"
#include "core/exact.h"
#include "core/orient3d_filter.h"
#include "core/parallel.h"
#include "core/simd.h"
#include "shell/tet_faces.h"

#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

namespace vdb_shell
{
namespace
{

using openvdb::Vec3d;
using openvdb::Vec3s;

/// The inside of one tet, for tests of many points: what depends on the tet alone is computed once.
class TetInside
{
public:
    TetInside(const std::array<Vec3s, 4>& corners, int sign)
        : corners_(corners), sign_(sign), planes_{plane(0), plane(1), plane(2), plane(3)}
    {
    }

    bool strictly_holds(const Vec3s& point) const
    {
        for (std::size_t face = 0; face < 4; ++face) {
            // The filter gives 0 where doubles do not decide, and the exact sign is computed for
            // those alone. A point on a face has the sign 0 and is in neither of the tets there, so
            // no point is counted twice for lying on a common face.
            const int side = planes_[face].side(Vec3d(point));
            if ((side != 0 ? side : exact_side(face, point)) != -sign_)
                return false;
        }
        return true;
    }

private:
    const Vec3s& corner(std::size_t face, std::size_t k) const
    {
        return corners_[static_cast<std::size_t>(kTetFaces[face][k])];
    }
    exact::PlaneFilter plane(std::size_t face) const
    {
        return {Vec3d(corner(face, 0)), Vec3d(corner(face, 1)), Vec3d(corner(face, 2))};
    }
    int exact_side(std::size_t face, const Vec3s& point) const
    {
        return exact::orient3d(corner(face, 0), corner(face, 1), corner(face, 2), point);
    }

    const std::array<Vec3s, 4>& corners_;
    int sign_;
    std::array<exact::PlaneFilter, 4> planes_;
};

/// Points by the cell of a grid of their own, in one array for each axis, so that a tet looks at
/// eight of them at a time.
struct SortedPoints {
    CellGrid grid;
    openvdb::Vec3d middle{0.0};
    std::vector<std::uint32_t> offset; ///< points of cell c stand at [offset[c], offset[c+1])
    std::vector<std::uint32_t> point;
    std::array<std::vector<float>, 3> off; ///< from the middle; room to read beyond the last
    /// From how many tets on another one would not change what is reported of the point.
    std::vector<std::uint8_t> enough;
};

SortedPoints sort_points(const std::vector<SamplePoint>& points, const Bounds& bounds)
{
    // The grid of the points is another one than that of the cells: it is laid out for the number
    // of points in the batch, not of samples in all.
    constexpr std::size_t kPointsInCell = 2;
    SortedPoints sorted;
    sorted.grid = make_cell_grid(bounds, points.size() / kPointsInCell + 1);
    sorted.middle = 0.5 * (bounds.low + bounds.high);
    std::vector<std::uint32_t> cell(points.size());
    for_each_index(cell.size(), [&](std::size_t i) {
        // A point on a plane meets several cells and is listed in the first of them. That is
        // enough, as a tet that holds it has a closed box, which meets all of them.
        const CellRange at = sorted.grid.overlapped(points[i].position, points[i].position);
        cell[i] = sorted.grid.cell(at.first[0], at.first[1], at.first[2]);
    });
    sorted.offset.assign(sorted.grid.cells() + 1, 0);
    for (const std::uint32_t c : cell)
        ++sorted.offset[c + 1];
    std::partial_sum(sorted.offset.begin(), sorted.offset.end(), sorted.offset.begin());
    sorted.point.resize(points.size());
    sorted.enough.resize(points.size());
    for (std::vector<float>& off : sorted.off)
        off.resize(points.size() + kLanes);
    std::vector<std::uint32_t> next(sorted.offset.begin(), sorted.offset.end() - 1);
    for (std::size_t i = 0; i < points.size(); ++i) {
        const std::uint32_t slot = next[cell[i]]++;
        sorted.point[slot] = static_cast<std::uint32_t>(i);
        sorted.enough[slot] = points[i].in_solid ? 2 : 1;
        // Relative to the middle, so that floats keep their digits for a mesh far from the origin.
        const Vec3s off(Vec3d(points[i].position) - sorted.middle);
        for (int a = 0; a < 3; ++a)
            sorted.off[std::size_t(a)][slot] = off[a];
    }
    return sorted;
}

/// The four planes of the tet in floats, moved outward so far that a point beyond one of them lies
/// outside the tet for certain.
FloatPlanes float_planes(const std::array<Vec3s, 4>& corners, int sign, const Vec3d& middle,
                         double span)
{
    // The rounding of a normal is that of doubles times the lengths of the edges over the area.
    // Floats then round a dozen terms, none longer than the span. Both bounds are taken four times
    // as large or more, and the sum is no less than what floats can tell from nought. A tet whose
    // normal is lost in doubles gives planes that are not numbers or lie infinitely far away: no
    // point is outside of those.
    constexpr double kOfNormal = 0x1p-48, kOfFloats = 0x1p-18;
    constexpr double kLeast = std::numeric_limits<float>::min();
    FloatPlanes planes;
    for (std::size_t face = 0; face < 4; ++face) {
        const Vec3d p(corners[std::size_t(kTetFaces[face][0])]);
        const Vec3d u = Vec3d(corners[std::size_t(kTetFaces[face][1])]) - p;
        const Vec3d w = Vec3d(corners[std::size_t(kTetFaces[face][2])]) - p;
        const Vec3d normal = double(sign) * u.cross(w);
        const double size = normal.length();
        const double slack = kOfNormal * std::sqrt(u.lengthSqr() * w.lengthSqr()) / size;
        for (int a = 0; a < 3; ++a)
            planes.outward[face][std::size_t(a)] = static_cast<float>(normal[a] / size);
        planes.most[face] =
            static_cast<float>(normal.dot(p - middle) / size + (slack + kOfFloats) * span + kLeast);
    }
    return planes;
}

/// The points near one tet. One of these serves all tets of a range in turn, so that its memory is
/// allocated once.
struct NearPoints {
    std::vector<PointRun> runs;
    std::vector<std::uint32_t> place; ///< in SortedPoints; the first `count` count
    std::size_t count = 0;
};

/// Lists the points in a box of cells that may lie in the tet. Cells one above the other stand
/// together, so a column gives one run.
void list_near(const SortedPoints& sorted, const CellRange& box, const FloatPlanes& planes,
               NearPoints& near)
{
    near.runs.clear();
    std::size_t most = 0;
    for (std::uint32_t i = box.first[0]; i <= box.last[0]; ++i)
        for (std::uint32_t j = box.first[1]; j <= box.last[1]; ++j) {
            const PointRun run{sorted.offset[sorted.grid.cell(i, j, box.first[2])],
                               sorted.offset[sorted.grid.cell(i, j, box.last[2]) + 1]};
            if (run.begin == run.end)
                continue;
            near.runs.push_back(run);
            most += run.end - run.begin;
        }
    if (near.place.size() < most)
        near.place.resize(most);
    near.count =
        points_in_planes({sorted.off[0].data(), sorted.off[1].data(), sorted.off[2].data()},
                         near.runs.data(), near.runs.size(), planes, near.place.data());
}

} // namespace

TetBox box_of(const std::array<Vec3s, 4>& p)
{
    using openvdb::math::maxComponent;
    using openvdb::math::minComponent;
    return {minComponent(minComponent(p[0], p[1]), minComponent(p[2], p[3])),
            maxComponent(maxComponent(p[0], p[1]), maxComponent(p[2], p[3]))};
}

SignedTets signed_tets(const TetMesh& tets, const Bounds& bounds)
{
    SignedTets result{tets, bounds, diagonal_of(bounds), {}};
    result.sign.resize(tets.tets.size());
    for_each_index(result.sign.size(), [&](std::size_t i) {
        const std::array<Vec3s, 4> p = corners_of(tets, i);
        result.sign[i] = static_cast<std::int8_t>(exact::orient3d(p[0], p[1], p[2], p[3]));
    });
    return result;
}

std::vector<std::atomic<std::uint32_t>> count_tets(const SignedTets& tets,
                                                   const std::vector<SamplePoint>& points)
{
    const SortedPoints sorted = sort_points(points, tets.bounds);
    std::vector<std::atomic<std::uint32_t>> hits(points.size());
    for_each_range(tets.mesh.tets.size(), [&](std::size_t begin, std::size_t end) {
        NearPoints near;
        for (std::size_t tet = begin; tet < end; ++tet) {
            const std::int8_t sign = tets.sign[tet];
            if (sign == 0)
                continue;
            const std::array<Vec3s, 4> corners = corners_of(tets.mesh, tet);
            const TetBox box = box_of(corners);
            list_near(sorted, sorted.grid.overlapped(box.low, box.high),
                      float_planes(corners, sign, sorted.middle, tets.span), near);
            // Made when a point first needs it: a tet without candidates, or with none that is not
            // counted out already, does without.
            std::optional<TetInside> inside;
            for (std::size_t n = 0; n < near.count; ++n) {
                const std::uint32_t k = near.place[n];
                std::atomic<std::uint32_t>& count = hits[sorted.point[k]];
                if (count.load(std::memory_order_relaxed) >= sorted.enough[k])
                    continue;
                if (!inside)
                    inside.emplace(corners, sign);
                if (inside->strictly_holds(points[sorted.point[k]].position))
                    count.fetch_add(1, std::memory_order_relaxed);
            }
        }
    });
    return hits;
}

} // namespace vdb_shell
