// SPDX-License-Identifier: Apache-2.0

// Takes a closed, embedded surface and an edge length or a number of triangles, and leaves a
// surface of nearly equilateral triangles within a tolerance of it. This file has the schedule: the
// rounds (remesh_rounds.h), how the wanted length follows the number of triangles, and what happens
// when the measured distance is too large: triangles are cut there, and where that does not do all
// is done anew with a smaller tolerance, as in decimation. Validity is looked after by each
// operation (remesh_surface.h). Lengths are in world units.

#include "vdb_shell/resample/remesh.h"

#include "core/available_memory.h"
#include "core/fail.h"
#include "core/stage_progress.h"
#include "mesh/nearest_on_triangle.h"
#include "mesh/triangle_area.h"
#include "mesh/triangle_corners.h"
#include "resample/attempts.h"
#include "resample/far_points.h"
#include "resample/remesh_rounds.h"
#include "vdb_shell/core/error.h"
#include "vdb_shell/mesh/check_mesh.h"
#include "vdb_shell/options/option.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <string>
#include <utility>

namespace vdb_shell
{
namespace
{

constexpr double kPi = 3.141592653589793;
// Just under half a turn, by which only triangles folded onto each other are apart.
constexpr double kLargestAngle = 3.14;
// Ten rounds as in Botsch and Kobbelt; more change less than a hundredth of the angles.
constexpr int kRounds = 10;
// Rounds of mending single triangles at the end; they end before when nothing is left to mend.
constexpr int kLastRounds = 10;
// Cosine of 35 degrees: angles under 30 are what is to be avoided, and some room is left.
constexpr double kNarrow = 0.819;
// Cosine of 20 degrees: what is narrower is mended before edges are split, for triangles that come
// of needles are needles.
constexpr double kNeedle = 0.94;
// Of the wanted length: no tolerance or feature makes it smaller than that.
constexpr double kLeastSize = 0.1;
// By how much the wanted length may change over an edge, as a share of the edge's length. Over
// two edges it then doubles, and triangles in between have angles over 35 degrees.
constexpr double kSlope = 0.5;
// By how much a length that was made smaller grows again in each of the first rounds, in which
// collapses may have been refused for what later ones have mended.
constexpr double kRegrowth = 1.2;
// Of the wanted length: curves of features that end in nothing count from there on.
constexpr double kLeastCurve = 2.0;
constexpr int kMostRemeshings = 5;
// How often triangles that are too far from the input are cut and there are no fewer afterwards,
// before all is done anew.
constexpr int kMostCutsInVain = 2;
// Where more than one in so many triangles, and some for small surfaces, are too far, the
// operations cannot keep the tolerance anywhere, and cuts would have no end.
constexpr std::size_t kShareOfFar = 50, kFewFar = 10;
// Share of the tolerance that the operations are held to: they see less than is measured
// afterwards.
constexpr double kFirstShare = 0.9;
// Points of the input at which operations look are no farther apart than that share of the length.
constexpr double kSpacing = 0.5;
// As subdivide(): a shell has three tets for a triangle, and their indices are 32 bits wide.
constexpr double kMostTriangles = 1U << 30U;
// Of the surface at work with its neighbours, sizes and samples of the input. An estimate on the
// low side, for nothing may be refused that would have gone through.
constexpr double kLeastBytes = 250;

/// The edge length at which equilateral triangles of the surface's area are so many.
double length_for(double area, double triangles)
{
    return std::sqrt(area * 4 / (std::sqrt(3.0) * triangles));
}

double default_tolerance(double length, double feature_angle)
{
    return 0.5 * length * std::sin(0.5 * feature_angle);
}

/// How many equilateral triangles of that edge length the area has room for.
double triangles_for(double area, double length)
{
    return area * 4 / (std::sqrt(3.0) * length * length);
}

void require_sound(const TriangleMesh& mesh)
{
    require_usable(check_mesh(mesh), {}, "remesh");
}

/// Known before the work, which would take all memory and end the process without a word.
void require_possible(const RemeshOptions& options, double area)
{
    const double count =
        options.triangles ? double(*options.triangles) : triangles_for(area, *options.edge_length);
    const auto refuse = [&](const auto&... limit) {
        if (options.triangles)
            fail<InvalidOption>("remesh: triangles is ", *options.triangles, ", ", limit...);
        fail<InvalidOption>("remesh: edge_length is ", *options.edge_length,
                            " for a surface of area ", area, ", which are ", count, " triangles, ",
                            limit...);
    };
    if (!(count < kMostTriangles))
        refuse("must give less than 2^30 triangles");
    const double bytes = kLeastBytes * count, free = available_memory();
    if (bytes > free)
        refuse("must not need more than the ", free / kBytesPerGib,
               " GiB of memory that are free, and ", "would need ", bytes / kBytesPerGib,
               " or more");
}

/// What all attempts have in common.
struct Job {
    const TriangleMesh& input;
    const RemeshOptions& options;
    FeatureCurves features;
    double tolerance; ///< the one that is to hold
    double spacing;   ///< of the points at which it is measured
    const StageProgress& progress;
};

/// The rounds of Botsch and Kobbelt. The edge length that they end with is left in `length`.
void make_even(RemeshSurface& surface, const Job& job, double& length)
{
    const double wanted = job.options.triangles ? double(*job.options.triangles) : 0.0;
    for (std::uint32_t v = 0; v < surface.vertex_slots(); ++v)
        surface.size(v) = length;
    flip_to_angle(surface);
    for (int round = 0; round < kRounds; ++round) {
        job.progress.stop_if_interrupted(90.0 * round / kRounds);
        if (round > 1 && wanted > 0) {
            const double before = length;
            length *= std::sqrt(double(surface.live_triangles()) / wanted);
            grade_sizes(surface, length, kSlope, std::max(1.0, length / before));
        }
        grade_sizes(surface, length, kSlope, round < kRounds / 2 ? kRegrowth : 1.0);
        if (round < kRounds / 2)
            raise_angles(surface, kNeedle);
        split_long_edges(surface, round == 0);
        collapse_short_edges(surface, kLeastSize * length);
        flip_to_valence(surface);
        smooth(surface);
        surface.settle_samples();
    }
    flip_to_angle(surface);
    surface.settle_samples();
}

/// Mends single triangles until there is nothing left to mend.
void mend_angles(RemeshSurface& surface, const Job& job, double cosine)
{
    for (int round = 0; round < kLastRounds; ++round) {
        job.progress.stop_if_interrupted(90);
        const std::uint64_t before = surface.now() + 1;
        if (raise_angles(surface, cosine) == 0)
            break;
        flip_to_angle(surface, before);
        surface.settle_samples();
    }
}

/// Measures both ways, and lists points of the input where the surfaces are farther apart than they
/// may be, each with the triangle of the result there.
std::vector<FarPoint> measure(const Job& job, RemeshResult& result, Interrupter* interrupter)
{
    RemeshReport& report = result.report;
    std::vector<FarPoint> far, of_result;
    report.input_to_result =
        surface_distance(job.input, result.mesh, job.spacing, job.tolerance, far, interrupter);
    report.result_to_input = surface_distance(result.mesh, job.input, job.spacing, job.tolerance,
                                              of_result, interrupter);
    if (of_result.empty())
        return far;
    std::vector<openvdb::Vec3d> points;
    points.reserve(of_result.size());
    for (const FarPoint& f : of_result)
        points.push_back(f.point);
    const std::vector<std::uint32_t> triangles = nearest_triangles(result.mesh, points);
    for (std::size_t i = 0; i < points.size(); ++i)
        far.push_back(
            {nearest_on_triangle(triangle_corners(job.input, of_result[i].triangle), points[i])
                 .point,
             triangles[i]});
    return far;
}

/// One attempt; the edge length that it ended with is left in `length`. Whether the surfaces are
/// near enough stands in the report.
RemeshResult attempt(const Job& job, double tolerance, double& length, Interrupter* interrupter)
{
    RemeshSurface surface(job.input, job.features, tolerance, kSpacing * length);
    make_even(surface, job, length);
    mend_angles(surface, job, kNarrow);
    RemeshResult out = surface.result();
    std::vector<FarPoint> far = measure(job, out, interrupter);
    // Between the points at which operations look the surfaces can be farther apart, at a few
    // places, by some hundredths. Smaller triangles there cost less than all anew.
    const std::size_t few = surface.live_triangles() / kShareOfFar + kFewFar;
    std::size_t fewest = few + 1;
    for (int in_vain = 0; in_vain < kMostCutsInVain && !far.empty();) {
        const std::size_t triangles = triangles_of(far).size();
        if (triangles > few)
            break;
        in_vain = triangles < fewest ? 0 : in_vain + 1;
        fewest = std::min(fewest, triangles);
        bring_nearer(surface, far);
        mend_angles(surface, job, kNeedle);
        out = surface.result();
        far = measure(job, out, interrupter);
    }
    return out;
}

bool is_near(const RemeshReport& report, double tolerance)
{
    return std::max(report.input_to_result.max, report.result_to_input.max) <= tolerance;
}

RemeshResult unchanged(const TriangleMesh& mesh)
{
    RemeshResult out;
    out.mesh = mesh;
    out.map.input_on_result.resize(mesh.points.size());
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
        for (int k = 0; k < 3; ++k) {
            SurfacePoint& place = out.map.input_on_result[mesh.triangles[t][k]];
            place = {t, mesh.triangles[t], {}};
            place.weights[std::size_t(k)] = 1;
        }
    out.map.result_on_input = out.map.input_on_result;
    out.report.kept_input = true;
    return out;
}

double share_in_range(const TriangleMesh& mesh, double length)
{
    std::size_t inside = 0, all = 0;
    for (const openvdb::Vec3I& c : mesh.triangles)
        for (int k = 0; k < 3; ++k) {
            const double l =
                (openvdb::Vec3d(mesh.points[c[k]]) - openvdb::Vec3d(mesh.points[c[(k + 1) % 3]]))
                    .length();
            inside += l >= kTooShort * length && l <= kTooLong * length;
            ++all;
        }
    return double(inside) / double(all);
}

void describe_result(const Job& job, RemeshResult& result, double length, int repeats)
{
    RemeshReport& report = result.report;
    report.before = job.input.triangles.size();
    report.triangles = result.mesh.triangles.size();
    report.wanted = job.options.triangles;
    report.edge_length = length;
    report.tolerance = job.tolerance;
    report.repeats = repeats;
    report.feature_edges = job.features.edges;
    report.feature_curves = job.features.curves.size();
    report.corners = job.features.corners;
    report.shape_before = triangle_figures(job.input);
    report.shape = triangle_figures(result.mesh);
    report.edges_in_range = share_in_range(result.mesh, length);
}

} // namespace

OptionList describe(RemeshOptions& o)
{
    return in_group(
        "Resampling",
        {option("edge_length", o.edge_length, "--remesh-edge-length",
                "Make triangles nearly equilateral first, with edges of this length, world units")
             .in(Unit::world_length)
             .within(above(0)),
         option("triangles", o.triangles, "--remesh-to",
                "The same, with about this many triangles in place of a length")
             .in(Unit::count)
             .within(at_least(kFewestTriangles))
             .excluding("--remesh-edge-length"),
         option("tolerance", o.tolerance, "--remesh-tolerance",
                "Farthest that remeshing may part the surfaces, world units; unset: half the "
                "length times the sine of half the feature angle")
             .needing("--remesh-edge-length or --remesh-to")
             .in(Unit::world_length)
             .within(above(0)),
         option("feature_angle_radians", o.feature_angle_radians, "--remesh-feature-angle",
                "Remeshing keeps edges at which the surface turns by more than this, radians")
             .needing("--remesh-edge-length or --remesh-to")
             .in(Unit::radians)
             .within(above(0).at_most(kLargestAngle))});
}

void require_sensible(const RemeshOptions& options)
{
    require_in_range(options, "remesh");
    if (options.edge_length && options.triangles)
        throw InvalidOption("remesh: edge_length and triangles are both given; one or the other");
    // Told here as well, where no surface has been read yet.
    if (options.triangles && !(double(*options.triangles) < kMostTriangles))
        throw InvalidOption("remesh: triangles is " + std::to_string(*options.triangles) +
                            ", must be less than 2^30");
}

TriangleFigures triangle_figures(const TriangleMesh& mesh)
{
    using openvdb::Vec3d;
    TriangleFigures figures;
    figures.min_angle_radians = kPi;
    for (const openvdb::Vec3I& c : mesh.triangles) {
        const Vec3d p(mesh.points[c[0]]), q(mesh.points[c[1]]), r(mesh.points[c[2]]);
        const Vec3d u = q - p, v = r - q, w = p - r;
        const double twice = u.cross(v).length();
        double least = kPi;
        for (const double cosine : {-u.dot(v), -v.dot(w), -w.dot(u)})
            least = std::min(least, std::atan2(twice, cosine));
        figures.min_angle_radians = std::min(figures.min_angle_radians, least);
        figures.mean_min_angle_radians += least / double(mesh.triangles.size());
        figures.under_20_degrees += least < kPi / 9;
        figures.under_30_degrees += least < kPi / 6;
        for (const double length : {u.length(), v.length(), w.length()}) {
            // Each edge of a closed surface comes twice, which the mean does not feel.
            figures.mean_edge += length / (3 * double(mesh.triangles.size()));
            figures.longest_edge = std::max(figures.longest_edge, length);
            figures.shortest_edge =
                figures.shortest_edge > 0 ? std::min(figures.shortest_edge, length) : length;
        }
    }
    return figures;
}

RemeshResult remesh(const TriangleMesh& mesh, const RemeshOptions& options,
                    Interrupter* interrupter)
{
    require_sensible(options);
    if (!options.wanted())
        throw InvalidOption("remesh: neither edge_length nor triangles is given");
    require_sound(mesh);
    const StageProgress progress(interrupter, "remesh");
    const double diagonal = diagonal_of(bounds_of(mesh.points));
    const double area = surface_area(mesh.points, mesh.triangles);
    require_possible(options, area);
    const double wanted =
        options.edge_length.value_or(length_for(area, double(options.triangles.value_or(1))));
    const double tolerance =
        options.tolerance.value_or(default_tolerance(wanted, options.feature_angle_radians));
    const double spacing =
        std::max(diagonal / kSamplesAlongDiagonal, std::min(tolerance / 4, diagonal));
    const Job job{mesh,
                  options,
                  find_features(mesh, options.feature_angle_radians, kLeastCurve * wanted),
                  tolerance,
                  spacing,
                  progress};
    double tried = kFirstShare * tolerance;
    for (int repeats = 0; repeats < kMostRemeshings; ++repeats, tried *= kStricter) {
        double length = wanted;
        RemeshResult out = attempt(job, tried, length, interrupter);
        if (is_near(out.report, tolerance)) {
            describe_result(job, out, length, repeats);
            return out;
        }
    }
    RemeshResult out = unchanged(mesh);
    measure(job, out, interrupter);
    describe_result(job, out, wanted, kMostRemeshings);
    return out;
}

} // namespace vdb_shell
