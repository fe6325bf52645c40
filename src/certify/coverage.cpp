// SPDX-License-Identifier: Apache-2.0

// Takes: a closed surface and any tets. Gives: for random points in the solid, how many lie in no
// tet, in one and in several. It is a second opinion on the certificate and shares none of its code
// but the exact predicates: no prism and no split bears on the count, and inverted tets count like
// others. Point k is a function of the seed and of k alone, and the points that count are the first
// ones up to the wanted number inside, so the result does not depend on batches or threads. Floats
// and cells only exclude what lies outside for certain; an exact sign decides the rest. Shares are
// those of volume because all drawn cells are equally likely and have the same size, up to the
// rounding of their planes to float32.

#include "vdb_shell/certify/coverage.h"

#include "vdb_shell/options/option.h"

#include "certify/cell_grid.h"
#include "certify/points_in_planes.h"
#include "certify/solid_cells.h"
#include "certify/tet_faces.h"
#include "core/counter_random.h"
#include "core/exact.h"
#include "core/orient3d_filter.h"
#include "core/parallel.h"
#include "core/simd.h"
#include "core/stage_progress.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <sstream>
#include <utility>

namespace vdb_shell
{
namespace
{

using openvdb::Vec3d;
using openvdb::Vec3s;

struct Point {
    Vec3s position;
    std::uint32_t cell;
    bool in_solid;
};

/// Everything that stays the same from batch to batch.
struct Scene {
    const TriangleMesh& surface;
    const TetMesh& tets;
    Bounds bounds; ///< of surface and tets
    CellGrid grid;
    double span = 0;
    std::vector<std::int8_t> sign; ///< of each tet; flat ones have no inside
    SolidCells solid;
    std::vector<std::uint32_t> drawn_cells; ///< where the points are drawn
};

std::array<Vec3s, 4> corners_of(const TetMesh& tets, std::size_t tet)
{
    const openvdb::Vec4I& t = tets.tets[tet];
    return {tets.points[t[0]], tets.points[t[1]], tets.points[t[2]], tets.points[t[3]]};
}

struct FloatBox {
    Vec3s low, high;
};
FloatBox box_of(const std::array<Vec3s, 4>& p)
{
    using openvdb::math::maxComponent;
    using openvdb::math::minComponent;
    return {minComponent(minComponent(p[0], p[1]), minComponent(p[2], p[3])),
            maxComponent(maxComponent(p[0], p[1]), maxComponent(p[2], p[3]))};
}

/// visit(first, last) for all runs of cells that the tet may meet. There are none for a flat tet:
/// it has no inside, and its half-spaces would be turned by a sign of 0.
template <typename Visit>
void visit_runs_of_tet(const Scene& scene, std::size_t tet, const Visit& visit)
{
    if (scene.sign[tet] == 0)
        return;
    const std::array<Vec3s, 4> corners = corners_of(scene.tets, tet);
    const FloatBox box = box_of(corners);
    visit_runs(scene.grid, scene.grid.overlapped(box.low, box.high),
               HalfSpaces::of_tet(corners, scene.sign[tet], scene.span), visit);
}

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

Bounds bounds_of_both(const TriangleMesh& surface, const TetMesh& tets)
{
    Bounds bounds = bounds_of(surface.points);
    if (tets.points.empty())
        return bounds;
    const Bounds other = bounds_of(tets.points);
    bounds.low = openvdb::math::minComponent(bounds.low, other.low);
    bounds.high = openvdb::math::maxComponent(bounds.high, other.high);
    return bounds;
}

/// Four cells a sample, within bounds: finer for more samples, so that laying out the cells remains
/// a small part of the work.
std::size_t cells_for(std::uint64_t samples)
{
    constexpr std::uint64_t kFewest = 4096, kMost = 1U << 21;
    return static_cast<std::size_t>(std::clamp(4 * std::min(samples, kMost), kFewest, kMost));
}

/// How many cells before each lie outside the solid: with these sums one difference tells whether a
/// whole run has any.
std::vector<std::uint32_t> count_outside_before(const SolidCells& solid)
{
    std::vector<std::uint32_t> before(solid.kind.size() + 1, 0);
    for (std::size_t cell = 0; cell < solid.kind.size(); ++cell)
        before[cell + 1] = before[cell] + (solid.kind[cell] == CellKind::outside);
    return before;
}

/// Whether the box of the tet meets a cell outside. A tet for which it does not need not be matched
/// with cells one by one, for cells that are not outside are drawn in any case.
bool may_leave_solid(const Scene& scene, std::size_t tet,
                     const std::vector<std::uint32_t>& outside_before)
{
    const FloatBox box = box_of(corners_of(scene.tets, tet));
    const CellRange range = scene.grid.overlapped(box.low, box.high);
    for (std::uint32_t i = range.first[0]; i <= range.last[0]; ++i)
        for (std::uint32_t j = range.first[1]; j <= range.last[1]; ++j)
            if (outside_before[scene.grid.cell(i, j, range.first[2])] <
                outside_before[scene.grid.cell(i, j, range.last[2]) + 1])
                return true;
    return false;
}

Scene make_scene(const TriangleMesh& surface, const TetMesh& tets, std::uint64_t samples)
{
    const Bounds bounds = bounds_of_both(surface, tets);
    Scene scene{
        surface, tets, bounds, make_cell_grid(bounds, cells_for(samples)), diagonal_of(bounds),
        {},      {},   {}};
    scene.sign.resize(tets.tets.size());
    for_each_index(scene.sign.size(), [&](std::size_t i) {
        const std::array<Vec3s, 4> p = corners_of(tets, i);
        scene.sign[i] = static_cast<std::int8_t>(exact::orient3d(p[0], p[1], p[2], p[3]));
    });
    scene.solid = classify_cells(scene.grid, surface);
    const std::vector<std::uint32_t> outside_before = count_outside_before(scene.solid);
    // Threads may mark the same cell, all with the same value, and nothing is read before they have
    // ended: relaxed order is enough, and the result is a set. Atomics of a vector begin as false.
    std::vector<std::atomic<bool>> met_by_tet(scene.grid.cells());
    for_each_index(tets.tets.size(), [&](std::size_t i) {
        if (!may_leave_solid(scene, i, outside_before))
            return;
        visit_runs_of_tet(scene, i, [&](std::uint32_t first, std::uint32_t last) {
            for (std::uint32_t cell = first; cell <= last; ++cell)
                met_by_tet[cell].store(true, std::memory_order_relaxed);
        });
    });
    for (std::uint32_t cell = 0; cell < scene.grid.cells(); ++cell)
        if (scene.solid.kind[cell] != CellKind::outside ||
            met_by_tet[cell].load(std::memory_order_relaxed))
            scene.drawn_cells.push_back(cell);
    return scene;
}

/// Point `number` of the sequence: all its random numbers come from that number.
Point draw(const Scene& scene, const CounterRandom& random, std::uint64_t number)
{
    // One random number for the cell and three for the place in it.
    const std::uint64_t counter = 4 * number;
    Point point;
    point.cell = scene.drawn_cells[random.below(counter, scene.drawn_cells.size())];
    point.position =
        scene.grid.point_in(point.cell, Vec3d(random.unit(counter + 1), random.unit(counter + 2),
                                              random.unit(counter + 3)));
    const CellKind kind = scene.solid.kind[point.cell];
    point.in_solid = kind == CellKind::inside ||
                     (kind == CellKind::surface &&
                      inside_solid(scene.solid, scene.surface, scene.grid.column_of(point.cell),
                                   point.position));
    return point;
}

/// Points `first` and on, up to and with the one that is the `wanted`-th inside the solid. More are
/// drawn than are wanted, because some fall outside; the cut is made by their order in the
/// sequence, so it is the same for batches of any size.
std::vector<Point> draw_batch(const Scene& scene, const CounterRandom& random, std::uint64_t first,
                              std::uint64_t wanted)
{
    constexpr std::uint64_t kFewest = 4096, kMost = 1U << 20;
    std::vector<Point> points(std::clamp(wanted + wanted / 2, kFewest, kMost));
    for_each_index(points.size(),
                   [&](std::size_t i) { points[i] = draw(scene, random, first + i); });
    std::size_t kept = 0;
    for (std::uint64_t inside = 0; kept < points.size() && inside < wanted; ++kept)
        inside += points[kept].in_solid;
    points.resize(kept);
    return points;
}

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

SortedPoints sort_points(const std::vector<Point>& points, const Bounds& bounds)
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

/// In how many tets each point lies, as far as it matters. Counts only grow, by integers, and a
/// point is skipped only once it has `enough`. So whether a count ends as 0, as 1 or as more is the
/// same in whatever order threads come to the tets; the exact number above `enough` is not, and is
/// not reported.
std::vector<std::atomic<std::uint32_t>> count_tets(const Scene& scene,
                                                   const std::vector<Point>& points)
{
    const SortedPoints sorted = sort_points(points, scene.bounds);
    std::vector<std::atomic<std::uint32_t>> hits(points.size());
    for_each_range(scene.tets.tets.size(), [&](std::size_t begin, std::size_t end) {
        NearPoints near;
        for (std::size_t tet = begin; tet < end; ++tet) {
            const std::int8_t sign = scene.sign[tet];
            if (sign == 0)
                continue;
            const std::array<Vec3s, 4> corners = corners_of(scene.tets, tet);
            const FloatBox box = box_of(corners);
            list_near(sorted, sorted.grid.overlapped(box.low, box.high),
                      float_planes(corners, sign, sorted.middle, scene.span), near);
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

void add_batch(const Scene& scene, const std::vector<Point>& points, Coverage& coverage)
{
    const std::vector<std::atomic<std::uint32_t>> hits = count_tets(scene, points);
    for (std::size_t i = 0; i < points.size(); ++i) {
        const std::uint32_t tets = hits[i].load(std::memory_order_relaxed);
        if (!points[i].in_solid) {
            coverage.outside_covered += tets > 0;
            continue;
        }
        ++coverage.samples;
        coverage.in_none += tets == 0;
        coverage.in_one += tets == 1;
        coverage.in_several += tets > 1;
    }
}

void set_shares(Coverage& coverage)
{
    const auto samples = static_cast<double>(coverage.samples);
    auto share = [&](std::uint64_t count) { return static_cast<double>(count) / samples; };
    auto binomial_error = [&](double p) { return std::sqrt(p * (1 - p) / samples); };
    coverage.covered_share = share(coverage.in_one + coverage.in_several);
    coverage.overlap_share = share(coverage.in_several);
    coverage.outside_share = share(coverage.outside_covered);
    coverage.standard_error = binomial_error(coverage.covered_share);
    coverage.overlap_standard_error = binomial_error(coverage.overlap_share);
}

void require_solid(const TriangleMesh& surface)
{
    const double volume = signed_volume(surface.points, surface.triangles);
    if (volume > 0)
        return;
    std::ostringstream message;
    message << "coverage: the surface encloses a volume of " << volume
            << ", which has to be positive: is it open, flat, or oriented inward?";
    throw GeometryError(message.str());
}

} // namespace

OptionList describe(CoverageOptions& o)
{
    return in_group("Tets",
                    {option("samples", o.samples, "--samples",
                            "Monte Carlo points inside the solid; 0 leaves the estimate out")
                         .in(Unit::count),
                     option("seed", o.seed, "--samples-seed", "Seed of the Monte Carlo points")
                         .in(Unit::seed)});
}

Coverage estimate_coverage(const TriangleMesh& surface, const TetMesh& tets,
                           const CoverageOptions& options, Interrupter* interrupter)
{
    if (options.samples == 0)
        return {};
    require_solid(surface);
    const StageProgress progress(interrupter, "Coverage");
    const Scene scene = make_scene(surface, tets, options.samples);
    const CounterRandom random(options.seed);
    // Only a solid that fills next to nothing of the cells it passes through comes near this bound.
    // It is there so that the loop ends for a solid in which no float32 point lies, however many
    // are drawn.
    constexpr std::uint64_t kMostDrawsPerSample = 1000, kFewestMostDraws = 1U << 22;
    const std::uint64_t most_draws =
        std::max(kFewestMostDraws, kMostDrawsPerSample * options.samples);
    Coverage coverage;
    std::uint64_t drawn = 0;
    while (coverage.samples < options.samples && drawn < most_draws) {
        progress.stop_if_interrupted(static_cast<int>(
            100.0 * static_cast<double>(coverage.samples) / static_cast<double>(options.samples)));
        const std::vector<Point> points =
            draw_batch(scene, random, drawn, options.samples - coverage.samples);
        drawn += points.size();
        add_batch(scene, points, coverage);
    }
    if (coverage.samples == 0)
        throw GeometryError("coverage: none of " + std::to_string(drawn) +
                            " points near the surface lies inside it: the solid is too thin for "
                            "float32 coordinates");
    set_shares(coverage);
    return coverage;
}

} // namespace vdb_shell
