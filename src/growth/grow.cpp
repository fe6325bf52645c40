// SPDX-License-Identifier: Apache-2.0

// The phases of growth, each in files of its own (docs/growth.md). Every state between two moves is
// a valid shell, so growth can end after any of them: docs/theory.md, "Growth".
//
//   initialise  prepare_directions, start_from_lines, release_pins, lengthen_if_useful
//   prolongate  coarse_levels, start_from_levels, or a refined shell as it is
//   relax       relax_fully: under the twelve-tet test, the three-tet test, or one after the other
//   improve     improve: diagonals, quality, stops

#include "vdb_shell/growth/grow.h"

#include "core/marked.h"
#include "core/stage_progress.h"
#include "growth/attempts.h"
#include "growth/fullest.h"
#include "growth/improve.h"
#include "growth/initialise.h"
#include "growth/lengthen_lines.h"
#include "growth/mend_pins.h"
#include "growth/mend_prolonged.h"
#include "growth/multilevel.h"
#include "growth/pins.h"
#include "growth/prolongate.h"
#include "growth/relax.h"
#include "mesh/curve_order.h"
#include "mesh/surface_defects.h"
#include "vdb_shell/options/option.h"

#include <algorithm>
#include <cassert>
#include <utility>

namespace vdb_shell
{
namespace
{

using namespace growth;

/// A valid shell on the mesh itself.
struct Started {
    StartedFrom from = StartedFrom::lines;
    Directions lines;
    std::vector<double> predicted_gain; ///< RelaxOptions::predicted_gain
};

/// What growth is given, in the order that it goes through the mesh in.
struct Ordered {
    const TriangleMesh& mesh;
    const Directions& directions;
    const std::vector<double>& stepped;
    const std::vector<Vec3s>& inner; ///< GrowStart::inner
    const GrowStart& start;          ///< but for the inner points
    const MeshOrder& order;
};

/// The lines to where the inner points are.
Directions own_lines(const TriangleMesh& mesh, const GrowState& s, Directions lines)
{
    return pillars_to(mesh, shell_of(mesh, s).inner, std::move(lines)).lines;
}

/// Puts a start from mended or planar lines in place of one from levels if it is the fuller one:
/// beside needles a prolonged shell loses most of what it has. Which start rounds get farther from
/// is another question, which attempts answer where they can be afforded.
void take_lines_if_fuller(GrowState& s, const Ordered& given, const GrowOptions& options,
                          const StageProgress& progress, Started& started)
{
    const double enough = std::min(s.schedule.lines.nearly_full, s.schedule.barrier.enough_fill);
    if (fill_of(s) >= enough || !fills_void(s) ||
        !too_large_for_attempts(given.mesh.triangles.size(), options))
        return;
    const Directions lines = prepare_directions(given.mesh, given.directions, options, true);
    for (const LineStart start : {LineStart::planar, LineStart::mended}) {
        GrowState other = make_state(*s.mesh, given.mesh.points, s.cap, s.schedule);
        start_from_lines(other, lines, given.stepped, start, options, progress);
        if (fill_of(other) <= fill_of(s))
            continue;
        s = std::move(other);
        started.lines = own_lines(given.mesh, s, lines);
        started.predicted_gain.clear();
    }
}

Started start_growth(GrowState& s, const Ordered& given, const Attempt& attempt,
                     const GrowResult* restarted, const StageProgress& progress, GrowReport& report)
{
    const GrowOptions& options = attempt.options;
    const bool on_levels = attempt.from == GrowFrom::levels;
    // Smoothing pays where the start is along the lines, not where they are only fallen back on.
    Started started{StartedFrom::lines,
                    prepare_directions(given.mesh, given.directions, options, !on_levels),
                    {}};
    if (on_levels) {
        started.from = StartedFrom::prolonged;
        started.predicted_gain =
            start_from_levels(s, given.mesh, started.lines, given.stepped, given.start.levels,
                              given.order, options, progress, report);
        take_lines_if_fuller(s, given, options, progress, started);
    } else if (attempt.from == GrowFrom::shell) {
        s.twelve = prism_test_of(options) == PrismTest::twelve_tets;
        if (restarted) {
            put_shell(s, restarted->shell, restarted->split.order);
        } else {
            Pillars pillars = pillars_to(given.mesh, given.inner, std::move(started.lines));
            mend_prolonged(s, pillars.lines, pillars.length, progress);
            started.lines = std::move(pillars.lines);
        }
        started.lines = own_lines(given.mesh, s, std::move(started.lines));
    } else {
        start_from_lines(s, started.lines, given.stepped, attempt.start, options, progress);
        if (leaves_lines(attempt.start))
            started.lines = own_lines(given.mesh, s, std::move(started.lines));
    }
    return started;
}

/// What the user calls enough, in place of the schedule's numbers for it.
GrowthSchedule schedule_of(const GrowOptions& options)
{
    GrowthSchedule schedule = options.schedule;
    if (options.enough_fill)
        schedule.barrier.enough_fill = schedule.multilevel.wanted_fill = *options.enough_fill;
    return schedule;
}

/// Such components have no shell then, which always is valid. False if they had none before.
bool pin_components(const Connectivity& connectivity, const std::vector<std::uint8_t>& which,
                    std::vector<double>& cap)
{
    bool any = false;
    for (std::size_t v = 0; v < cap.size(); ++v)
        if (which[std::size_t(connectivity.component[v])] && cap[v] > 0) {
            cap[v] = 0;
            any = true;
        }
    return any;
}

/// What to try instead of a shell some of whose components have turned; false where nothing is
/// left.
bool take_more_care(const Connectivity& connectivity, const std::vector<std::uint8_t>& turned,
                    GrowOptions& options, std::vector<double>& cap)
{
    if (prism_test_of(options) == PrismTest::chosen_tets) {
        options.method = Method::certified;
        options.prism_test = PrismTest::twelve_tets;
    } else if (options.top_down) {
        options.top_down = false; // from a thin shell, which is on the right side
    } else if (options.free_moves) {
        options.free_moves = false; // along lines
    } else {
        return pin_components(connectivity, turned, cap);
    }
    return true;
}

/// One attempt at the shell. `restarted` is what a restart goes on from.
GrowResult grow_once(const Ordered& given, const Connectivity& connectivity,
                     const std::vector<double>& cap, const Attempt& attempt,
                     const GrowResult* restarted, const SplitOptions& split,
                     const StageProgress& progress)
{
    const TriangleMesh& mesh = given.mesh;
    const GrowOptions& options = attempt.options;
    GrowState s = make_state(connectivity, mesh.points, cap, options.schedule);
    GrowResult result;
    GrowReport& report = result.report;
    // Percent. From levels on it is mostly the start that takes time, else the rounds.
    const double started_at = attempt.from == GrowFrom::levels ? 60 : 20, relaxed_at = 90;
    Started started =
        start_growth(s, given, attempt, restarted, progress.part(0, started_at), report);
    report.released += static_cast<std::size_t>(
        release_pins(s, started.lines.visibility, PillarsBesidePin::turned));
    // A prolonged shell has left the lines.
    if (started.from == StartedFrom::lines)
        lengthen_if_useful(s, started.lines, options, progress);
    report.fill_after_lines = fill_of(s);
    if (options.free_moves)
        relax_fully(s, started.from, std::move(started.predicted_gain), started.lines.visibility,
                    options, attempt.rounds, progress.part(started_at, relaxed_at), report);
    // What the start left no pillar to may have room now, as the pillars around it have moved.
    report.released += static_cast<std::size_t>(
        release_last_pins(s, started.lines.visibility, progress.part(relaxed_at, relaxed_at)));
    // A restart has the pins that the shell before it was left with.
    if (!restarted)
        report.released += static_cast<std::size_t>(
            mend_pins(s, started.lines.visibility, progress.part(relaxed_at, relaxed_at)));
    Improved improved =
        improve(s, mesh, given.order, options, split, progress.part(relaxed_at, 100), report);
    result.shell = shell_of(mesh, s);
    result.shell.stop = std::move(improved.stop);
    result.split = std::move(improved.split);
    return result;
}

/// The shell, in the order that the mesh is given in.
GrowResult grow_in_order(const Ordered& given, std::vector<double> cap, GrowOptions options,
                         const SplitOptions& split, Interrupter* interrupter)
{
    const StageProgress progress(interrupter, "grow");
    const TriangleMesh& mesh = given.mesh;
    const Connectivity connectivity = connect(mesh.points.size(), mesh.triangles);
    while (true) {
        const auto grow = [&](const Attempt& attempt, const GrowResult* restarted) {
            return grow_once(given, connectivity, cap, attempt, restarted, split, progress);
        };
        GrowResult result = grow_fullest(given.start, connectivity, cap, options, grow);
        const std::vector<std::uint8_t> turned = turned_components(connectivity, result.shell);
        // A component that crosses itself encloses as much of either sign as it likes.
        const auto crosses_itself = [&] {
            return prism_test_of(options) == PrismTest::twelve_tets &&
                   !find_self_intersections(mesh, {}, interrupter).empty();
        };
        if (marked(turned).empty() || crosses_itself() ||
            !take_more_care(connectivity, turned, options, cap))
            return result;
    }
}

} // namespace

GrowResult grow_shell_from(const GrowStart& start, const TriangleMesh& mesh,
                           const Directions& directions, const LineLengths& stepped,
                           const std::vector<double>& cap, const GrowOptions& wanted,
                           const SplitOptions& split, Interrupter* interrupter)
{
    require_in_range(wanted, "growth");
    assert(wanted.method != Method::raw);
    assert(directions.inward.size() == mesh.points.size());
    assert(stepped.length.size() == mesh.points.size() && cap.size() == mesh.points.size());
    GrowOptions options = wanted;
    options.schedule = schedule_of(wanted);
    const MeshOrder order = curve_order(mesh);
    if (order.own())
        return grow_in_order({mesh, directions, stepped.length, start.inner, start, order}, cap,
                             options, split, interrupter);
    const auto by_vertex = [&](const auto& values) { return values_at(values, order.vertices); };
    const TriangleMesh ordered = in_order(mesh, order);
    const Directions lines{by_vertex(directions.inward), by_vertex(directions.visibility)};
    const std::vector<double> lengths = by_vertex(stepped.length);
    const std::vector<Vec3s> inner = start.inner.empty() ? start.inner : by_vertex(start.inner);
    GrowResult result = grow_in_order({ordered, lines, lengths, inner, start, order},
                                      by_vertex(cap), options, split, interrupter);
    result.shell = shell_out_of_order(result.shell, order);
    result.split.order = out_of_order(result.split.order, order.triangles);
    return result;
}

GrowResult grow_shell(const TriangleMesh& mesh, const Directions& directions,
                      const LineLengths& stepped, const std::vector<double>& cap,
                      const GrowOptions& options, const SplitOptions& split,
                      Interrupter* interrupter)
{
    return grow_shell_from({GrowFrom::levels, {}, coarse_levels(mesh, options, interrupter)}, mesh,
                           directions, stepped, cap, options, split, interrupter);
}

} // namespace vdb_shell
