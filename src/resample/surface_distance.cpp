// SPDX-License-Identifier: Apache-2.0

// Takes two surfaces and samples the first: triangles are cut into pieces of about one size, and
// the nearest triangle of the second is found for the middle of each piece and for all vertices;
// the same measure as in Cignoni, Rocchini and Scopigno 1998, "Metro: measuring error on simplified
// surfaces". No point of a piece is farther from its middle than two thirds of its longest edge,
// and a distance to a surface changes by no more than the point moves. So the largest distance
// found is too small by two thirds of the spacing at most. It is one-sided: a part that only the
// second surface has is not seen.

#include "vdb_shell/resample/surface_distance.h"

#include "core/fail.h"
#include "core/parallel.h"
#include "core/sort_unique.h"
#include "core/stage_progress.h"
#include "core/stage_stop.h"
#include "mesh/nearest_on_triangle.h"
#include "mesh/triangle_area.h"
#include "mesh/triangle_corners.h"
#include "mesh/triangle_tree.h"
#include "resample/far_points.h"
#include "resample/triangle_pieces.h"
#include "vdb_shell/core/error.h"

#include <openvdb/openvdb.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace vdb_shell
{
namespace
{

using openvdb::Vec3d;

// A bound on the memory: a point, its area, its distance and the triangle there take 44 bytes, so
// 2^27 of them take 5.5 GiB.
constexpr double kMostSamples = 134217728.0;
// Pieces for each square of the spacing: halving at the longest edge leaves pieces smaller than it
// allows.
constexpr double kPiecesInSquare = 8;
// A search begins with the triangle that the one before it found, which is near. Of triangles that
// are equally near to the last bit of a float the beginning may decide which is found, so runs of
// points that follow each other are cut at fixed places, not where threads happen to cut them.
constexpr std::size_t kPointsInRun = 256;
// A surface that is a single point has no diagonal to measure in.
constexpr double kLeastUnit = 1e-30;

struct Samples {
    std::vector<Vec3d> points;
    std::vector<double> areas;

    void add(const Vec3d& point, double area)
    {
        points.push_back(point);
        areas.push_back(area);
    }
};

/// Samples, of which the first in a cell of a grid has the area of all in it. They are no farther
/// apart than its diagonal.
class SamplesInCells
{
public:
    /// `low`: of the box of all points, from where cells are counted.
    SamplesInCells(Samples& samples, const Vec3d& low, double cell)
        : samples_(samples), low_(low), cell_(cell), place_(places_)
    {
    }

    void add(const Vec3d& point, double area)
    {
        const openvdb::Coord cell = openvdb::Coord::floor((point - low_) / cell_);
        std::int32_t index = 0;
        if (!place_.probeValue(cell, index)) {
            index = static_cast<std::int32_t>(samples_.points.size());
            place_.setValue(cell, index);
            samples_.add(point, 0.0);
        }
        samples_.areas[static_cast<std::size_t>(index)] += area;
    }

private:
    Samples& samples_;
    Vec3d low_;
    double cell_;
    openvdb::Int32Tree places_{-1}; ///< by cell, its place among the samples
    openvdb::tree::ValueAccessor<openvdb::Int32Tree> place_;
};

/// Whether there is more of the surface than one sheet for each cell of a grid around it. The grid
/// has a cell to spare along each axis, so no box is crowded, however thin.
bool fills_cells(const Bounds& bounds, double spacing, double area)
{
    double cells = 1;
    for (int k = 0; k < 3; ++k)
        cells *= 2 + (bounds.high[k] - bounds.low[k]) / spacing;
    return area / (spacing * spacing) > cells;
}

double sum_of_edges(const TriangleMesh& mesh)
{
    double sum = 0;
    for (const openvdb::Vec3I& t : mesh.triangles)
        for (int k = 0; k < 3; ++k)
            sum += (Vec3d(mesh.points[t[k]]) - Vec3d(mesh.points[t[(k + 1) % 3]])).length();
    return sum;
}

/// Where sheets lie many in one place, samples of a place are asked once: the place bounds them,
/// and not the sheets.
Samples sample(const TriangleMesh& mesh, double spacing)
{
    const double finest = finest_spacing(mesh);
    if (!(std::isfinite(spacing) && spacing > 0 && spacing >= finest))
        fail<InvalidOption>("surface distance: spacing is ", spacing, ", must be at least ", finest,
                            ", which gives 2^27 points");
    const double area = surface_area(mesh.points, mesh.triangles);
    Samples samples;
    const auto add_to = [&](auto& list) {
        std::size_t pieces = 0;
        for (const openvdb::Vec3I& t : mesh.triangles)
            for_each_piece(Vec3d(mesh.points[t[0]]), Vec3d(mesh.points[t[1]]),
                           Vec3d(mesh.points[t[2]]), spacing,
                           [&](const Vec3d& a, const Vec3d& b, const Vec3d& c) {
                               stop_if_stage_wants(pieces++);
                               list.add((a + b + c) / 3.0, 0.5 * (b - a).cross(c - a).length());
                           });
        // Vertices count for the largest distance alone: they have no area, and so no weight in the
        // mean.
        for (const openvdb::Vec3s& p : mesh.points)
            list.add(Vec3d(p), 0.0);
    };
    const Bounds bounds = bounds_of(mesh.points);
    if (fills_cells(bounds, spacing, area)) {
        SamplesInCells cells(samples, bounds.low, spacing);
        add_to(cells);
    } else
        add_to(samples);
    return samples;
}

/// The distance of each point to the surface: the tree says in floats which triangle is nearest,
/// and doubles how far that is. So it is never too short, and too long by no more than the
/// rounding of a float of the size of the surface.
std::vector<double> distances_to(const TriangleMesh& surface, const std::vector<Vec3d>& points,
                                 std::vector<std::uint32_t>& nearest)
{
    const TriangleTree tree(surface, std::max(diagonal_of(bounds_of(surface.points)), kLeastUnit));
    std::vector<double> distances(points.size());
    nearest.resize(points.size());
    const std::size_t runs = (points.size() + kPointsInRun - 1) / kPointsInRun;
    for_each_index(
        runs,
        [&](std::size_t run) {
            TriangleTree::Seed seed = TriangleTree::kNoSeed;
            const std::size_t end = std::min(points.size(), (run + 1) * kPointsInRun);
            for (std::size_t i = run * kPointsInRun; i < end; ++i) {
                const std::uint32_t t = tree.nearest(points[i], 0.0F, seed).triangle;
                const Vec3d on = nearest_on_triangle(triangle_corners(surface, t), points[i]).point;
                distances[i] = (on - points[i]).length();
                nearest[i] = t;
            }
        },
        1);
    return distances;
}

} // namespace

double finest_spacing(const TriangleMesh& from)
{
    // An estimate before anything is made; of a triangle without width there are as many pieces as
    // of its edges. The root of kPiecesInSquare area / spacing^2 + edges / spacing = kMostSamples.
    const double area = surface_area(from.points, from.triangles), edges = sum_of_edges(from);
    return (edges + std::sqrt(edges * edges + 4 * kPiecesInSquare * area * kMostSamples)) /
           (2 * kMostSamples);
}

DistanceFigures surface_distance(const TriangleMesh& from, const TriangleMesh& to, double spacing,
                                 Interrupter* interrupter)
{
    std::vector<FarPoint> none;
    return surface_distance(from, to, spacing, std::numeric_limits<double>::infinity(), none,
                            interrupter);
}

DistanceFigures surface_distance(const TriangleMesh& from, const TriangleMesh& to, double spacing,
                                 double limit, std::vector<FarPoint>& far, Interrupter* interrupter)
{
    const StageProgress progress(interrupter, "surface distance");
    if (from.triangles.empty() || to.triangles.empty())
        throw GeometryError("surface distance: the surfaces have " +
                            std::to_string(from.triangles.size()) + " and " +
                            std::to_string(to.triangles.size()) + " triangles");
    const Samples samples = sample(from, spacing);
    std::vector<std::uint32_t> nearest;
    const std::vector<double> distances = distances_to(to, samples.points, nearest);
    progress.stop_if_interrupted(100);
    DistanceFigures figures;
    figures.samples = distances.size();
    // Summed in the order of the samples, not by threads, so that the rounding is always the same.
    double area = 0;
    for (std::size_t i = 0; i < distances.size(); ++i) {
        figures.mean += samples.areas[i] * distances[i];
        area += samples.areas[i];
        figures.max = std::max(figures.max, distances[i]);
        if (distances[i] > limit)
            far.push_back({samples.points[i], nearest[i]});
    }
    figures.mean = area > 0 ? figures.mean / area : 0.0;
    return figures;
}

std::vector<std::uint32_t> triangles_of(const std::vector<FarPoint>& far)
{
    std::vector<std::uint32_t> triangles;
    triangles.reserve(far.size());
    for (const FarPoint& f : far)
        triangles.push_back(f.triangle);
    sort_unique(triangles);
    return triangles;
}

std::vector<std::uint32_t> nearest_triangles(const TriangleMesh& surface,
                                             const std::vector<Vec3d>& points)
{
    std::vector<std::uint32_t> nearest;
    distances_to(surface, points, nearest);
    return nearest;
}

} // namespace vdb_shell
