// SPDX-License-Identifier: Apache-2.0

// Takes a pose with a few inverted tets. A tet's volume is affine in one of its corners: so the
// places of a point where its tets are positive are a convex cell, into which it ascends by its
// least distance to the cell's planes. One point alone often has an empty cell; then it goes where
// the least distance is largest, which makes room for its neighbours. One after the other, in the
// order of their numbers.

#include "pose/centre_points.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace vdb_shell
{
namespace
{

using openvdb::Vec3d;
using Parts = RestShell::Parts;

/// In three frames of the sample creature's walk all tets were positive after 13 at most.
constexpr int kSweeps = 40;
/// Of a point's spacing: how far it goes at most in a sweep.
constexpr double kReach = 0.5;
/// The ascent ends with steps of this share of the reach.
constexpr double kFinest = 1e-5;
/// Planes that are nearly as near as the nearest one take part in the direction of a step.
constexpr double kNear = 0.3;
constexpr int kAscentSteps = 400, kDirectionSteps = 60;

/// Positive on the side where the tet is.
struct HalfSpace {
    Vec3d normal;
    double offset;
    double at(const Vec3d& p) const { return normal.dot(p) + offset; }
};

std::vector<HalfSpace> cell_of(const Parts& parts, const PoseState& state, std::uint32_t point)
{
    // The face opposite to each corner, so that its normal points at the corner of a positive tet.
    static constexpr std::array<std::array<int, 3>, 4> kOpposite{
        {{1, 3, 2}, {0, 2, 3}, {0, 3, 1}, {0, 1, 2}}};
    std::vector<HalfSpace> cell;
    for (std::uint32_t i = parts.first[point]; i < parts.first[point + 1]; ++i) {
        const openvdb::Vec4I& tet = parts.all[parts.incident[i]];
        int corner = 0;
        while (tet[corner] != point)
            ++corner;
        const auto& face = kOpposite[std::size_t(corner)];
        const Vec3d a = state.place[tet[face[0]]], b = state.place[tet[face[1]]],
                    c = state.place[tet[face[2]]];
        Vec3d normal = (b - a).cross(c - a);
        if (normal.normalize())
            cell.push_back({normal, -normal.dot(a)});
    }
    return cell;
}

double least(const std::vector<HalfSpace>& cell, const Vec3d& p)
{
    double value = std::numeric_limits<double>::infinity();
    for (const HalfSpace& side : cell)
        value = std::min(value, side.at(p));
    return value;
}

/// The shortest vector in the convex hull of the near planes' normals (Frank and Wolfe): along it
/// all their distances grow; nought in the middle.
Vec3d ascent_direction(const std::vector<HalfSpace>& cell, const Vec3d& p, double margin)
{
    std::vector<Vec3d> normals;
    for (const HalfSpace& side : cell)
        if (side.at(p) < margin)
            normals.push_back(side.normal);
    Vec3d sum(0.0);
    for (const Vec3d& n : normals)
        sum += n / double(normals.size());
    for (int step = 0; step < kDirectionSteps; ++step) {
        const auto against =
            std::min_element(normals.begin(), normals.end(), [&](const Vec3d& a, const Vec3d& b) {
                return a.dot(sum) < b.dot(sum);
            });
        const Vec3d towards = *against - sum;
        const double length2 = towards.lengthSqr();
        if (length2 < 1e-18)
            break;
        sum += std::clamp(-sum.dot(towards) / length2, 0.0, 1.0) * towards;
    }
    return sum;
}

Vec3d place_in(const std::vector<HalfSpace>& cell, Vec3d p, double reach, double enough)
{
    double step = reach, value = least(cell, p);
    for (int i = 0; i < kAscentSteps && step > kFinest * reach && value < enough; ++i) {
        Vec3d direction = ascent_direction(cell, p, value + kNear * step);
        const bool centred = !direction.normalize(1e-6);
        const Vec3d there = p + step * direction;
        const double reached = centred ? value : least(cell, there);
        if (reached > value) {
            p = there;
            value = reached;
        } else {
            step /= 2;
        }
    }
    return p;
}

/// The free points of these tets and of those beside them, ascending.
std::vector<std::uint32_t> points_around(const Parts& parts, const std::vector<std::uint32_t>& tets)
{
    std::vector<std::uint8_t> marked(parts.rest.size(), 0);
    const auto mark = [&](std::uint32_t t) {
        for (int k = 0; k < 4; ++k)
            if (parts.skin_vertex[parts.all[t][k]] == Parts::kFree)
                marked[parts.all[t][k]] = 1;
    };
    for (const std::uint32_t t : tets)
        mark(t);
    const std::vector<std::uint8_t> own = marked;
    for (std::uint32_t p = 0; p < own.size(); ++p)
        for (std::uint32_t i = parts.first[p]; own[p] && i < parts.first[p + 1]; ++i)
            mark(parts.incident[i]);
    std::vector<std::uint32_t> points;
    for (std::uint32_t p = 0; p < marked.size(); ++p)
        if (marked[p])
            points.push_back(p);
    return points;
}

} // namespace

void centre_points(const Parts& parts, PoseState& state, const InvertedTets& inverted,
                   double enough, const StageProgress& progress)
{
    std::vector<std::uint32_t> bad = inverted(state);
    PoseState best = state;
    std::size_t fewest = bad.size();
    for (int sweep = 0; sweep < kSweeps && !bad.empty(); ++sweep) {
        progress.stop_if_interrupted(100 * sweep / kSweeps);
        for (const std::uint32_t point : points_around(parts, bad)) {
            const std::vector<HalfSpace> cell = cell_of(parts, state, point);
            state.place[point] = place_in(cell, state.place[point], kReach * parts.spacing[point],
                                          enough * parts.spacing[point]);
        }
        bad = inverted(state);
        if (bad.size() < fewest) {
            fewest = bad.size();
            best = state;
        }
    }
    state = std::move(best);
}

} // namespace vdb_shell
