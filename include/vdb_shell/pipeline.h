// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/certify/coverage.h"
#include "vdb_shell/field/contour.h"
#include "vdb_shell/field/given_level_set.h"
#include "vdb_shell/field/level_set.h"
#include "vdb_shell/field/smooth.h"
#include "vdb_shell/field/wrap.h"
#include "vdb_shell/mesh/check_mesh.h"
#include "vdb_shell/shell/grow.h"
#include "vdb_shell/shell/prism_shell.h"
#include "vdb_shell/shell/tessellate.h"
#include "vdb_shell/step/directions.h"
#include "vdb_shell/step/limits.h"
#include "vdb_shell/step/line_step.h"
#include "vdb_shell/write/report.h"

#include <string>

namespace vdb_shell
{

/// The options of every stage, in the order of the data. The command's flags bind to these very
/// fields.
struct ShellOptions {
    WrapOptions wrap;
    ContourOptions contour; ///< for build_shell_from_level_set alone
    CheckOptions check;
    LevelSetOptions level_set;
    SmoothOptions smooth;
    DirectionOptions directions;
    LineStepOptions line_step;
    LimitOptions limits;
    GrowOptions grow;
    SplitOptions split;
    CoverageOptions coverage;
};

/// What the stages made.
struct ShellResult {
    TriangleMesh surface; ///< the input, turned outward when asked, or its wrap
    openvdb::FloatGrid::Ptr level_set;
    Directions directions;
    LineLengths lengths;
    PrismShell shell;
    PrismSplit split;
    TetMesh tets;
    ShellReport report;
};

/// The whole job on a mesh in memory: wrap when asked, check, level set, smooth, directions, line
/// stepping, limits, growth (Method::raw: prisms straight from the lengths), tets, certificate,
/// figures. `name` is what messages and the report call the mesh. `thickness_grid` as in line_step.
/// Throws what the stages throw. Same result for any number of threads (costs in the report aside).
ShellResult build_shell(const TriangleMesh& mesh, const ShellOptions& options,
                        const std::string& name = "mesh",
                        const openvdb::FloatGrid* thickness_grid = nullptr,
                        Interrupter* interrupter = nullptr);

/// The same for the zero surface of a level set: contour first, then as above; lines step through
/// `field` itself when it is fit for that (why_not_steppable), else through a field made anew of
/// the surface; report.field.origin says which. Throws InvalidOption when a wrap is asked for,
/// which is for triangles; GeometryError for a field that is none (require_level_set); and what the
/// stages throw. `field` is not changed.
ShellResult build_shell_from_level_set(const openvdb::FloatGrid& field, const ShellOptions& options,
                                       const std::string& name = "level set",
                                       const openvdb::FloatGrid* thickness_grid = nullptr,
                                       Interrupter* interrupter = nullptr);

/// The options as JSON, as they are stored in a shell's .vdb.
std::string options_json(const ShellOptions& options);

} // namespace vdb_shell
