// SPDX-License-Identifier: Apache-2.0

// Takes a surface that is oriented and whose fans are parted, and closes its holes by fills that
// touch nothing. For each hole the fills are tried from the fairest to the plainest; each is
// rounded to float32 and tested exactly against the surface, the fills made before, and itself.
// Holes are filled one after the other in the order of their first sides, since a fill has to keep
// clear of those before it. Sources: Barequet and Sharir 1995, "Filling gaps in the boundary of a
// polyhedron"; Liepa 2003, "Filling holes in meshes". The trap is the cost: the best triangulation
// of a rim takes the cube of its length, so the more long rims there are, the sooner one of them
// counts as too long for it.

#include "core/box_pairs.h"
#include "core/exact.h"
#include "core/stage_progress.h"
#include "core/triangle_piece.h"
#include "mesh/boundary_loops.h"
#include "repair/fill_patch.h"
#include "repair/hole_walk.h"
#include "repair/surroundings.h"
#include "repair/working_surface.h"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

namespace vdb_shell::repair
{
namespace
{

using openvdb::Vec3d;
using openvdb::Vec3I;

/// What the fill of a hole has to know of the surface around it. The surface has the earlier fills
/// in it, so an edge that one of them runs between two points of this rim counts as taken.
Rim look_around(const TriangleMesh& mesh, const Surroundings& surroundings, const Hole& hole)
{
    const auto n = static_cast<std::uint32_t>(hole.points.size());
    std::map<std::uint32_t, std::uint32_t> on_rim;
    for (std::uint32_t i = 0; i < n; ++i)
        on_rim[hole.points[i]] = i;
    Rim rim;
    std::vector<std::set<std::uint32_t>> around(n);
    for (std::uint32_t i = 0; i < n; ++i)
        for (const std::uint32_t t : surroundings.around(hole.points[i]))
            for (int k = 0; k < 3; ++k)
                if (mesh.triangles[t][k] != hole.points[i])
                    around[i].insert(mesh.triangles[t][k]);
    rim.neighbours.resize(n);
    for (std::uint32_t i = 0; i < n; ++i) {
        const Vec3d here(mesh.points[hole.points[i]]);
        rim.points.push_back(here);
        rim.beyond.emplace_back(mesh.points[hole.beyond[i]]);
        double sum = 0;
        for (const std::uint32_t v : around[i]) {
            sum += (Vec3d(mesh.points[v]) - here).length();
            const auto entry = on_rim.find(v);
            const bool along = entry != on_rim.end() &&
                               (entry->second == (i + 1) % n || (entry->second + 1) % n == i);
            // Neighbours along the rim are neighbours within the patch as well, and would count
            // twice.
            if (!along)
                rim.neighbours[i].emplace_back(mesh.points[v]);
            if (!along && entry != on_rim.end() && i < entry->second)
                rim.edges.insert({i, entry->second});
        }
        rim.spacing.push_back(around[i].empty() ? 0.0 : sum / double(around[i].size()));
    }
    return rim;
}

/// Appends a patch to the surface as float32, and takes it off again. All that is new stands at the
/// end, so taking it off is a matter of lengths, and the indices of other holes stay valid.
class Trial
{
public:
    Trial(WorkingSurface& surface, const Hole& hole, const Patch& patch)
        : surface_(surface), points_(surface.mesh.points.size()),
          triangles_(surface.mesh.triangles.size())
    {
        TriangleMesh& mesh = surface.mesh;
        std::vector<std::uint32_t> index = hole.points;
        for (std::size_t v = hole.points.size(); v < patch.points.size(); ++v) {
            index.push_back(static_cast<std::uint32_t>(mesh.points.size()));
            mesh.points.emplace_back(patch.points[v]);
        }
        for (const Vec3I& t : patch.triangles) {
            mesh.triangles.emplace_back(index[t[0]], index[t[1]], index[t[2]]);
            surface.source.push_back(kNoSource);
        }
    }

    std::size_t new_points() const { return surface_.mesh.points.size() - points_; }
    std::size_t new_triangles() const { return surface_.mesh.triangles.size() - triangles_; }

    /// Pairs of a new triangle and any other that cross or touch; a new one without area counts as
    /// such a pair. `rest` holds the old triangles. Old ones without area are passed over: they are
    /// no fault of the fill, and the exact test is not defined for them.
    /// Counts no further than to `enough`.
    std::size_t count_crossings(Surroundings& rest, std::size_t enough) const
    {
        const TriangleMesh& mesh = surface_.mesh;
        const std::vector<FloatBox> boxes =
            triangle_boxes(mesh.points, {mesh.triangles.begin() + std::ptrdiff_t(triangles_),
                                         mesh.triangles.end()});
        BoxTree fresh;
        fresh.build(boxes);
        std::size_t crossings = 0;
        for (std::size_t t = triangles_; t < mesh.triangles.size() && crossings < enough; ++t) {
            const Vec3I& mine = mesh.triangles[t];
            if (exact::collinear(mesh.points[mine[0]], mesh.points[mine[1]],
                                 mesh.points[mine[2]])) {
                ++crossings;
                continue;
            }
            const FloatBox& box = boxes[t - triangles_];
            const auto meet = [&](std::size_t other) {
                const Vec3I& c = mesh.triangles[other];
                crossings +=
                    !exact::collinear(mesh.points[c[0]], mesh.points[c[1]], mesh.points[c[2]]) &&
                    exact::triangles_touch(mesh.points, mine, c);
                return crossings < enough;
            };
            rest.for_each_near(part_boxes(mesh.points, {mine}).boxes, meet);
            if (crossings < enough)
                fresh.for_each_overlap_while(box, [&](int other) {
                    // Of two new triangles the later one counts the pair.
                    return triangles_ + std::size_t(other) >= t ||
                           meet(triangles_ + std::size_t(other));
                });
        }
        return crossings;
    }

    void undo()
    {
        surface_.mesh.points.resize(points_);
        surface_.mesh.triangles.resize(triangles_);
        surface_.source.resize(triangles_);
    }

private:
    WorkingSurface& surface_;
    std::size_t points_, triangles_;
};

/// The longest rim that gets the best triangulation: so that all that do take no longer than one of
/// kLongestOptimalRim.
std::size_t longest_optimal(const std::vector<Hole>& holes)
{
    std::vector<std::size_t> lengths;
    lengths.reserve(holes.size());
    for (const Hole& hole : holes)
        lengths.push_back(hole.points.size());
    std::sort(lengths.begin(), lengths.end());
    const auto cube = [](std::size_t n) { return double(n) * double(n) * double(n); };
    double work = 0;
    for (std::size_t i = 0; i < lengths.size(); ++i) {
        work += cube(lengths[i]);
        if (work > cube(kLongestOptimalRim))
            return i == 0 ? kLongestOptimalRim : lengths[i - 1];
    }
    return kLongestOptimalRim;
}

/// To how many crossings a fill is counted: to so few that all fills together have no more than
/// some million, a second's work.
std::size_t most_counted(std::size_t holes)
{
    constexpr std::size_t kInAll = 2'000'000, kLeast = 10;
    return std::clamp(kInAll / std::max<std::size_t>(holes, 1), kLeast, HoleFill::kMostCounted);
}

/// The fills of one rim. Three of them begin with the same triangulation, which is made once.
class Fills
{
public:
    Fills(const Rim& rim, std::size_t longest) : rim_(rim), long_(rim.points.size() > longest) {}

    /// In the order in which they are to be tried.
    std::vector<FillMethod> methods() const
    {
        if (long_)
            return {FillMethod::area};
        // A flat rim gets a flat lid, also where the surface around it meets the lid at an edge.
        // The smooth fill would go on with the slope of that and bulge.
        if (is_planar(rim_))
            return {FillMethod::membrane, FillMethod::smooth, FillMethod::dihedral,
                    FillMethod::area};
        return {FillMethod::smooth, FillMethod::membrane, FillMethod::dihedral, FillMethod::area};
    }

    Patch make(FillMethod method)
    {
        if (long_)
            return cut_rim_ears(rim_);
        if (method == FillMethod::area)
            return triangulate_rim(rim_, false);
        if (!plain_)
            plain_ = triangulate_rim(rim_, true);
        if (plain_->triangles.empty() || method == FillMethod::dihedral)
            return *plain_;
        if (!refined_) {
            refined_ = plain_;
            refine(*refined_, rim_);
        }
        Patch patch = *refined_;
        fair(patch, rim_, method == FillMethod::smooth);
        return patch;
    }

private:
    const Rim& rim_;
    bool long_;
    std::optional<Patch> plain_, refined_;
};

bool same(const Patch& a, const Patch& b)
{
    return a.points == b.points && a.triangles == b.triangles;
}

/// What bounds the work on each of many holes.
struct Bounds {
    std::size_t longest_optimal, most_counted;
};

/// Fills one hole, or leaves the surface as it was.
void fill_hole(WorkingSurface& surface, Surroundings& rest, const Hole& hole, const Bounds& bounds,
               bool keep_crossing, const StageProgress& progress, HoleFill& fill)
{
    const Rim rim = look_around(surface.mesh, rest, hole);
    Fills fills(rim, bounds.longest_optimal);
    std::optional<FillMethod> best;
    Patch last;
    for (const FillMethod method : fills.methods()) {
        progress.stop_if_interrupted(50);
        Patch patch = fills.make(method);
        // Of a small rim all fills are the same.
        if (patch.triangles.empty() || same(patch, last))
            continue;
        Trial trial(surface, hole, patch);
        last = std::move(patch);
        const std::size_t crossings =
            trial.count_crossings(rest, best ? fill.crossings : bounds.most_counted);
        // Of fills with equally many crossings the first, which is the fairest, is kept.
        if (!best || crossings < fill.crossings) {
            best = method;
            fill.crossings = crossings;
            fill.crossings_at_least = crossings >= bounds.most_counted;
        }
        if (crossings > 0) {
            trial.undo();
            continue;
        }
        fill.method = method;
        fill.new_points = trial.new_points();
        fill.new_triangles = trial.new_triangles();
        return;
    }
    if (!best || !keep_crossing)
        return;
    const Trial trial(surface, hole, fills.make(*best));
    fill.method = *best;
    fill.new_points = trial.new_points();
    fill.new_triangles = trial.new_triangles();
}

double length_of(const TriangleMesh& mesh, const Hole& hole)
{
    double length = 0;
    for (std::size_t i = 0; i < hole.points.size(); ++i)
        length += (Vec3d(mesh.points[hole.points[(i + 1) % hole.points.size()]]) -
                   Vec3d(mesh.points[hole.points[i]]))
                      .length();
    return length;
}

HoleFill measured(const TriangleMesh& mesh, const Hole& hole)
{
    HoleFill fill;
    fill.first_point = *std::min_element(hole.points.begin(), hole.points.end());
    fill.edges = hole.points.size();
    fill.length = length_of(mesh, hole);
    return fill;
}

/// The rims of one-sided pieces, which are reported but never filled: a fill runs through its rim
/// against the triangles outside, and these have no common direction there. So only points are
/// known.
std::vector<Hole> holes_of_one_sided(const TriangleMesh& mesh,
                                     const std::vector<std::uint32_t>& partner,
                                     const std::vector<char>& one_sided)
{
    std::vector<Edge> edges;
    for (std::uint32_t side = 0; side < partner.size(); ++side) {
        if (partner[side] != kUnpaired || !one_sided[side / 3])
            continue;
        const Vec3I& t = mesh.triangles[side / 3];
        const std::uint32_t a = t[int(side % 3)], b = t[int((side + 1) % 3)];
        edges.push_back({std::min(a, b), std::max(a, b)});
    }
    std::sort(edges.begin(), edges.end());
    std::vector<Hole> holes;
    for (const BoundaryWalk& walk : boundary_walks(edges))
        holes.push_back({walk.points, {}, {}});
    return holes;
}

/// Patches and their triangulations tell points apart by their places along the rim. A point that
/// has two places would be two corners in one position, and no fill is tried.
bool passes_a_point_twice(const Hole& hole)
{
    std::vector<std::uint32_t> sorted = hole.points;
    std::sort(sorted.begin(), sorted.end());
    return std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end();
}

} // namespace

void fill_holes(WorkingSurface& surface, const RepairOptions& options, RepairReport& report,
                Interrupter* interrupter)
{
    const StageProgress progress(interrupter, "filling holes");
    const TriangleMesh& mesh = surface.mesh;
    const std::vector<std::uint32_t> partner = pair_sides(mesh);
    const Fans fans = find_fans(mesh, partner);
    const std::vector<char> one_sided = one_sided_triangles(mesh);
    const std::vector<Hole> holes =
        walk_holes(mesh, partner, fans, link_fans(mesh, partner, fans), one_sided);
    const std::vector<Hole> never = holes_of_one_sided(mesh, partner, one_sided);
    Surroundings surroundings(mesh, holes);
    const Bounds bounds{longest_optimal(holes), most_counted(holes.size())};
    for (std::size_t h = 0; h < holes.size(); ++h) {
        progress.stop_if_interrupted(static_cast<int>(100 * h / holes.size()));
        const Hole& hole = holes[h];
        // Measured before the fill appends to the mesh; a hole that stays open is reported by the
        // same figures.
        HoleFill fill = measured(mesh, hole);
        if (hole.points.size() >= 3 && !passes_a_point_twice(hole))
            fill_hole(surface, surroundings, hole, bounds, options.keep_crossing_fills, progress,
                      fill);
        surroundings.update();
        report.holes.push_back(fill);
    }
    for (const Hole& hole : never)
        report.holes.push_back(measured(mesh, hole));
}

} // namespace vdb_shell::repair
