// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/core/grid_types.h"
#include "vdb_shell/core/interrupter.h"
#include "vdb_shell/mesh/triangle_mesh.h"
#include "vdb_shell/options/describe.h"
#include "vdb_shell/step/directions.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace vdb_shell
{

/// When a line stops. g(q) is the gradient of the field at q: central differences of the grid,
/// interpolated trilinearly and not normalised, as the paper's authors compute it; n = -inward.
enum class StopTest {
    none,            ///< never by the field, which is not read: thickness or infinity, then limits
    normal,          ///< eq. 10: go on while g(q) . n > rho
    start_gradient,  ///< eq. 7: go on while g(q) . g(p) > rho
    distance,        ///< eq. 8: go on while |e + phi(q)| < distance_threshold_voxels
    bisection,       ///< eq. 1 by bisection on e = -phi(q): the paper's baseline
    relative_normal, ///< go on while g(q) . n > rho * s0, where s0 is the smallest slope g . n over
                     ///< one cell diagonal from reference_voxels on; up to there while g . n > 0
    own_sheet,       ///< go on while g(q) . n is what the vertex's own triangles make it, up to
               ///< sheet_angle_radians: see own_sheet_slopes; up to reference_voxels while > 0
};
const NameTable<StopTest>& names(StopTest);

/// Why a line ended where it did.
enum class StopReason : std::uint8_t {
    none,          ///< not stepped; after growth: nothing single holds the vertex
    stop_test,     ///< the stop test failed
    thickness,     ///< reached the user's thickness
    limit,         ///< reached a thin-shell limit
    left_solid,    ///< phi became positive: the line left the solid again
    left_band,     ///< reached the depth of the grid's interior band
    no_direction,  ///< no usable direction at this vertex
    converged,     ///< bisection closed its interval
    iterations,    ///< bisection hit its iteration limit
    prism,         ///< growth: a tet of a prism would not stay positive
    inner_contact, ///< growth: the inner surface would touch itself
    outer_contact, ///< growth: the inner surface would touch the outer one
    pinned,        ///< growth: no valid length at all
    core,          ///< the finished pillar ended at a core (obstacles/core_feet.h)
    not_asked,     ///< growth: not pinned, shorter than allowed, and nobody wanted to know why
                   ///< (GrowOptions::stop_reasons)
};
inline constexpr int kStopReasonCount = 15;

/// Name for reports: "stop_test", "thickness", ...
const char* name_of(StopReason reason);

struct LineStepOptions {
    StopTest test = StopTest::normal;
    /// rho = cos(alpha) of eq. 10 and 11; the paper uses 0.9 (alpha = 0.4363 radians).
    double rho = 0.9;
    /// Increment along the line; 0.5 is eq. 6.
    double step_voxels = 0.5;
    /// Eq. 8's threshold; also bisection's, on |e + phi|.
    double distance_threshold_voxels = 1.0;
    int bisection_iterations = 1000;
    /// relative_normal measures its reference slope s0 from this distance on, where the stencil is
    /// clear of the start, over sqrt(3) voxels (own_sheet begins here): on a crease of the field
    /// the interpolated slope swings with the position in the cell, and s0 has to be its low.
    double reference_voxels = 1.5;
    /// own_sheet takes parts of the surface that meet at less than this angle for one smooth part:
    /// their symmetry sheets do not stop a line.
    double sheet_angle_radians = 0.1745;
    /// Largest length of any line, world units (epsilon_user of eq. 1). Unset: no such bound.
    std::optional<double> thickness;
};
OptionList describe(LineStepOptions& options);

/// One entry per vertex.
struct LineLengths {
    std::vector<double> length; ///< world units, >= 0; 0 = the vertex stays where it is
    std::vector<std::uint32_t> steps;
    std::vector<StopReason> reason;
};

/// Per vertex, how fast the distance to the planes and edges of its own triangles grows along its
/// direction, if they went on for ever: 1 on a flat or hollow surface, the cosine of the angle to
/// the steepest triangle on a ridge or corner. While nothing else is nearer, -phi at length e is e
/// times this, and the line walks along the crease's own symmetry sheet (the paper, figure 2c).
/// Not positive where the direction leaves the solid; 0 where there is no direction.
std::vector<double> own_sheet_slopes(const TriangleMesh& mesh, const Directions& directions);

/// Steps from every vertex inward along its direction, in parallel over VDB samplers.
/// `thickness_grid` (may be null): a float grid of largest lengths, sampled at each vertex; a
/// negative or non-finite sample throws GeometryError with the vertex. The first look at the field
/// is one step from the vertex. Throws InvalidOption when an option is out of its range,
/// GeometryError when the level set's voxels are not uniform, Cancelled. Guarantee: length <=
/// thickness and <= the sampled thickness; same bits for any number of threads. Cost: O(V N),
/// eq. 12. `only` (may be null): the vertices to step from, without duplicates; the others get
/// length 0, no steps and StopReason::none.
LineLengths line_step(const TriangleMesh& mesh, const openvdb::FloatGrid& level_set,
                      const Directions& directions, const LineStepOptions& options,
                      const openvdb::FloatGrid* thickness_grid = nullptr,
                      Interrupter* interrupter = nullptr,
                      const std::vector<std::uint32_t>* only = nullptr);

/// The same lengths from a narrow band alone (mesh_to_narrow_band of this very mesh): voxels deeper
/// than the band are computed where a line reads them, each minus its distance to the mesh, to a
/// hundredth of a voxel; and where nearest points prove that the test holds, lines skip ahead.
/// Guarantees and exceptions as above. Cost: a tree over the triangles, and a few nearest points
/// and stencils for each line. `far` (may be null, then the mesh): the surface that distances
/// beyond the band are measured to, for lines of few vertices of a mesh of many triangles.
LineLengths line_step_sparse(const TriangleMesh& mesh, const openvdb::FloatGrid& narrow_band,
                             const Directions& directions, const LineStepOptions& options,
                             const openvdb::FloatGrid* thickness_grid = nullptr,
                             Interrupter* interrupter = nullptr,
                             const std::vector<std::uint32_t>* only = nullptr,
                             const TriangleMesh* far = nullptr);

} // namespace vdb_shell
