// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/certify/conformity.h"
#include "vdb_shell/certify/coverage.h"
#include "vdb_shell/certify/overlaps.h"
#include "vdb_shell/certify/stack_certificate.h"
#include "vdb_shell/certify/tet_signs.h"
#include "vdb_shell/field/contour.h"
#include "vdb_shell/field/smooth.h"
#include "vdb_shell/field/wrap.h"
#include "vdb_shell/fill/fill_core.h"
#include "vdb_shell/growth/grow.h"
#include "vdb_shell/growth/refine.h"
#include "vdb_shell/io/read_mesh.h"
#include "vdb_shell/layers/cut_layers.h"
#include "vdb_shell/layers/scale_thickness.h"
#include "vdb_shell/mesh/check_mesh.h"
#include "vdb_shell/obstacles/core_feet.h"
#include "vdb_shell/options/name_table.h"
#include "vdb_shell/pose/pose_shell.h"
#include "vdb_shell/repair/repair_mesh.h"
#include "vdb_shell/resample/decimate.h"
#include "vdb_shell/resample/remesh.h"
#include "vdb_shell/resample/retriangulate.h"
#include "vdb_shell/shell/quality.h"
#include "vdb_shell/shell/sides.h"
#include "vdb_shell/shell/surface_bounds.h"
#include "vdb_shell/step/line_step.h"
#include "vdb_shell/taper/taper.h"
#include "vdb_shell/taper/wanted_bounds.h"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace vdb_shell
{

/// What one stage cost. Peak memory is the process's high-water mark at the stage's end.
struct StageCost {
    std::string stage;
    double seconds = 0;
    std::uint64_t peak_memory_bytes = 0;
};

/// What --mend tries, from the least change to the most; the first that gives a usable surface is
/// taken (docs/stages/repair.md).
enum class Mending : std::uint8_t {
    none,          ///< the surface as it is
    repair,        ///< repair_mesh
    drop_loose,    ///< the same with RepairOptions::drop_loose
    cut_crossings, ///< with RepairOptions::cut_crossings too
    wrap           ///< wrap_mesh
};
const NameTable<Mending>& names(Mending);

struct MendAttempt {
    Mending tried = Mending::none;
    std::string refusal; ///< why no shell can be made of what it gave; empty: it was taken
};

struct FieldReport {
    std::string origin;  ///< what it was made of, in words
    bool sparse = false; ///< a narrow band; deeper voxels only where lines read them
    double voxel_size = 0;
    std::uint64_t active_voxels = 0;
    std::uint64_t memory_bytes = 0;
    double interior_depth = 0; ///< world units, -(smallest value)
    SmoothReport smooth;
};

struct LineReport {
    double min_visibility = 0;
    std::size_t blind_vertices = 0; ///< visibility <= 0
    std::size_t stuck_vertices = 0; ///< length 0
    std::size_t lines = 0;          ///< stepped: growth may begin on a coarser surface's alone
    std::size_t steps = 0;
    std::array<std::size_t, kStopReasonCount> stops{}; ///< vertices by StopReason
    Spread length;                                     ///< world units
    Spread length_voxels;
};

/// One layer of several.
struct LayerFigures {
    std::size_t tets = 0;
    std::size_t pinned_vertices = 0; ///< pillars without length in this layer
    double volume = 0;               ///< sum of signed tet volumes
    Spread length;                   ///< of its part of each pillar, world units
    QualityReport quality;
};

/// The lines outward of a shell on both sides; the report's own lines are then those inward.
struct OutsideReport {
    LineReport lines;
    std::optional<GrowReport> grow;
    std::optional<ScaleReport> scale;
};

/// Everything that is known about one run, as numbers. Names no time of day and no machine.
struct ShellReport {
    std::string source; ///< file name of the surface, without its folder
    std::optional<ReadReport> read;
    std::vector<MendAttempt> mend;      ///< empty when it was not asked for
    std::optional<RepairReport> repair; ///< absent when there was none
    std::optional<WrapReport> wrap;
    std::optional<ContourReport> contour; ///< of a level set that was given
    MeshCheck mesh;                       ///< of the surface that was worked with
    /// Vertices of several fans that got copies (repair/split_fans.h), by the input's index.
    Defect<std::uint32_t> split_vertices;
    std::size_t vertex_copies = 0;
    std::optional<RetriangulateReport> retriangulate;
    std::optional<DecimateReport> decimate;
    std::optional<RemeshReport> remesh;
    std::size_t subdivided_from = 0; ///< triangles before subdivision; 0 when there was none
    FieldReport field;
    Side side = Side::inward;
    LineReport lines;
    std::optional<GrowReport> grow;     ///< absent for Method::raw
    std::optional<ScaleReport> scale;   ///< absent unless the shell was scaled after growth
    std::optional<RefineReport> refine; ///< absent unless rounds of refinement were asked for
    std::optional<OutsideReport> outside;
    std::optional<LayerReport> cut;          ///< absent unless the pillars were cut into layers
    std::optional<TaperReport> taper;        ///< absent unless it was asked for
    std::optional<CoreFillReport> core_fill; ///< likewise
    std::optional<CoreReport> cores;         ///< absent unless there were some
    std::optional<PoseReport> pose;          ///< of a posed shell
    std::vector<LayerFigures> layers;        ///< empty for a single layer
    std::size_t prisms = 0, pinned_vertices = 0, ripples = 0;
    /// Vertices from which no direction sees all their triangles: geometry demands their pins.
    Defect<std::uint32_t> demanded_pins;
    /// Triangles that no tet stands on, all of whose corners are pinned; and how many of them have
    /// three demanded pins.
    Defect<std::uint32_t> triangles_without_tet;
    std::size_t without_tet_demanded = 0;
    TetSigns signs;
    Conformity conformity;
    QualityReport quality;
    SurfaceBounds surface_bounds;
    std::optional<BoundsReport> wanted; ///< absent where nothing was
    double solid_volume = 0;            ///< of the surface, less that of the cores
    double shell_volume = 0;            ///< sum of signed tet volumes
    double outside_volume = 0;          ///< the part of it in layers outside the surface
    double fill = 0; ///< what of shell_volume lies in layers inside / solid_volume
    /// The solid is the surface's own, or with layers outside what the outermost surface encloses.
    Coverage coverage;
    std::optional<StackCertificate> certificate; ///< set by build_shell and build_posed
    /// What holds tet by tet; absent when the shell is certified as a whole.
    std::optional<Overlaps> overlaps;
    std::vector<StageCost> stages;
};

/// The report as JSON text, keys in a fixed order, two-space indent. Angles are given in degrees,
/// in keys that end in `_degrees`. `with_costs` off leaves out seconds and memory, which differ
/// from run to run.
std::string report_json(const ShellReport& report, bool with_costs = true);

/// The report of a posed shell: what `posed` says of its surface, tets and proofs, and for the rest
/// `at_rest`, the JSON report of the shell that was posed. Throws ReadError where that is no JSON
/// object.
std::string posed_report_json(const ShellReport& posed, const std::string& at_rest,
                              bool with_costs = true);

/// What was found wrong with the shell; empty where nothing was.
std::string faults_of(const ShellReport& report);

/// The wishes that the shell does not meet (WantedBounds); empty where it meets all.
std::string unmet_of(const ShellReport& report);

/// The report for a person: some twenty lines.
std::string report_text(const ShellReport& report);
/// Of a posed shell: what posing found and did, tets and proofs.
std::string posed_report_text(const ShellReport& report);

} // namespace vdb_shell
