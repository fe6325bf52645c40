// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/certify/coverage.h"
#include "vdb_shell/field/contour.h"
#include "vdb_shell/field/given_level_set.h"
#include "vdb_shell/field/level_set.h"
#include "vdb_shell/field/narrow_band.h"
#include "vdb_shell/field/smooth.h"
#include "vdb_shell/field/wrap.h"
#include "vdb_shell/fill/fill_core.h"
#include "vdb_shell/growth/grow.h"
#include "vdb_shell/growth/refine.h"
#include "vdb_shell/layers/cut_layers.h"
#include "vdb_shell/layers/scale_thickness.h"
#include "vdb_shell/mesh/check_mesh.h"
#include "vdb_shell/obstacles/core_feet.h"
#include "vdb_shell/obstacles/cores.h"
#include "vdb_shell/obstacles/join_cores.h"
#include "vdb_shell/options/describe.h"
#include "vdb_shell/pose/pose_shell.h"
#include "vdb_shell/repair/repair_mesh.h"
#include "vdb_shell/report/report.h"
#include "vdb_shell/resample/decimate.h"
#include "vdb_shell/resample/remesh.h"
#include "vdb_shell/resample/retriangulate.h"
#include "vdb_shell/resample/subdivide.h"
#include "vdb_shell/shell/shell_stack.h"
#include "vdb_shell/shell/sides.h"
#include "vdb_shell/step/directions.h"
#include "vdb_shell/step/limits.h"
#include "vdb_shell/step/line_step.h"
#include "vdb_shell/taper/taper.h"
#include "vdb_shell/taper/wanted_bounds.h"
#include "vdb_shell/write/vdb_file.h"

#include <optional>
#include <string>
#include <vector>

namespace vdb_shell
{

/// The options of every stage, in the order of the data. The command's flags bind to these very
/// fields.
struct ShellOptions {
    /// Where the shell lies. Outward lines without any thickness of the user's get
    /// default_outward_thickness.
    Side side = Side::inward;
    /// A surface of which no shell can be made is repaired, and wrapped where that is not enough; a
    /// usable one is taken as it is. With `repair`, what a repair gives is.
    bool mend = false;
    /// Unset: the surface is taken as it is, or refused. Allowed self-intersections keep crossing
    /// fills too.
    std::optional<RepairOptions> repair;
    WrapOptions wrap;
    ContourOptions contour; ///< for build_shell_from_level_set alone
    CheckOptions check;
    RetriangulateOptions retriangulate;
    DecimateOptions decimate;
    RemeshOptions remesh;
    SubdivideOptions subdivide;
    CoreOptions cores; ///< for runs that are given cores
    LevelSetOptions level_set;
    /// Sparse: the level set is a narrow band, and deeper voxels are computed where lines read them
    /// (line_step_sparse). Dense all the same, with the reason in report.field.origin, for lines
    /// outward, smoothing, a band of a given depth, a surface that crosses itself and a given level
    /// set that lines can step through.
    FieldRoute field = FieldRoute::automatic;
    SmoothOptions smooth;
    DirectionOptions directions;
    LineStepOptions line_step;
    LimitOptions limits;
    GrowOptions grow;
    RefineOptions refine;
    ScaleOptions scale;
    LayerOptions layers;
    TaperOptions taper;
    /// Tapering is run towards them; without it they are only checked.
    WantedBounds wanted;
    CoreFillOptions core_fill;
    SplitOptions split;
    CoverageOptions coverage;
};
/// A section for each stage, with the names that the fields above have.
OptionSections describe(ShellOptions& options);

/// Throws InvalidOption for an option out of its range, and for options that contradict each other
/// whatever the surface. `thickness_grid`: there will be one.
void require_sensible(const ShellOptions& options, bool thickness_grid = false);

/// Throws InvalidOption for options with which there can be no cores.
void require_cores_possible(const ShellOptions& options);

/// The lines of one side, towards which they grow: Directions::inward of an outward line is the
/// surface's outward direction.
struct SideLines {
    Directions directions;
    LineLengths lengths;
};

/// What the stages made.
struct ShellResult {
    /// The input, repaired and turned outward when asked, with copies of vertices of several fans
    /// where self-intersections are allowed.
    TriangleMesh surface;
    /// Where the surface was remeshed: the surface before that, and this one.
    std::optional<RemeshMap> remesh_map;
    FloatGridPtr level_set;
    Directions directions; ///< of the side that the shell lies on; of both sides, inward
    /// Likewise. StopReason::none where no line was stepped: growth that begins on coarser surfaces
    /// has no use for more than those of the coarsest.
    LineLengths lengths;
    std::optional<SideLines> outside; ///< the lines outward, where the shell lies on both sides
    ShellStack stack;                 ///< one layer a side unless more were asked for
    TetMesh tets;
    std::optional<Cores> cores;      ///< where some were given
    std::vector<CoreFoot> core_feet; ///< likewise, by vertex of the surface
    /// Up to the certificate surface, directions, lengths and stack have the cores too, as vertices
    /// that are pinned; in the result they have not, and this is empty.
    VertexRange core_vertices;
    std::optional<CoreTets> core; ///< what fills the rest of the solid, where it was asked for
    ShellReport report;
};

/// The whole job on a mesh in memory: wrap, repair or mend when asked, check, retriangulate,
/// decimate, remesh and subdivide when asked, level set, smooth, directions, line stepping, limits,
/// growth (Method::raw: prisms straight from the lengths), scale, layers, taper when asked, tets,
/// certificate, overlaps (where it does not certify the whole), figures. For an outward shell the
/// stages from directions to scale run on the reversed surface (shell/sides.h), for both sides once
/// for each. `name` is what messages and the report call the mesh. `thickness_grid` as in
/// line_step. `cores` are closed surfaces inside, which the shell ends on or before; those of a run
/// with cores are a grown shell inside an embedded surface (else InvalidOption). Throws what the
/// stages throw. Same result for any number of threads (costs in the report aside).
ShellResult build_shell(const TriangleMesh& mesh, const ShellOptions& options,
                        const std::string& name = "mesh",
                        const openvdb::FloatGrid* thickness_grid = nullptr,
                        Interrupter* interrupter = nullptr,
                        const std::vector<CoreMesh>& cores = {});

/// The same for the zero surface of a level set: contour first, then as above; lines step through
/// `field` itself when it is fit for that (why_not_steppable), else through a field made anew of
/// the surface; report.field.origin says which. Throws InvalidOption when a wrap is asked for,
/// which is for triangles; GeometryError for a field that is none (require_level_set); and what the
/// stages throw. `field` is not changed.
ShellResult build_shell_from_level_set(const openvdb::FloatGrid& field, const ShellOptions& options,
                                       const std::string& name = "level set",
                                       const openvdb::FloatGrid* thickness_grid = nullptr,
                                       Interrupter* interrupter = nullptr,
                                       const std::vector<CoreMesh>& cores = {});

/// A posed shell with what was proven and measured of it.
struct PosedShell {
    ShellStack stack;
    CoreTets core;
    TetMesh tets;
    PointVectors velocity; ///< for posed_file; empty unless the caller sets it
    /// Only surface, tets, proofs, pose and costs are filled in.
    ShellReport report;
};

/// The shell at rest on its surface in another pose (pose_shell), certified and measured. `name` is
/// what messages call the pose. Throws what pose_shell throws, and GeometryError where the pose
/// puts two points into one place, so that the tets would not be those at rest. Same result for any
/// number of threads.
PosedShell build_posed(const RestShell& rest, const std::vector<openvdb::Vec3s>& skin,
                       const PoseOptions& options, const std::string& name = "pose",
                       Interrupter* interrupter = nullptr);

/// The same of what pose_shell has made for `skin`.
PosedShell finish_posed(const RestShell& rest, const std::vector<openvdb::Vec3s>& skin,
                        PoseResult pose, const std::string& name = "pose",
                        Interrupter* interrupter = nullptr);

/// Of the points of one shell in two poses, `seconds` apart: world units a second. Throws
/// InvalidOption for a number of seconds that is not positive and finite. Precondition: poses of
/// the same shell.
PointVectors point_velocities(const PoseResult& before, const PoseResult& after, double seconds);

/// All that the .vdb of a posed shell holds; `rest` is that of the shell at rest. Without
/// `with_volumes` the grids are null; else they have rest.surface's voxel size. Throws
/// InvalidOption where volumes are wanted and rest.surface is null; what level sets throw;
/// ReadError where the report in `rest` is no JSON object; Cancelled.
ShellFile posed_file(const ShellFile& rest, PosedShell posed, bool with_volumes,
                     Interrupter* interrupter = nullptr);

/// The options as JSON, as they are stored in a shell's .vdb.
std::string options_json(const ShellOptions& options);

/// `base` with what the JSON object says, which may be a part of what options_json writes. Throws
/// ReadError for a text that is no JSON object, InvalidOption for a key that is none and a value
/// that is impossible; messages open with `name`, the file.
ShellOptions options_from_json(const std::string& json, ShellOptions base = {},
                               const std::string& name = "options");

} // namespace vdb_shell
