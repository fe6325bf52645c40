// SPDX-License-Identifier: Apache-2.0
// Steps a line inward from each vertex until its stop test fails, and leaves the length, the number
// of steps and the reason for each. This is the method of K. Erleben and J. Sporring,
// "Line-Stepping for Shell Meshes"; docs/stages/line_stepping.md lists the tests. Two routes share
// everything but the field: the dense one reads a grid, the sparse one a narrow band whose deeper
// voxels are computed when they are read. A line writes its own entries only, so the lengths are
// the same for any number of threads.

#include "vdb_shell/step/line_step.h"

#include "core/parallel.h"
#include "core/stage_progress.h"
#include "field/deep_field.h"
#include "field/field_sampler.h"
#include "step/march.h"
#include "step/most_radians.h"
#include "step/skip_ahead.h"
#include "step/thickness.h"
#include "vdb_shell/core/error.h"
#include "vdb_shell/options/option.h"

#include <tbb/enumerable_thread_specific.h>

#include <cassert>
#include <memory>
#include <utility>

namespace vdb_shell
{

namespace
{

// Bisection ends at a thousandth of a voxel, which is far below what the grid can resolve.
constexpr double kIntervalVoxels = 1.0 / 1024;
// A line that is not inside after this many voxels never will be.
constexpr double kEntryVoxels = 1.5;
constexpr double kSmallestStepVoxels = 1e-3;
// On a crease of the field the interpolated slope swings with the position in the cell (between
// 0.65 and 0.87 on a box's diagonal). Along one cell diagonal every phase has been seen.
constexpr double kPeriodVoxels = 1.7320508;
// Vertices between two looks at the interrupter.
constexpr std::size_t kBlock = 4096;

MarchRules rules_of(const TriangleMesh& mesh, const openvdb::FloatGrid& level_set,
                    const LineStepOptions& options)
{
    const double voxel = level_set.voxelSize()[0];
    MarchRules rules;
    rules.test = options.test;
    rules.rho = options.rho;
    rules.sheet_cosine = std::cos(options.sheet_angle_radians);
    rules.step = options.step_voxels * voxel;
    rules.distance_threshold = options.distance_threshold_voxels * voxel;
    rules.reference = options.reference_voxels * voxel;
    rules.period = kPeriodVoxels * voxel;
    rules.entry = kEntryVoxels * voxel;
    // No point of a solid is farther from its surface than half the diagonal of its bounding box,
    // so bisection on the depth needs to look no deeper.
    rules.search_depth = 0.5 * diagonal_of(bounds_of(mesh.points));
    rules.interval = kIntervalVoxels * voxel;
    rules.bisection_iterations = options.bisection_iterations;
    return rules;
}

/// What both routes are given.
struct Job {
    const TriangleMesh& mesh;
    const openvdb::FloatGrid& level_set;
    const Directions& directions;
    const LineStepOptions& options;
    const openvdb::FloatGrid* thickness_grid;
    Interrupter* interrupter;
    const std::vector<std::uint32_t>* only;
};

/// Throws unless options and level set are fit for stepping.
void require_steppable(const Job& job)
{
    require_in_range(job.options, "line step");
    assert(job.directions.inward.size() == job.mesh.points.size());
    if (!job.level_set.hasUniformVoxels())
        throw GeometryError("line step: the level set '" + job.level_set.getName() +
                            "' has voxels of different sizes along the axes");
}

/// run(begin, end) for ranges of `lines`. The interrupter may be used from the stage's own thread
/// only, so the work is cut into blocks and it is polled between them.
template <typename Run>
void for_each_block(std::size_t lines, const StageProgress& progress, const Run& run)
{
    for (std::size_t block = 0; block < lines; block += kBlock) {
        progress.stop_if_interrupted(static_cast<int>(100 * block / lines));
        for_each_range(
            std::min(kBlock, lines - block),
            [&](std::size_t begin, std::size_t end) { run(block + begin, block + end); }, 16);
    }
}

/// `make_stepper(rules)` gives what steps the lines of a range: step(range, line_of, store).
template <typename MakeStepper>
LineLengths step_all(const Job& job, const MakeStepper& make_stepper)
{
    const StageProgress progress(job.interrupter, "line step");
    require_steppable(job);
    const std::size_t count = job.mesh.points.size();
    LineLengths lengths{std::vector<double>(count), std::vector<std::uint32_t>(count),
                        std::vector<StopReason>(count, StopReason::none)};
    if (count == 0)
        return lengths;
    const MarchRules rules = rules_of(job.mesh, job.level_set, job.options);
    const std::vector<double> thickest = largest_lengths(job.mesh, job.options, job.thickness_grid);
    std::vector<double> own_slopes(count, 1.0);
    if (job.options.test == StopTest::own_sheet)
        own_slopes = own_sheet_slopes(job.mesh, job.directions);
    const auto vertex = [&](std::size_t i) { return job.only ? (*job.only)[i] : i; };
    const auto line_of = [&](std::size_t i) {
        const std::size_t v = vertex(i);
        return Line{openvdb::Vec3d(job.mesh.points[v]), job.directions.inward[v], thickest[v],
                    own_slopes[v]};
    };
    const auto store = [&](std::size_t i, const LineEnd& end) {
        const std::size_t v = vertex(i);
        lengths.length[v] = end.length;
        lengths.steps[v] = end.steps;
        lengths.reason[v] = end.reason;
    };
    const auto step = make_stepper(rules);
    for_each_block(
        job.only ? job.only->size() : count, progress,
        [&](std::size_t begin, std::size_t end) { step(std::pair(begin, end), line_of, store); });
    return lengths;
}

} // namespace

const NameTable<StopTest>& names(StopTest)
{
    static const NameTable<StopTest> table{{"none", StopTest::none},
                                           {"normal", StopTest::normal},
                                           {"start-gradient", StopTest::start_gradient},
                                           {"distance", StopTest::distance},
                                           {"bisection", StopTest::bisection},
                                           {"relative-normal", StopTest::relative_normal},
                                           {"own-sheet", StopTest::own_sheet}};
    return table;
}

OptionList describe(LineStepOptions& o)
{
    return in_group(
        "Lines",
        {option("test", o.test, "--stop-test", "When a line stops"),
         option("rho", o.rho, "--rho", "Threshold of the normal tests, a cosine")
             .needing("--stop-test normal start-gradient relative-normal")
             .within(at_least(0).below(1)),
         option("step_voxels", o.step_voxels, "--step", "Increment along a line, voxels")
             .in(Unit::voxels)
             .within(at_least(kSmallestStepVoxels)),
         option("distance_threshold_voxels", o.distance_threshold_voxels, "--distance-threshold",
                "Threshold of the distance test and of bisection, voxels")
             .needing("--stop-test distance bisection")
             .in(Unit::voxels)
             .within(above(0)),
         option("bisection_iterations", o.bisection_iterations, "--bisection-iterations",
                "Iteration limit of bisection")
             .needing("--stop-test bisection")
             .in(Unit::count)
             .within(at_least(1)),
         option("reference_voxels", o.reference_voxels, "--reference",
                "Where relative-normal and own-sheet begin to compare, voxels from the start")
             .needing("--stop-test relative-normal own-sheet")
             .in(Unit::voxels)
             .within(above(0)),
         option("sheet_angle_radians", o.sheet_angle_radians, "--sheet-angle",
                "own-sheet: surfaces that meet at less than this are one, radians")
             .needing("--stop-test own-sheet")
             .in(Unit::radians)
             .within(above(0).below(kMostRadians)),
         option("thickness", o.thickness, "--thickness",
                "Largest length of any line, world units [outward: a tenth of the diagonal]")
             .in(Unit::world_length)
             .within(above(0))});
}

const char* name_of(StopReason reason)
{
    switch (reason) {
    case StopReason::none:
        return "none";
    case StopReason::stop_test:
        return "stop_test";
    case StopReason::thickness:
        return "thickness";
    case StopReason::limit:
        return "limit";
    case StopReason::left_solid:
        return "left_solid";
    case StopReason::left_band:
        return "left_band";
    case StopReason::no_direction:
        return "no_direction";
    case StopReason::converged:
        return "converged";
    case StopReason::iterations:
        return "iterations";
    case StopReason::prism:
        return "prism";
    case StopReason::inner_contact:
        return "inner_contact";
    case StopReason::outer_contact:
        return "outer_contact";
    case StopReason::pinned:
        return "pinned";
    case StopReason::core:
        return "core";
    case StopReason::not_asked:
        return "not_asked";
    }
    assert(false && "a stop reason without a name");
    return "";
}

LineLengths line_step(const TriangleMesh& mesh, const openvdb::FloatGrid& level_set,
                      const Directions& directions, const LineStepOptions& options,
                      const openvdb::FloatGrid* thickness_grid, Interrupter* interrupter,
                      const std::vector<std::uint32_t>* only)
{
    const Job job{mesh, level_set, directions, options, thickness_grid, interrupter, only};
    return step_all(job, [&](const MarchRules& rules) {
        return [&](const auto& range, const auto& line_of, const auto& store) {
            FieldSampler field(level_set);
            for (std::size_t v = range.first; v < range.second; ++v)
                store(v, step_one(field, line_of(v), rules));
        };
    });
}

LineLengths line_step_sparse(const TriangleMesh& mesh, const openvdb::FloatGrid& narrow_band,
                             const Directions& directions, const LineStepOptions& options,
                             const openvdb::FloatGrid* thickness_grid, Interrupter* interrupter,
                             const std::vector<std::uint32_t>* only, const TriangleMesh* far)
{
    const Job job{mesh, narrow_band, directions, options, thickness_grid, interrupter, only};
    return step_all(job, [&](const MarchRules& rules) {
        const auto deep = std::make_shared<const DeepField>(far ? *far : mesh, narrow_band);
        const SkipAhead skip(*deep, 2 * rules.search_depth);
        // A thread remembers the deep voxels that it has computed, from one block to the next. They
        // are a pure function of the mesh, so this saves time and changes no length.
        using PerThread = tbb::enumerable_thread_specific<DeepSampler>;
        const auto fields = std::make_shared<PerThread>(
            [deep] { return DeepSampler(deep->band().transform(), DeepVoxels(*deep)); });
        return [&rules, deep, skip, fields](const auto& range, const auto& line_of,
                                            const auto& store) {
            DeepSampler& field = fields->local();
            for (std::size_t v = range.first; v < range.second; ++v)
                store(v, step_one(field, line_of(v), rules, skip));
        };
    });
}

} // namespace vdb_shell
