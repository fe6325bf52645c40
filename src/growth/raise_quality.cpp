// SPDX-License-Identifier: Apache-2.0

// Takes: a valid shell with its diagonals and a bound on the mean ratio. Leaves: a valid shell with
// fewer tets below the bound, a little thinner. Each vertex goes down the gradient of the squared
// shortfall of the tets around it. Mean ratio: Liu and Joe 1994, "Relationship between tetrahedron
// shape measures".

#include "growth/raise_quality.h"

#include "growth/diagonals.h"
#include "growth/sweep.h"
#include "growth/trust_radius.h"
#include "vdb_shell/shell/quality.h"

#include <algorithm>
#include <cmath>

namespace vdb_shell::growth
{
namespace
{

/// How far the tets around a vertex are under the bound: the sum of squares, the worst mean ratio
/// and the direction in which the sum falls.
struct Shortfall {
    double sum = 0, worst = 1;
    Vec3d gradient{0.0};
};

/// Mean ratio of the tet over a fixed base, and its gradient in the free corner x.
double mean_ratio_and_gradient(const Corners& base, const Vec3d& x, Vec3d& gradient)
{
    const auto& [p, q, r] = base;
    const double ratio = mean_ratio(p, q, r, x);
    const Vec3d normal = (q - p).cross(r - p);
    const double volume6 = normal.dot(x - p);
    const double edges = (q - p).lengthSqr() + (r - p).lengthSqr() + (r - q).lengthSqr() +
                         (x - p).lengthSqr() + (x - q).lengthSqr() + (x - r).lengthSqr();
    // By the logarithm of 12 (3V)^(2/3) / (sum of squared edges): two thirds of the relative slope
    // of the volume less that of the sum. A tet that is flat in doubles has no such slope.
    gradient = volume6 > 0
                   ? ratio * ((2.0 / 3.0) * normal / volume6 - 2.0 * (3.0 * x - p - q - r) / edges)
                   : Vec3d(0.0);
    return ratio;
}

Shortfall shortfall_at(const GrowState& s, int v, const Vec3d& x, double bound)
{
    Shortfall result;
    for (const FaceCorner& at : star(*s.mesh, v))
        for (const TetFromInner& tet : chosen_tets_with_inner(s, at.face, at.local)) {
            if (dropped(s, at.face, tet.pillar))
                continue;
            Vec3d gradient;
            const double ratio = mean_ratio_and_gradient({corner_of(s, at.face, tet.base[0]),
                                                          corner_of(s, at.face, tet.base[1]),
                                                          corner_of(s, at.face, tet.base[2])},
                                                         x, gradient);
            result.worst = std::min(result.worst, ratio);
            if (ratio >= bound)
                continue;
            result.sum += (bound - ratio) * (bound - ratio);
            result.gradient -= 2.0 * (bound - ratio) * gradient;
        }
    return result;
}

/// A step down the shortfall's gradient, at first as long as would take it to nothing if it were
/// the square that it resembles, then shorter.
bool propose_better(const GrowState& s, const SeparatingPlanes& planes, int v, double bound,
                    Vec3d& out)
{
    const Shortfall now = shortfall_at(s, v, s.b[v], bound);
    const double slope = now.gradient.lengthSqr();
    if (now.sum == 0 || slope == 0)
        return false;
    // A sum of squares that falls to nought along its gradient does so at this distance, if it is a
    // square itself.
    Vec3d step = -(2.0 * now.sum / slope) * now.gradient;
    const QualitySchedule& schedule = s.schedule.quality;
    const double most =
        schedule.share_of_radius * (s.trust_radius[v] - (s.b[v] - s.trust_centre[v]).length());
    if (most <= 0)
        return false;
    if (step.length() > most)
        step *= most / step.length();
    for (int i = 0; i < schedule.halvings; ++i, step *= 0.5) {
        out = rounded(s.b[v] + step);
        const Shortfall then = shortfall_at(s, v, out, bound);
        // The worst tet must not pay for the others, unless it is good enough all the same.
        const bool better = then.sum < (1 - schedule.least_gain) * now.sum &&
                            (then.worst >= now.worst || then.worst >= bound);
        if (better && move_allowed(s, planes, v, out))
            return true;
    }
    return false;
}

/// Sum over all tets of the squares of what they are short of the bound; counts them.
double whole_shortfall(const GrowState& s, double bound, QualityResult& result)
{
    std::vector<std::uint8_t> below(s.b.size(), 0);
    double sum = 0;
    result.tets_below = 0;
    for (int f = 0; f < s.mesh->face_count(); ++f)
        for (const OrientedTet& tet : tables().three[s.order[f]]) {
            if (dropped(s, f, tet.pillar))
                continue;
            const double ratio =
                mean_ratio(corner_of(s, f, tet.corner[0]), corner_of(s, f, tet.corner[1]),
                           corner_of(s, f, tet.corner[2]), corner_of(s, f, tet.corner[3]));
            if (ratio >= bound)
                continue;
            sum += (bound - ratio) * (bound - ratio);
            ++result.tets_below;
            for (const std::uint8_t corner : tet.corner)
                if (corner >= 3)
                    below[s.mesh->corner(f, corner - 3)] = 1;
        }
    result.vertices_below = static_cast<std::size_t>(std::count(below.begin(), below.end(), 1));
    return sum;
}

} // namespace

QualityResult raise_quality(GrowState& s, double bound, bool flips, const StageProgress& progress)
{
    QualityResult result;
    const QualitySchedule& schedule = s.schedule.quality;
    SeparatingPlanes planes;
    for (int v = 0; v < s.mesh->vertices; ++v)
        s.trust_radius[v] = std::max(schedule.radius_edge_share * mean_edge(*s.mesh, s.a, v),
                                     kLeastRadiusInRoundings * s.rounding);
    // All vertices but the pinned ones are active in every round, so the pins are the list of those
    // left out, and radii stay as they are.
    const auto most_rounds = static_cast<std::size_t>(schedule.most_rounds);
    double shortfall = whole_shortfall(s, bound, result);
    while (result.rounds < most_rounds && shortfall > 0) {
        progress.stop_if_interrupted(int(100 * result.rounds / most_rounds));
        separate_triangles(s, s.pinned, planes);
        for (int i = 0; i < schedule.sweeps; ++i)
            sweep(s, planes, s.pinned,
                  [&](int v, Vec3d& x) { return propose_better(s, planes, v, bound, x); });
        if (flips)
            result.flips += flip_for_quality(s);
        ++result.rounds;
        const double left = whole_shortfall(s, bound, result);
        // More rounds would cost time and thickness for next to nothing.
        if (left > (1 - schedule.least_gain_of_round) * shortfall)
            break;
        shortfall = left;
    }
    return result;
}

} // namespace vdb_shell::growth
