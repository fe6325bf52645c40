// SPDX-License-Identifier: Apache-2.0

// Takes: a shell and the shares at which to cut its pillars. Leaves: points between the layers in
// float32, with all tets of all layers positive if those of the shell were. Cutting alone keeps the
// twelve tets of a prism positive (docs/theory.md, "A piece of a prism"); rounding may spoil them,
// and for three chosen tets there is no such lemma. So every prism is tested exactly, points of bad
// ones are moved, and as a last resort pillars stay whole, which always works. Signs suffice,
// without any test of the surfaces between (docs/theory.md, "Cutting needs no surface test"). The
// trap is `upside_down`: surfaces run from the skin, which is the inner surface of an outward
// layer, so outer and inner change places there.

#include "layers/columns.h"

#include "core/parallel.h"
#include "core/stage_stop.h"
#include "growth/predicates.h"
#include "growth/prism.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vdb_shell
{
namespace
{

using growth::OrientedTet;
using openvdb::Vec3d;
using openvdb::Vec3I;
using openvdb::Vec3s;

// Rounds end with the first that mends nothing. The bound makes sure that they end soon, and
// validity does not depend on it: what they leave bad is made whole afterwards.
constexpr int kMostRounds = 20;

/// Tets of triangle t's prism in layer k that are not positive. The number, and not only whether
/// there is one, because a point that mends one of two bad tets is progress. The tet of a pillar
/// that is pinned in this layer does not exist and is not counted.
int bad_tets(const Columns& c, std::size_t k, std::size_t t)
{
    const Vec3I& triangle = (*c.triangles)[t];
    const auto& upper = c.surface[c.upside_down ? k + 1 : k];
    const auto& lower = c.surface[c.upside_down ? k : k + 1];
    // Doubles that hold float32 values: the signs are those of the stored points.
    std::array<Vec3d, 6> corner;
    std::array<bool, 3> pinned{};
    for (std::size_t i = 0; i < 3; ++i) {
        const std::uint32_t v = triangle[int(i)];
        pinned[i] = upper[v] == lower[v];
        corner[i] = Vec3d(upper[v]);
        corner[i + 3] = Vec3d(lower[v]);
    }
    const auto count = [&](const auto& tets) {
        return int(std::count_if(tets.begin(), tets.end(), [&](const OrientedTet& tet) {
            return !pinned[std::size_t(tet.pillar)] &&
                   growth::orient(corner[tet.corner[0]], corner[tet.corner[1]],
                                  corner[tet.corner[2]], corner[tet.corner[3]]) <= 0;
        }));
    };
    return c.test == PrismTest::twelve_tets ? count(growth::tables().twelve)
                                            : count(growth::tables().three[c.order[t]]);
}

/// Bad tets in the two layers that meet in point v of surface j.
int bad_tets_around(const Columns& c, std::size_t j, std::uint32_t v)
{
    int bad = 0;
    for (const std::uint32_t t : c.around.around(v))
        bad += bad_tets(c, j - 1, t) + bad_tets(c, j, t);
    return bad;
}

/// Per triangle and layer, layer by layer.
std::vector<std::uint8_t> bad_prisms(const Columns& c)
{
    const std::size_t triangles = c.triangles->size();
    std::vector<std::uint8_t> bad(c.layers() * triangles);
    for_each_index(bad.size(), [&](std::size_t i) {
        bad[i] = bad_tets(c, i / triangles, i % triangles) > 0 ? 1 : 0;
    });
    return bad;
}

/// The points that are corners of bad prisms: by surface, then by vertex. Those on the two given
/// surfaces are flagged as well, but are never moved: they are certified, and neighbouring layers
/// share them.
std::vector<std::vector<std::uint8_t>> movable_corners(const Columns& c,
                                                       const std::vector<std::uint8_t>& bad)
{
    const std::size_t triangles = c.triangles->size();
    std::vector<std::vector<std::uint8_t>> corners(
        c.surface.size(), std::vector<std::uint8_t>(c.surface[0].size(), 0));
    for (std::size_t i = 0; i < bad.size(); ++i)
        for (int k = 0; bad[i] && k < 3; ++k)
            for (const std::size_t j : {i / triangles, i / triangles + 1})
                corners[j][(*c.triangles)[i % triangles][k]] = 1;
    return corners;
}

Vec3d mean_of_neighbours(const Columns& c, std::size_t j, std::uint32_t v)
{
    Vec3d sum(0.0);
    for (const std::uint32_t t : c.around.around(v))
        for (int k = 0; k < 3; ++k)
            if ((*c.triangles)[t][k] != v)
                sum += Vec3d(c.surface[j][(*c.triangles)[t][k]]);
    // On a closed surface each neighbour is in two triangles of the fan and is counted twice.
    return sum / (2.0 * double(c.around.around(v).size()));
}

/// Where point v of surface j might go, nearest places first, so that it stays close to the wanted
/// share: floats next to it (the first of them is the point itself, which is never an improvement),
/// then up and down its pillar, and towards its neighbours. The places next to it are for tets that
/// only rounding has spoiled, the others for those that the cut itself has.
std::vector<Vec3s> candidates(const Columns& c, std::size_t j, std::uint32_t v)
{
    const Vec3s here = c.surface[j][v];
    std::vector<Vec3s> places;
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    for (int code = 0; code < 27; ++code) {
        Vec3s place = here;
        for (int axis = 0, digit = code; axis < 3; ++axis, digit /= 3)
            if (digit % 3 != 0)
                place[axis] = std::nextafter(place[axis], digit % 3 == 1 ? kInfinity : -kInfinity);
        places.push_back(place);
    }
    const auto towards = [&](const Vec3d& target, double share) {
        places.emplace_back(Vec3d(here) + share * (target - Vec3d(here)));
    };
    const Vec3d near(c.surface[j - 1][v]), far(c.surface[j + 1][v]);
    const Vec3d mean = mean_of_neighbours(c, j, v);
    for (const double share : {0.1, 0.25, 0.5, 0.75}) {
        towards(near, share);
        towards(far, share);
        towards(mean, share);
    }
    return places;
}

/// Moves the point to the first of the places with the fewest bad tets around it.
bool mend_point(Columns& c, std::size_t j, std::uint32_t v)
{
    Vec3s& point = c.surface[j][v];
    // A pillar without length has no place of its own between its ends: its points are the vertex
    // itself.
    if (c.surface.front()[v] == c.surface.back()[v])
        return false;
    Vec3s best = point;
    const int before = bad_tets_around(c, j, v);
    int fewest = before;
    // Only the prisms above and below the point change, so counting around it is enough, and the
    // number of bad tets in all falls with each accepted move. Fewest first: a place is taken for
    // being strictly better, so ties go to the nearest.
    for (const Vec3s& place : candidates(c, j, v)) {
        if (fewest == 0)
            break;
        point = place;
        const int bad = bad_tets_around(c, j, v);
        if (bad < fewest) {
            fewest = bad;
            best = place;
        }
    }
    point = best;
    return fewest < before;
}

} // namespace

Columns cut_pillars(const PrismShell& shell, const PrismSplit& split,
                    const std::vector<std::vector<double>>& shares, bool upside_down,
                    PrismTest test)
{
    Columns c;
    c.triangles = &shell.triangles;
    c.upside_down = upside_down;
    c.test = test;
    c.around = triangles_around_vertices(shell.outer.size(), shell.triangles);
    c.order = growth::order_indices(split.order);
    const auto& skin = upside_down ? shell.inner : shell.outer;
    const auto& far = upside_down ? shell.outer : shell.inner;
    c.surface.push_back(skin);
    for (const std::vector<double>& share : shares) {
        // Every surface begins as the skin, so that a pillar without length keeps its bits: the sum
        // could turn a -0 into 0.
        c.surface.push_back(skin);
        std::vector<Vec3s>& cut = c.surface.back();
        for_each_index(cut.size(), [&](std::size_t v) {
            const Vec3d from(skin[v]), to(far[v]);
            // A share of 1 is the end to the bit, where the layers below are pinned.
            if (skin[v] != far[v])
                cut[v] = share[v] < 1 ? Vec3s(from + share[v] * (to - from)) : far[v];
        });
    }
    c.surface.push_back(far);
    return c;
}

void mend_columns(Columns& c, const StageProgress& progress)
{
    bool improved = true;
    for (int round = 0; improved && round < kMostRounds; ++round) {
        progress.stop_if_interrupted(100.0 * round / kMostRounds);
        improved = false;
        const auto corners = movable_corners(c, bad_prisms(c));
        // One point after the other in index order, in one thread: each move sees those before it,
        // and the result does not depend on threads.
        for (std::size_t j = 1; j < c.layers(); ++j)
            for (std::uint32_t v = 0; v < corners[j].size(); ++v) {
                stop_if_stage_wants(v);
                if (corners[j][v] && (c.fixed.empty() || !c.fixed[j][v]))
                    improved = mend_point(c, j, v) || improved;
            }
    }
}

std::size_t keep_whole_where_bad(Columns& c)
{
    // A pillar that becomes whole changes all prisms around it, which may turn bad in their turn;
    // hence rounds, until one adds no pillar. Each adds one at least, so there are no more rounds
    // than vertices. If all pillars are whole, the farthest layer is the given shell and the others
    // have no tets.
    std::vector<std::uint8_t> whole(c.surface[0].size(), 0);
    for (bool any = true; any;) {
        any = false;
        const std::vector<std::uint8_t> bad = bad_prisms(c);
        for (std::size_t i = 0; i < bad.size(); ++i)
            for (int k = 0; bad[i] && k < 3; ++k) {
                const std::uint32_t v = (*c.triangles)[i % c.triangles->size()][k];
                // A pillar without length is whole already. Counting it would report a pillar that
                // nobody could have cut.
                if (whole[v] || c.surface.front()[v] == c.surface.back()[v])
                    continue;
                whole[v] = 1;
                any = true;
            }
        for (std::size_t j = 1; j < c.layers(); ++j)
            for (std::size_t v = 0; v < whole.size(); ++v)
                if (whole[v])
                    c.surface[j][v] = c.surface[0][v];
    }
    return std::size_t(std::count(whole.begin(), whole.end(), 1));
}

std::size_t points_that_differ(const std::vector<std::vector<Vec3s>>& a,
                               const std::vector<std::vector<Vec3s>>& b)
{
    std::size_t count = 0;
    for (std::size_t j = 0; j < a.size(); ++j)
        for (std::size_t v = 0; v < a[j].size(); ++v)
            count += a[j][v] != b[j][v];
    return count;
}

} // namespace vdb_shell
