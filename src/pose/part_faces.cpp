// SPDX-License-Identifier: Apache-2.0

// Takes a pose of a tapered shell, whose tets are positive but for a few. Leaves one in which all
// are, and no free faces touch, but for what it tells. Points near what fails move to less energy,
// a growing part of which is what is missing: to being positive of a tet, and to its side of a
// plane of a point (pose/face_planes.h). Exact tests on the points as stored say what fails.

#include "pose/part_faces.h"

#include "core/exact.h"
#include "core/parallel.h"
#include "core/sort_unique.h"
#include "core/star_sight.h"
#include "pose/face_contacts.h"
#include "pose/face_planes.h"
#include "pose/stored_points.h"

#include <algorithm>
#include <limits>

namespace vdb_shell
{
namespace
{

using openvdb::Vec3d;
using openvdb::Vec3s;
using Parts = RestShell::Parts;

/// Rounds of tests at most, and of those that find no fewer failures; sweeps of moves between.
constexpr int kPartingRounds = 32, kIdleRounds = 16, kPartingSweeps = 8;
/// Weight of what is missing, beside the way to where a point is carried.
constexpr double kFirstWeight = 8, kWeightGrowth = 2, kMostWeight = 1e5;
constexpr int kPartingHalvings = 8;

bool on_skin(const Parts& parts, std::uint32_t point)
{
    return parts.skin_vertex[point] != Parts::kFree;
}

/// The free points of these tets, ascending.
std::vector<std::uint32_t> free_points_of(const Parts& parts,
                                          const std::vector<std::uint32_t>& tets)
{
    std::vector<std::uint32_t> points;
    for (const std::uint32_t t : tets)
        for (int k = 0; k < 4; ++k)
            if (!on_skin(parts, parts.all[t][k]))
                points.push_back(parts.all[t][k]);
    sort_unique(points);
    return points;
}

/// Whether the skin leaves the point no place: nowhere are all of its tets positive whose other
/// corners lie on the skin.
bool demanded(const Parts& parts, const std::vector<Vec3s>& points, std::uint32_t point)
{
    std::vector<std::array<Vec3s, 3>> triangles;
    for (std::uint32_t i = parts.first[point]; i < parts.first[point + 1]; ++i) {
        const openvdb::Vec4I& tet = parts.all[parts.incident[i]];
        std::size_t local = 0;
        while (tet[int(local)] != point)
            ++local;
        const auto& others = kOtherCorners[local];
        const std::array<std::uint32_t, 3> corner{tet[int(others[0])], tet[int(others[1])],
                                                  tet[int(others[2])]};
        if (std::all_of(corner.begin(), corner.end(),
                        [&](std::uint32_t p) { return on_skin(parts, p); }))
            triangles.push_back({points[corner[0]], points[corner[1]], points[corner[2]]});
    }
    return !exact::a_point_sees(triangles);
}

/// By point, asked once: the answer is the skin's alone.
class Demanded
{
public:
    explicit Demanded(const Parts& parts) : parts_(parts), answer_(parts.rest.size(), kNotAsked) {}

    bool operator()(const std::vector<Vec3s>& points, std::uint32_t point)
    {
        if (answer_[point] == kNotAsked)
            answer_[point] = demanded(parts_, points, point);
        return answer_[point] == 1;
    }

private:
    static constexpr std::uint8_t kNotAsked = 2;
    const Parts& parts_;
    std::vector<std::uint8_t> answer_;
};

/// Where the point goes; false where it stays.
bool better_place(const Parts& parts, const PoseState& state, const FacePlanes& planes,
                  std::uint32_t point, double most_distortion, double weight, Vec3d& to)
{
    PointEnergy energy(parts, state, point, most_distortion, weight);
    for (const FacePlanes::Side& side : planes.of(point))
        energy.add_half_space(side.n, side.least - side.n.dot(state.place[point]), weight);
    Vec3d step;
    if (!energy.newton(step))
        return false;
    step *= energy.room_for(step);
    const double now = energy.at(Vec3d(0.0));
    for (int halving = 0; halving < kPartingHalvings; ++halving, step *= 0.5)
        if (energy.at(step) < now) {
            to = state.place[point] + step;
            return true;
        }
    return false;
}

/// Moves the points that are awake; wakes those around what has moved.
void sweep(const Parts& parts, PoseState& state, const FacePlanes& planes, double most_distortion,
           double weight, std::vector<std::uint8_t>& awake)
{
    for (const std::vector<std::uint32_t>& colour : parts.colour) {
        std::vector<std::uint8_t> moved(colour.size(), 0);
        for_each_index(
            colour.size(),
            [&](std::size_t i) {
                Vec3d to;
                if (awake[colour[i]] &&
                    better_place(parts, state, planes, colour[i], most_distortion, weight, to)) {
                    state.place[colour[i]] = to;
                    moved[i] = 1;
                }
            },
            16);
        for (std::size_t i = 0; i < colour.size(); ++i)
            for (std::uint32_t k = parts.first[colour[i]];
                 moved[i] && k < parts.first[colour[i] + 1]; ++k)
                for (int c = 0; c < 4; ++c)
                    awake[parts.all[parts.incident[k]][c]] = 1;
    }
}

} // namespace

void part_faces(const Parts& parts, PoseState& state, const std::vector<Vec3s>& skin,
                const SkinCrossings& crossings, const PoseOptions& options, PoseReport& report,
                const StageProgress& progress)
{
    FacePlanes planes(parts, state, skin);
    Demanded is_demanded(parts);
    std::vector<Vec3d> best;
    std::size_t fewest = std::numeric_limits<std::size_t>::max();
    double weight = kFirstWeight;
    for (int round = 0, idle = 0; round < kPartingRounds && idle < kIdleRounds; ++round, ++idle) {
        progress.stop_if_interrupted(100.0 * round / kPartingRounds);
        const std::vector<Vec3s> points = stored_points(parts, state, skin);
        const std::vector<std::uint32_t> inverted = inverted_tets(parts, points);
        const std::vector<FacePair> pairs = faces_not_apart(parts, points, skin, crossings);
        if (inverted.size() + pairs.size() < fewest) {
            fewest = inverted.size() + pairs.size();
            best = state.place;
            idle = 0;
            const std::vector<std::uint32_t> lost = free_points_of(parts, inverted);
            report.lost_pillars = lost.size();
            report.lost_demanded = std::size_t(std::count_if(
                lost.begin(), lost.end(), [&](std::uint32_t p) { return is_demanded(points, p); }));
            report.faces_not_apart = pairs.size();
        }
        if (fewest == 0)
            break;
        planes.keep_apart(pairs);
        std::vector<std::uint8_t> awake(parts.rest.size(), 0);
        for (const std::uint32_t p : free_points_of(parts, inverted))
            awake[p] = 1;
        for (int i = 0; i < kPartingSweeps; ++i) {
            planes.put();
            for (std::uint32_t p = 0; p < awake.size(); ++p)
                awake[p] |= std::uint8_t(!planes.of(p).empty());
            sweep(parts, state, planes, options.most_distortion, weight, awake);
        }
        weight = std::min(kMostWeight, kWeightGrowth * weight);
        ++report.rounds;
    }
    state.place = best;
}

} // namespace vdb_shell
