// SPDX-License-Identifier: Apache-2.0

// Takes a surface that is oriented and whose fans are parted, and closes its holes by fills that
// touch nothing. For each hole the fills are tried from the fairest to the plainest; each is
// rounded to float32 and tested exactly against the surface, the fills made before, and itself.
// Holes are filled one after the other in the order of their first sides, since a fill has to keep
// clear of those before it. Sources: Barequet and Sharir 1995, "Filling gaps in the boundary of a
// polyhedron"; Liepa 2003, "Filling holes in meshes". The trap is the cost: the tree over the
// surface is built anew for each hole.

#include "core/box_pairs.h"
#include "core/exact.h"
#include "core/stage_progress.h"
#include "mesh/boundary_loops.h"
#include "repair/fill_patch.h"
#include "repair/hole_walk.h"
#include "repair/working_surface.h"

#include <algorithm>
#include <map>
#include <optional>

namespace vdb_shell::repair
{
namespace
{

using openvdb::Vec3d;
using openvdb::Vec3I;

BoxTree tree_over(std::vector<FloatBox> boxes)
{
    BoxTree tree;
    tree.build(std::move(boxes));
    return tree;
}

/// What the fill of a hole has to know of the surface around it. The surface has the earlier fills
/// in it, so an edge that one of them runs between two points of this rim counts as taken.
Rim look_around(const TriangleMesh& mesh, const Hole& hole)
{
    const auto n = static_cast<std::uint32_t>(hole.points.size());
    std::map<std::uint32_t, std::uint32_t> on_rim;
    for (std::uint32_t i = 0; i < n; ++i)
        on_rim[hole.points[i]] = i;
    Rim rim;
    std::vector<std::set<std::uint32_t>> around(n);
    for (const Vec3I& t : mesh.triangles) {
        for (int k = 0; k < 3; ++k) {
            const auto entry = on_rim.find(t[k]);
            if (entry == on_rim.end())
                continue;
            around[entry->second].insert(t[(k + 1) % 3]);
            around[entry->second].insert(t[(k + 2) % 3]);
        }
    }
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
    std::size_t count_crossings(const BoxTree& rest) const
    {
        const TriangleMesh& mesh = surface_.mesh;
        const std::vector<FloatBox> boxes =
            triangle_boxes(mesh.points, {mesh.triangles.begin() + std::ptrdiff_t(triangles_),
                                         mesh.triangles.end()});
        const BoxTree fresh = tree_over(boxes);
        std::size_t crossings = 0;
        for (std::size_t t = triangles_; t < mesh.triangles.size(); ++t) {
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
            };
            rest.for_each_overlap(box, [&](int other) { meet(std::size_t(other)); });
            fresh.for_each_overlap(box, [&](int other) {
                // Of two new triangles the later one counts the pair.
                if (triangles_ + std::size_t(other) < t)
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

bool is_long(const Rim& rim)
{
    return rim.points.size() > kLongestOptimalRim;
}

Patch make_patch(const Rim& rim, FillMethod method)
{
    if (is_long(rim))
        return cut_rim_ears(rim);
    Patch patch = triangulate_rim(rim, method != FillMethod::area);
    if (patch.triangles.empty() || method == FillMethod::area || method == FillMethod::dihedral)
        return patch;
    refine(patch, rim);
    fair(patch, rim, method == FillMethod::smooth);
    return patch;
}

/// Fills one hole, or leaves the surface as it was.
void fill_hole(WorkingSurface& surface, const Hole& hole, bool keep_crossing, HoleFill& fill)
{
    const Rim rim = look_around(surface.mesh, hole);
    const BoxTree rest = tree_over(triangle_boxes(surface.mesh.points, surface.mesh.triangles));
    // A flat rim gets a flat lid, also where the surface around it meets the lid at an edge. The
    // smooth fill would go on with the slope of that and bulge.
    std::vector<FillMethod> methods{FillMethod::smooth, FillMethod::membrane, FillMethod::dihedral,
                                    FillMethod::area};
    if (is_planar(rim))
        std::swap(methods[0], methods[1]);
    if (is_long(rim))
        methods = {FillMethod::area};
    std::optional<FillMethod> best;
    for (const FillMethod method : methods) {
        const Patch patch = make_patch(rim, method);
        if (patch.triangles.empty())
            continue;
        Trial trial(surface, hole, patch);
        const std::size_t crossings = trial.count_crossings(rest);
        // Of fills with equally many crossings the first, which is the fairest, is kept.
        if (!best || crossings < fill.crossings) {
            best = method;
            fill.crossings = crossings;
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
    const Trial trial(surface, hole, make_patch(rim, *best));
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
    for (std::size_t h = 0; h < holes.size(); ++h) {
        progress.stop_if_interrupted(static_cast<int>(100 * h / holes.size()));
        const Hole& hole = holes[h];
        // Measured before the fill appends to the mesh; a hole that stays open is reported by the
        // same figures.
        HoleFill fill = measured(mesh, hole);
        if (hole.points.size() >= 3 && !passes_a_point_twice(hole))
            fill_hole(surface, hole, options.keep_crossing_fills, fill);
        report.holes.push_back(fill);
    }
    for (const Hole& hole : never)
        report.holes.push_back(measured(mesh, hole));
}

} // namespace vdb_shell::repair
