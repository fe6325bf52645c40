// SPDX-License-Identifier: Apache-2.0

// Takes a valid state in which some vertices are pinned that must not be. Leaves a valid one in
// which, as far as digits go, only those are that the skin itself demands. What stands in the way
// of a pillar in a fold is not room but rounding: the cone of its directions may be a thousandth of
// a radian wide. So all begins in doubles, as thin as it has to be, and a barrier drives the points
// of several pillars apart until their tets are many roundings high. Contacts are not looked at in
// between; the exact tests at the end shorten what touches.

#include "pose/inflate_lost.h"

#include "core/symmetric.h"
#include "growth/mend_prolonged.h"
#include "growth/move_tests.h"
#include "growth/pins.h"
#include "growth/trust_radius.h"
#include "mesh/most_visible.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace vdb_shell
{
namespace
{

using growth::FaceCorner;
using growth::GrowState;
using openvdb::Vec3d;

/// So far around lost pillars others shrink and grow with them, in edges, from attempt to attempt.
constexpr std::array<int, 3> kRings{1, 2, 4};
/// From one try to the next, and where the digits of doubles end.
constexpr double kThinner = 0.25, kThinnest = 1e-9;
constexpr int kHalvingsOfLength = 30;
/// Cosines below that are the rounding of a double in a direction that sees nothing.
constexpr double kLeastSight = 1e-7;
/// Pillars need not get longer to outlast the rounding, in edges; others bring them to where they
/// are carried.
constexpr double kLongest = 0.2;
/// Tets so many roundings high stay positive, whichever way their corners are rounded: at most
/// three are.
constexpr double kHighEnough = 8;
constexpr int kSweeps = 100, kNewtonSteps = 3;
/// Share of the way to a bound that a step may go.
constexpr double kShareOfRoom = 0.9;

/// What shrinks and grows.
struct Region {
    std::vector<int> lost;     ///< that are to get a pillar
    std::vector<int> vertices; ///< free ones, the lost among them
    std::vector<int> faces;    ///< around them
};

Region region_around(const GrowState& s, std::vector<int> lost, int rings)
{
    const growth::Connectivity& m = *s.mesh;
    std::vector<std::uint8_t> inside(s.b.size(), 0);
    for (const int v : lost)
        inside[v] = 1;
    const std::vector<std::uint8_t> is_lost = inside;
    for (int ring = 0; ring < rings; ++ring) {
        const std::vector<std::uint8_t> before = inside;
        for (int v = 0; v < m.vertices; ++v)
            for (const int u : growth::neighbours(m, v))
                inside[v] |= before[u];
    }
    Region region{std::move(lost), {}, {}};
    for (int v = 0; v < m.vertices; ++v)
        if (inside[v] && (is_lost[v] || !s.pinned[v]))
            region.vertices.push_back(v);
    for (int f = 0; f < m.face_count(); ++f)
        if (inside[m.corner(f, 0)] || inside[m.corner(f, 1)] || inside[m.corner(f, 2)])
            region.faces.push_back(f);
    return region;
}

/// Calls body with each tet of the face, under the state's test.
template <typename Body> void for_each_tet(const GrowState& s, int f, const Body& body)
{
    const auto visit = [&](const auto& tets) {
        for (const growth::OrientedTet& tet : tets)
            if (!growth::dropped(s, f, tet.pillar))
                body(tet);
    };
    s.twelve ? visit(growth::tables().twelve) : visit(growth::tables().three[s.order[f]]);
}

/// Calls body with each tet that holds b of the face's corner.
template <typename Body>
void for_each_tet_from(const GrowState& s, const FaceCorner& at, const Body& body)
{
    const int set = s.twelve ? growth::kTwelve : s.order[at.face];
    for (int i = 0; i < growth::tables().from_b_count[set][at.local]; ++i)
        body(growth::tables().from_b[set][at.local][i]);
}

/// How far the inner corners of each tet of the face may be rounded before one of them can turn
/// over, to first order: its determinant over the areas opposite to them. Not positive where one is
/// not.
double height_of(const GrowState& s, int f)
{
    static constexpr std::array<std::array<int, 3>, 4> kOpposite{
        {{1, 2, 3}, {0, 2, 3}, {0, 1, 3}, {0, 1, 2}}};
    double least = std::numeric_limits<double>::infinity();
    for_each_tet(s, f, [&](const growth::OrientedTet& tet) {
        std::array<Vec3d, 4> c;
        for (std::size_t k = 0; k < c.size(); ++k)
            c[k] = growth::corner_of(s, f, tet.corner[k]);
        double areas = 0;
        for (std::size_t k = 0; k < c.size(); ++k)
            if (tet.corner[k] >= 3) {
                const auto& [i, j, l] = kOpposite[k];
                areas += (c[j] - c[i]).cross(c[l] - c[i]).length();
            }
        const double determinant = (c[1] - c[0]).cross(c[2] - c[0]).dot(c[3] - c[0]);
        least = std::min(least, areas > 0 ? determinant / areas : -1.0);
    });
    return least;
}

double lowest(const GrowState& s, const std::vector<int>& faces)
{
    double least = std::numeric_limits<double>::infinity();
    for (const int f : faces)
        least = std::min(least, height_of(s, f));
    return least;
}

/// The base of a tet, as a bound on its inner corner: normal, of the length of twice its area, and
/// a point of it.
struct Base {
    Vec3d normal, point;
};

Base base_of(const GrowState& s, int f, const growth::TetFromInner& tet)
{
    const Vec3d& p = growth::corner_of(s, f, tet.base[0]);
    return {
        (growth::corner_of(s, f, tet.base[1]) - p).cross(growth::corner_of(s, f, tet.base[2]) - p),
        p};
}

/// The direction that sees the tets on v's own pillar best, which are positive on one side of a
/// plane through a_v however long it is; zero where none does.
Vec3d best_direction(const GrowState& s, int v)
{
    std::vector<Vec3d> normals;
    for (const FaceCorner& at : growth::star(*s.mesh, v))
        for_each_tet_from(s, at, [&](const growth::TetFromInner& tet) {
            const bool own =
                std::find(tet.base.begin(), tet.base.end(), at.local) != tet.base.end();
            Vec3d normal = own ? base_of(s, at.face, tet).normal : Vec3d(0.0);
            if (normal.normalize(0.0))
                normals.push_back(normal);
        });
    const Vec3d direction = most_visible(normals);
    return smallest_dot(normals, direction) > kLeastSight ? direction : Vec3d(0.0);
}

/// Gives v a pillar of that length or of a halved one, if one leaves the tets around v positive.
bool place_thin(GrowState& s, int v, double length)
{
    const Vec3d direction = best_direction(s, v);
    if (!(direction.lengthSqr() > 0))
        return false;
    s.pinned[v] = 0;
    const auto around = growth::star(*s.mesh, v);
    for (int halving = 0; halving < kHalvingsOfLength; ++halving, length *= 0.5) {
        s.b[v] = s.a[v] + length * direction;
        if (std::all_of(around.begin(), around.end(),
                        [&](const FaceCorner& at) { return height_of(s, at.face) > 0; }))
            return true;
    }
    return false;
}

/// Shrinks the pillars of the region along themselves until the lost ones fit between them. In
/// doubles that are not rounded.
bool start_thin(GrowState& s, const Region& region)
{
    std::vector<Vec3d> arm(s.b.size(), Vec3d(0.0));
    for (const int v : region.vertices)
        arm[v] = s.b[v] - s.a[v];
    for (double share = 1; share > kThinnest; share *= kThinner) {
        for (const int v : region.vertices)
            s.b[v] = s.a[v] + share * arm[v];
        for (const int v : region.lost)
            s.pinned[v] = 1;
        const bool placed = std::all_of(region.lost.begin(), region.lost.end(), [&](int v) {
            return place_thin(s, v, share * growth::mean_edge(*s.mesh, s.a, v));
        });
        if (placed && lowest(s, region.faces) > 0)
            return true;
    }
    return false;
}

/// The share of a step that keeps every bound and the pillar's length.
double room_for(const std::vector<Base>& bounds, const Vec3d& here, const Vec3d& step,
                const Vec3d& pillar, double longest)
{
    double share = 1;
    for (const Base& bound : bounds) {
        const double along = bound.normal.dot(step);
        if (along < 0)
            share = std::min(share, -kShareOfRoom * bound.normal.dot(here - bound.point) / along);
    }
    while (share > kThinnest && (pillar + share * step).length() >= longest)
        share *= 0.5;
    return share;
}

/// Damped Newton steps to the largest product of the distances of b_v from all its bounds, and of
/// what its pillar's square is below that of the longest (docs/theory.md, "Barrier").
void move_apart(GrowState& s, int v, double longest)
{
    std::vector<Base> bounds;
    for (const FaceCorner& at : growth::star(*s.mesh, v))
        for_each_tet_from(s, at, [&](const growth::TetFromInner& tet) {
            if (!growth::dropped(s, at.face, tet.pillar))
                bounds.push_back(base_of(s, at.face, tet));
        });
    constexpr double kDamped = 0.25, kConverged = 0.05;
    for (int i = 0; i < kNewtonSteps; ++i) {
        const Vec3d pillar = s.b[v] - s.a[v];
        const double room = longest * longest - pillar.lengthSqr();
        const Vec3d inward = pillar * (2 / room);
        Vec3d gradient = -inward;
        Symmetric hessian;
        hessian.add(1, inward);
        hessian.add_identity(2 / room);
        for (const Base& bound : bounds) {
            const Vec3d slope = bound.normal / bound.normal.dot(s.b[v] - bound.point);
            gradient += slope;
            hessian.add(1, slope);
        }
        Vec3d step;
        if (!solve_positive(hessian, gradient, step) || !std::isfinite(step.lengthSqr()))
            return;
        const double decrement = std::sqrt(std::max(0.0, gradient.dot(step)));
        if (decrement > kDamped)
            step /= 1 + decrement;
        s.b[v] += room_for(bounds, s.b[v], step, pillar, longest) * step;
        if (decrement < kConverged)
            return;
    }
}

/// One after the other, until the lowest tet outlasts the rounding; then rounds.
void inflate(GrowState& s, const Region& region, const StageProgress& progress)
{
    std::vector<double> longest(s.b.size());
    for (const int v : region.vertices) {
        constexpr double kMore = 1.2; // what is longer may stay so
        longest[v] = std::max(kLongest * growth::mean_edge(*s.mesh, s.a, v),
                              kMore * (s.b[v] - s.a[v]).length());
    }
    const double enough = kHighEnough * s.rounding;
    for (int sweep = 0; sweep < kSweeps && lowest(s, region.faces) < enough; ++sweep) {
        progress.stop_if_interrupted(100.0 * sweep / kSweeps);
        for (const int v : region.vertices)
            move_apart(s, v, longest[v]);
    }
    for (const int v : region.vertices) {
        s.b[v] = growth::capped(s, v, s.b[v]);
        s.pinned[v] = s.b[v] == s.a[v];
    }
}

/// Until all tests pass. Nothing is moved but along its pillar, for untangling would undo what has
/// just been made.
void shorten_what_fails(GrowState& s, const StageProgress& progress)
{
    const int moving_rounds = s.schedule.mend.moving_rounds;
    s.schedule.mend.moving_rounds = 0;
    growth::mend_placed(s, progress);
    s.schedule.mend.moving_rounds = moving_rounds;
}

/// Keeps the state with the fewest lost pillars, among them always the demanded ones.
class Attempts
{
public:
    Attempts(GrowState& s, const TriangleMesh& mesh, const StageProgress& progress)
        : s_(s), best_(s), progress_(progress), demanded_(s.b.size(), 0)
    {
        for (const std::uint32_t v : blind_vertices(mesh))
            demanded_[v] = 1;
    }

    /// The lost ones that the skin does not demand.
    std::vector<int> servable(const GrowState& s) const
    {
        std::vector<int> lost = lost_vertices(s);
        lost.erase(
            std::remove_if(lost.begin(), lost.end(), [this](int v) { return demanded_[v] != 0; }),
            lost.end());
        return lost;
    }

    void with_all_rings()
    {
        for (const int rings : kRings)
            attempt(servable(best_), rings);
    }

    /// With other tets than all twelve, pillars beside it can make room for one that sees some of
    /// the triangles from behind.
    void demanded_ones()
    {
        for (const int v : lost_vertices(best_))
            for (const int rings : kRings)
                if (demanded_[v] && best_.pinned[v])
                    attempt({v}, rings);
    }

    /// The best state so far where all twelve tets of each prism are asked for.
    void ask_for_twelve()
    {
        s_ = best_;
        s_.twelve = true;
        growth::mend_placed(s_, progress_);
        release();
        best_ = s_;
    }

    void release()
    {
        growth::release_pins(s_, std::vector<double>(s_.b.size(), 1.0),
                             growth::PillarsBesidePin::shortened);
        keep_if_better();
    }

    const GrowState& best() const { return best_; }

private:
    void attempt(std::vector<int> lost, int rings)
    {
        if (lost.empty())
            return;
        const Region region = region_around(best_, std::move(lost), rings);
        s_ = best_;
        if (!start_thin(s_, region))
            return;
        inflate(s_, region, progress_);
        shorten_what_fails(s_, progress_);
        keep_if_better();
    }

    void keep_if_better()
    {
        if (lost_vertices(s_).size() < lost_vertices(best_).size())
            best_ = s_;
    }

    GrowState& s_;
    GrowState best_;
    const StageProgress& progress_;
    std::vector<std::uint8_t> demanded_; ///< by vertex
};

} // namespace

std::vector<int> lost_vertices(const GrowState& s)
{
    std::vector<int> lost;
    for (int v = 0; v < s.mesh->vertices; ++v)
        if (s.pinned[v] && s.cap[v] > 0)
            lost.push_back(v);
    return lost;
}

std::size_t inflate_lost(GrowState& s, const TriangleMesh& mesh, const StageProgress& progress)
{
    if (lost_vertices(s).empty())
        return 0;
    const bool twelve = s.twelve;
    Attempts attempts(s, mesh, progress);
    attempts.release();
    attempts.with_all_rings();
    if (!twelve)
        attempts.demanded_ones();
    const GrowState chosen = attempts.best();
    // Shrinking along pillars spoils no tet where all twelve are positive. But asking for twelve
    // costs thickness all over the fold, so it is the last resort.
    if (!twelve && !attempts.servable(chosen).empty()) {
        attempts.ask_for_twelve();
        attempts.with_all_rings();
    }
    s = lost_vertices(attempts.best()).size() < lost_vertices(chosen).size() ? attempts.best()
                                                                             : chosen;
    s.twelve = twelve;
    return lost_vertices(s).size() - attempts.servable(s).size();
}

} // namespace vdb_shell
