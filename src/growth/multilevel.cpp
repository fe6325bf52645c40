// SPDX-License-Identifier: Apache-2.0

// Takes: a surface of many triangles. Leaves: a valid shell on it that is nearly as thick as it
// will get, for a fraction of the cost of growing it there: the volume is won on a surface of a
// thousand triangles, where a round is cheap and a vertex goes far in one, and prolonged over some
// surfaces in between. Each of them is grown as the whole would be, through valid states only.
// Source: nested iteration, as in Brandt 1977, "Multi-level adaptive solutions to boundary-value
// problems".

#include "growth/multilevel.h"

#include "growth/active_set.h"
#include "growth/group_shares.h"
#include "growth/initialise.h"
#include "growth/mend_prolonged.h"
#include "growth/move_groups.h"
#include "growth/pins.h"
#include "growth/prolongate.h"
#include "growth/relax.h"
#include "growth/relax_options.h"
#include "mesh/curve_order.h"
#include "vdb_shell/mesh/normals.h"
#include "vdb_shell/resample/coarsen.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace vdb_shell
{
namespace growth
{
namespace
{

using openvdb::Vec3d;

/// Lines of a level: its own pseudo-normals, for the level set's gradient is known at the vertices
/// of the mesh alone. Smoothing pays where the start is along the lines, not where they are only
/// fallen back on.
Directions lines_of_level(const TriangleMesh& mesh, const GrowOptions& options, StartedFrom from)
{
    return prepare_directions(mesh, directions_along(mesh, pseudo_normals(mesh)), options,
                              from == StartedFrom::lines);
}

/// By level, its vertices as those of the mesh.
std::vector<std::vector<std::uint32_t>> vertices_of(const std::vector<Coarsened>& levels)
{
    std::vector<std::vector<std::uint32_t>> from;
    from.reserve(levels.size());
    for (const Coarsened& level : levels)
        from.push_back(from.empty() ? level.from : values_at(from.back(), level.from));
    return from;
}

/// A pin on a coarse surface says little about a finer one. So that it holds nobody back there, its
/// inner point goes to the middle of those beside it.
void lift_pins(GrowState& s)
{
    for (int v = 0; v < s.mesh->vertices; ++v) {
        if (!s.pinned[v])
            continue;
        Vec3d sum(0.0);
        int count = 0;
        for (const int u : neighbours(*s.mesh, v))
            if (!s.pinned[u])
                sum += s.b[u], ++count;
        if (count > 0)
            s.b[v] = sum / count;
    }
}

// Percent of a level's time at which mending ends, and with it the groups: of a scan's 1,120,000
// triangles, for progress that moves evenly.
constexpr double kMendedAt = 40, kGroupsAt = 60;

/// What stays the same over all levels, and how far the one at hand is.
struct LevelJob {
    std::size_t triangles; ///< of the whole surface
    const GrowOptions& options;
    const StageProgress progress; ///< of the level
};

/// By level, how much of all work is done with it, in percent, if work goes by triangles. After the
/// last in the list, which comes first, is what has been done before it: nothing.
std::vector<double> ends_of_levels(const std::vector<Coarsened>& levels, std::size_t triangles)
{
    double all = double(triangles), done = 0;
    for (const Coarsened& level : levels)
        all += double(level.mesh.triangles.size());
    std::vector<double> ends(levels.size() + 1, 0.0);
    for (std::size_t i = levels.size(); i-- > 0;) {
        done += double(levels[i].mesh.triangles.size());
        ends[i] = 100 * done / all;
    }
    return ends;
}

/// Prolongs the shell of a coarser surface onto the state of a finer one, mends it, and fills the
/// voids that mending has left by moves of as many vertices as the coarser surface has one for.
std::vector<double> start_from_coarser(GrowState& s, const TriangleMesh& mesh,
                                       const Directions& lines, const TriangleMesh& coarser,
                                       const std::vector<Vec3d>& coarser_inner, const LevelJob& job,
                                       GrowReport& report)
{
    const MultilevelSchedule& schedule = s.schedule.multilevel;
    // Of the prisms that fail the twelve-tet test when they are prolonged, 97 in 100 have diagonals
    // with which they pass the other (docs/measurements/tried.md): then mending loses less than
    // half as much.
    s.twelve = prism_test_of(job.options) == PrismTest::twelve_tets;
    const std::vector<CoarsePoint> nearest = nearest_coarse_points(mesh, coarser, schedule);
    const Pillars pillars =
        prolonged_pillars(coarser, coarser_inner, mesh, *s.mesh, s.cap, nearest, lines, schedule);
    std::vector<double> lost =
        mend_prolonged(s, pillars.lines, pillars.length, job.progress.part(0, kMendedAt));
    // Before the groups, which win back what shorter pillars beside a pin cost.
    report.released += static_cast<std::size_t>(
        s.twelve ? release_pins(s, lines.visibility, PillarsBesidePin::shortened)
                 : release_last_pins(s, lines.visibility, job.progress.part(kMendedAt, kMendedAt)));
    move_groups(s, group_shares(coarser, nearest), job.progress.part(kMendedAt, kGroupsAt));
    return lost;
}

/// More is wanted of a level than of the whole: mending on the finer surfaces loses some of what it
/// has won, and to win that there costs more.
GrowthSchedule schedule_of_level(GrowthSchedule schedule)
{
    double& enough = schedule.barrier.enough_fill;
    enough = 1 - schedule.multilevel.level_void_share * (1 - enough);
    return schedule;
}

/// What has been grown on a level.
struct LevelShell {
    std::vector<Vec3d> inner; ///< which growth has not finished
    double fill;
};

/// Grows on one level, from what start(state, lines) makes a valid shell.
template <class Start>
LevelShell grow_on_level(const TriangleMesh& mesh, const std::vector<double>& cap, StartedFrom from,
                         const LevelJob& job, const Start& start)
{
    const Directions lines = lines_of_level(mesh, job.options, from);
    const Connectivity connectivity = connect(mesh.points.size(), mesh.triangles);
    GrowState s =
        make_state(connectivity, mesh.points, cap, schedule_of_level(job.options.schedule));
    // A level's shell is valid by itself, but nothing reads it except the next prolongation.
    GrowReport ignored;
    start(s, lines, ignored);
    const auto rounds = [&] {
        relax(s, lines.visibility, job.options, relax_coarse(s, from, job.triangles),
              job.progress.part(kGroupsAt, 100), ignored);
    };
    rounds();
    // On the coarsest surface alone: the others are under it from the start.
    if (prism_test_of(job.options) == PrismTest::chosen_tets && s.twelve) {
        test_three_tets(s);
        rounds();
    }
    const double fill = fill_of(s);
    lift_pins(s);
    return {std::move(s.b), fill};
}

/// Grows on the coarsest level: from lines, and again from mended and planar ones where that leads
/// into a corner, as it does beside needles.
std::vector<Vec3d> grow_coarsest(const TriangleMesh& mesh, const std::vector<double>& cap,
                                 const std::vector<double>& stepped, const LevelJob& job)
{
    const auto grown_from = [&](LineStart start) {
        return grow_on_level(mesh, cap, StartedFrom::lines, job,
                             [&](GrowState& s, const Directions& lines, GrowReport&) {
                                 start_from_lines(s, lines, stepped, start, job.options,
                                                  job.progress);
                             });
    };
    const GrowthSchedule& schedule = job.options.schedule;
    const double enough = std::min(schedule.lines.nearly_full, schedule.barrier.enough_fill);
    LevelShell fullest = grown_from(LineStart::shrunk);
    for (const LineStart start : {LineStart::planar, LineStart::mended}) {
        if (fullest.fill >= enough || bounds_thickness(cap))
            break;
        LevelShell other = grown_from(start);
        // More than the whole is what a surface encloses that has turned inside out.
        if (other.fill > fullest.fill && other.fill <= 1)
            fullest = std::move(other);
    }
    return std::move(fullest.inner);
}

/// On coarser surfaces too, rounds around a crowd would take the square of it.
bool has_large_fans(const TriangleMesh& mesh)
{
    std::vector<std::size_t> triangles(mesh.points.size());
    for (const openvdb::Vec3I& t : mesh.triangles)
        for (int k = 0; k < 3; ++k)
            ++triangles[t[k]];
    FanWork work;
    for (const std::size_t n : triangles)
        work.add(n);
    return work.too_much();
}

bool wants_levels(const TriangleMesh& mesh, const GrowOptions& options)
{
    return options.coarse_from > 0 && mesh.triangles.size() >= options.coarse_from &&
           options.top_down && options.free_moves &&
           signed_volume(mesh.points, mesh.triangles) > 0 && !has_large_fans(mesh);
}

} // namespace

std::vector<double> start_from_levels(GrowState& s, const TriangleMesh& mesh,
                                      const Directions& lines, const std::vector<double>& stepped,
                                      const std::vector<Coarsened>& levels, const MeshOrder& order,
                                      const GrowOptions& options, const StageProgress& progress,
                                      GrowReport& report)
{
    // From the coarsest surface to the mesh: each takes over what the one before has won.
    const std::vector<double> ends = ends_of_levels(levels, mesh.triangles.size());
    const auto job_of = [&](double begin, double end) {
        return LevelJob{mesh.triangles.size(), options, progress.part(begin, end)};
    };
    auto from = vertices_of(levels);
    if (!order.own()) {
        const std::vector<std::uint32_t> place = places_of(order.vertices);
        for (std::vector<std::uint32_t>& vertices : from)
            vertices = values_at(place, vertices);
    }
    const LevelJob coarsest = job_of(0, ends[levels.size() - 1]);
    std::vector<Vec3d> inner = grow_coarsest(levels.back().mesh, values_at(s.cap, from.back()),
                                             values_at(stepped, from.back()), coarsest);
    for (std::size_t i = levels.size() - 1; i-- > 0;) {
        const LevelJob job = job_of(ends[i + 1], ends[i]);
        inner =
            grow_on_level(levels[i].mesh, values_at(s.cap, from[i]), StartedFrom::prolonged, job,
                          [&](GrowState& level, const Directions& own_lines, GrowReport& of_level) {
                              start_from_coarser(level, levels[i].mesh, own_lines,
                                                 levels[i + 1].mesh, inner, job, of_level);
                          })
                .inner;
    }
    return start_from_coarser(s, mesh, lines, levels.front().mesh, inner, job_of(ends[0], 100),
                              report);
}

} // namespace growth

std::vector<Coarsened> coarse_levels(const TriangleMesh& mesh, const GrowOptions& options,
                                     Interrupter* interrupter)
{
    std::vector<Coarsened> levels;
    if (!growth::wants_levels(mesh, options))
        return levels;
    // A coarse surface takes over the order of the finer one.
    const MeshOrder order = curve_order(mesh);
    const TriangleMesh ordered = order.own() ? TriangleMesh{} : in_order(mesh, order);
    const auto finest = [&]() -> const TriangleMesh& {
        return !levels.empty() ? levels.back().mesh : order.own() ? mesh : ordered;
    };
    const MultilevelSchedule& schedule = options.schedule.multilevel;
    const double times =
        std::max(static_cast<double>(mesh.triangles.size()) / schedule.coarsest_triangles,
                 schedule.greatest_ratio);
    // As few steps as keep each ratio in bounds, all of the same ratio.
    const double steps = std::ceil(std::log(times) / std::log(schedule.greatest_ratio));
    const double ratio = std::pow(times, 1 / steps);
    for (int step = 0; step < steps; ++step) {
        const std::size_t count = finest().triangles.size();
        Coarsened coarse =
            coarsen(finest(), static_cast<std::size_t>(double(count) / ratio), interrupter);
        // A surface that cannot be coarsened by half would cost about as much as the finer one.
        if (coarse.mesh.triangles.size() > count / 2)
            break;
        // Where the finer surface does not cross itself, it is the better start. Whether the mesh
        // does nobody has asked; if so, no level can be free of crossings.
        if (!coarse.embedded && !levels.empty() && levels.back().embedded &&
            double(count) <= schedule.most_coarsest_triangles)
            break;
        levels.push_back(std::move(coarse));
    }
    if (!levels.empty() && !order.own())
        levels.front().from = values_at(order.vertices, levels.front().from);
    return levels;
}

std::vector<std::uint32_t> vertices_of_coarsest(const TriangleMesh& mesh,
                                                const std::vector<Coarsened>& levels)
{
    if (!levels.empty()) {
        std::vector<std::uint32_t> vertices = growth::vertices_of(levels).back();
        std::sort(vertices.begin(), vertices.end());
        return vertices;
    }
    std::vector<std::uint32_t> all(mesh.points.size());
    std::iota(all.begin(), all.end(), 0U);
    return all;
}

} // namespace vdb_shell
