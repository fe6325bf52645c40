// SPDX-License-Identifier: Apache-2.0

// Takes: a closed surface and any tets. Gives: for random points in the solid, how many lie in no
// tet, in one and in several. It is a second opinion on the certificate and shares none of its code
// but the exact predicates: no prism and no split bears on the count, and inverted tets count like
// others. Point k is a function of the seed and of k alone, and the points that count are the first
// ones up to the wanted number inside, so the result does not depend on batches or threads. Cells
// only exclude what lies outside for certain; an exact sign decides the rest. Shares are those of
// volume because all drawn cells are equally likely and have the same size, up to the rounding of
// their planes to float32.

#include "vdb_shell/certify/coverage.h"

#include "vdb_shell/options/option.h"

#include "certify/cell_grid.h"
#include "certify/count_tets.h"
#include "certify/solid_cells.h"
#include "core/counter_random.h"
#include "core/parallel.h"
#include "core/stage_progress.h"
#include "core/text_stream.h"
#include "shell/tet_faces.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <utility>

namespace vdb_shell
{
namespace
{

using openvdb::Vec3d;
using openvdb::Vec3s;

/// Everything that stays the same from batch to batch.
struct Scene {
    const TriangleMesh& surface;
    SignedTets tets;
    CellGrid grid;
    SolidCells solid;
    std::vector<std::uint32_t> drawn_cells; ///< where the points are drawn
};

/// visit(first, last) for all runs of cells that the tet may meet. There are none for a flat tet:
/// it has no inside, and its half-spaces would be turned by a sign of 0.
template <typename Visit>
void visit_runs_of_tet(const Scene& scene, std::size_t tet, const Visit& visit)
{
    if (scene.tets.sign[tet] == 0)
        return;
    const std::array<Vec3s, 4> corners = corners_of(scene.tets.mesh, tet);
    const TetBox box = box_of(corners);
    visit_runs(scene.grid, scene.grid.overlapped(box.low, box.high),
               HalfSpaces::of_tet(corners, scene.tets.sign[tet], scene.tets.span), visit);
}

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
    const TetBox box = box_of(corners_of(scene.tets.mesh, tet));
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
        surface, signed_tets(tets, bounds), make_cell_grid(bounds, cells_for(samples)), {}, {}};
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
SamplePoint draw(const Scene& scene, const CounterRandom& random, std::uint64_t number)
{
    // One random number for the cell and three for the place in it.
    const std::uint64_t counter = 4 * number;
    SamplePoint point;
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
std::vector<SamplePoint> draw_batch(const Scene& scene, const CounterRandom& random,
                                    std::uint64_t first, std::uint64_t wanted)
{
    constexpr std::uint64_t kFewest = 4096, kMost = 1U << 20;
    std::vector<SamplePoint> points(std::clamp(wanted + wanted / 2, kFewest, kMost));
    for_each_index(points.size(),
                   [&](std::size_t i) { points[i] = draw(scene, random, first + i); });
    std::size_t kept = 0;
    for (std::uint64_t inside = 0; kept < points.size() && inside < wanted; ++kept)
        inside += points[kept].in_solid;
    points.resize(kept);
    return points;
}

void add_batch(const Scene& scene, const std::vector<SamplePoint>& points, Coverage& coverage)
{
    const std::vector<std::atomic<std::uint32_t>> hits = count_tets(scene.tets, points);
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
    OutText message;
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
    const StageProgress progress(interrupter, "coverage");
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
        const std::vector<SamplePoint> points =
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
