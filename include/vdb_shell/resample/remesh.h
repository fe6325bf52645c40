// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/core/interrupter.h"
#include "vdb_shell/mesh/triangle_mesh.h"
#include "vdb_shell/options/describe.h"
#include "vdb_shell/resample/surface_distance.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace vdb_shell
{

struct RemeshOptions {
    /// The length that edges get, world units. Unset, as the number below: no remeshing.
    std::optional<double> edge_length;
    /// In place of a length, about how many triangles there shall be, at least 4.
    std::optional<std::size_t> triangles;
    /// The farthest that either surface may be from the other, world units. Unset: how far an edge
    /// of that length is from the surface at most where its middle lies over an edge that is just
    /// no feature edge; half the length times the sine of half the feature angle. So a surface with
    /// edges that sharp can be cut across them.
    std::optional<double> tolerance;
    /// Edges at which the surface turns by more are kept, above 0 and at most 3.14; but for curves
    /// of them shorter than two edge lengths that end in nothing.
    double feature_angle_radians = 1.0471975511965976;

    bool wanted() const { return edge_length || triangles; }
};
OptionList describe(RemeshOptions& options);

/// A place on a surface: the sum of the three corners times their weights.
struct SurfacePoint {
    std::uint32_t triangle = 0;
    openvdb::Vec3I corners{0U};      ///< the triangle's
    std::array<double, 3> weights{}; ///< none is negative, their sum is 1
};

/// Each of two surfaces on the other. Vertices keep their numbers when triangles are cut later
/// (subdivide, refine_triangles), so what the corners say holds then too.
struct RemeshMap {
    /// Of each vertex of the input, its place on the result; it moves with the result's vertices.
    std::vector<SurfacePoint> input_on_result;
    /// Of each vertex of the result, its place on the input.
    std::vector<SurfacePoint> result_on_input;
    /// Where the input's vertices are; filled in by build_shell, whose input is gone afterwards.
    std::vector<openvdb::Vec3s> input_points{};
};

/// How well triangles are shaped and how long their edges are.
struct TriangleFigures {
    double min_angle_radians = 0;      ///< the smallest of all
    double mean_min_angle_radians = 0; ///< mean over triangles of their smallest
    std::size_t under_20_degrees = 0;  ///< triangles with an angle below
    std::size_t under_30_degrees = 0;
    double shortest_edge = 0, mean_edge = 0, longest_edge = 0; ///< world units
};
TriangleFigures triangle_figures(const TriangleMesh& mesh);

struct RemeshReport {
    std::size_t before = 0, triangles = 0;
    std::optional<std::size_t> wanted; ///< triangles
    double edge_length = 0;            ///< the one that was aimed at, world units
    double tolerance = 0;              ///< the one that held, world units
    std::size_t feature_edges = 0, feature_curves = 0, corners = 0; ///< of the input
    TriangleFigures shape_before, shape;
    /// Share of the edges that are 4/5 to 4/3 of what was aimed at.
    double edges_in_range = 0;
    DistanceFigures input_to_result, result_to_input;
    int repeats = 0;         ///< how often all was done anew, for the surfaces were too far apart
    bool kept_input = false; ///< no other surface was within the tolerance
};

struct RemeshResult {
    TriangleMesh mesh;
    RemeshMap map;
    RemeshReport report;
};

/// Throws InvalidOption when an option is out of its range, or both length and number are given.
void require_sensible(const RemeshOptions& options);

/// The surface in triangles as nearly equilateral and of one size as can be had (Botsch and Kobbelt
/// 2004, "A remeshing approach to multiresolution modeling"): edges are split, collapsed and
/// flipped, and vertices moved over the input. Feature edges stay on the input's; where two of
/// them end or turn there is a corner, which keeps its bits. Where tolerance or features ask for
/// shorter edges, these are shorter, and their size changes gradually from there. The result is
/// closed, manifold, consistently oriented, embedded and of the same topology as the input, by
/// exact tests of each operation. The distance is measured afterwards, both ways
/// (surface_distance); where it exceeds the tolerance triangles are cut; where that does not do all
/// is done anew with a smaller one; the last resort is the input itself. Same result for any number
/// of threads. Throws what require_sensible throws, and InvalidOption where neither length nor
/// number is given, and for 2^30 triangles or more than free memory has room for, before any work;
/// GeometryError for a surface that is not closed, manifold, oriented and embedded; Cancelled.
RemeshResult remesh(const TriangleMesh& mesh, const RemeshOptions& options,
                    Interrupter* interrupter = nullptr);

} // namespace vdb_shell
