// SPDX-License-Identifier: Apache-2.0

// Takes a shell at rest and its skin in a pose. Leaves the shell on that skin: the same tets, with
// points that the skin's motion carries (skin_motion), that move where tets would be distorted
// (relax_pose), and that pass the exact tests of growth (mend_sides) where growth can be asked.

#include "vdb_shell/pose/pose_shell.h"

#include "core/parallel.h"
#include "core/stage_progress.h"
#include "pose/mend_sides.h"
#include "pose/part_faces.h"
#include "pose/relax_pose.h"
#include "pose/rest_parts.h"
#include "pose/stored_points.h"
#include "vdb_shell/options/option.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

namespace vdb_shell
{
namespace
{

using openvdb::Vec3d;
using openvdb::Vec3s;
using Parts = RestShell::Parts;

void require_skin(const Parts& parts, const std::vector<Vec3s>& skin)
{
    const std::size_t vertices = parts.stack.surface(0).size();
    if (skin.size() != vertices)
        throw InvalidOption("pose: the skin has " + std::to_string(skin.size()) +
                            " points, the shell's surface has " + std::to_string(vertices));
    for (std::size_t v = 0; v < skin.size(); ++v)
        if (!skin[v].isFinite())
            throw InvalidOption("pose: point " + std::to_string(v) + " of the skin is not finite");
}

PoseState carry(const Parts& parts, const std::vector<Vec3s>& skin)
{
    PoseState state;
    state.carried.resize(parts.rest.size());
    const SkinMotion::Frame frame = parts.motion.frame(skin);
    for_each_index(
        parts.rest.size(),
        [&](std::size_t p) {
            const std::uint32_t v = parts.skin_vertex[p];
            const bool outside =
                p < parts.tets.layer.size() && parts.tets.layer[p] < parts.stack.skin;
            // As it would be stored: the rest shape itself is carried to where it is, bit for bit.
            state.carried[p] =
                v != Parts::kFree
                    ? Vec3d(skin[v])
                    : Vec3d(Vec3s(parts.motion.carry(frame, parts.rest[p],
                                                     outside ? SkinMotion::Side::outside
                                                             : SkinMotion::Side::inside)));
        },
        16);
    state.place = state.carried;
    return state;
}

void tell_tets(const Parts& parts, const PoseState& state, const std::vector<Vec3s>& points,
               double most_distortion, PoseReport& report)
{
    for (const std::uint32_t t : inverted_tets(parts, points)) {
        ++report.inverted;
        bool skin = true;
        for (int k = 0; k < 4; ++k)
            skin = skin && parts.skin_vertex[parts.all[t][k]] != Parts::kFree;
        report.inverted_by_skin += skin;
    }
    std::vector<double> distortions(parts.all.size());
    for_each_index(distortions.size(),
                   [&](std::size_t t) { distortions[t] = distortion(parts, state, t); });
    double sum = 0;
    std::size_t count = 0;
    for (const double d : distortions)
        if (std::isfinite(d)) {
            sum += d, ++count;
            report.distorted += d > most_distortion;
            report.most_distortion = std::max(report.most_distortion, d);
        }
    report.mean_distortion = count > 0 ? sum / double(count) : 1;
    for (std::size_t p = 0; p < state.place.size(); ++p)
        report.moved_points += Vec3s(state.place[p]) != Vec3s(state.carried[p]);
}

/// Where a place without a tet goes: on the skin if it is there at rest, for it is pinned; else as
/// the skin carries it, as where a layer is nothing but a point under a small component. So it
/// stays apart from what it is apart from at rest, and no tet comes or goes by it.
class PlacesWithoutTets
{
public:
    PlacesWithoutTets(const Parts& parts, const std::vector<Vec3s>& skin)
        : parts_(parts), skin_(skin)
    {
    }

    Vec3s at(std::size_t place)
    {
        const std::size_t v = place % skin_.size(), surface = place / skin_.size();
        const Vec3s& rest = parts_.stack.surface(surface)[v];
        if (rest == parts_.stack.surface(parts_.stack.skin)[v])
            return skin_[v];
        if (!frame_)
            frame_ = parts_.motion.frame(skin_);
        return Vec3s(parts_.motion.carry(*frame_, Vec3d(rest),
                                         surface < parts_.stack.skin ? SkinMotion::Side::outside
                                                                     : SkinMotion::Side::inside));
    }

private:
    const Parts& parts_;
    const std::vector<Vec3s>& skin_;
    std::optional<SkinMotion::Frame> frame_; ///< most shells have no such place
};

/// The rest shell with other points. Places that share a point get the same.
void put_points(const Parts& parts, const std::vector<Vec3s>& points,
                const std::vector<Vec3s>& skin, PoseResult& result)
{
    result.stack = parts.stack;
    const std::size_t vertices = skin.size();
    PlacesWithoutTets others(parts, skin);
    const auto at = [&](std::size_t place) {
        const std::uint32_t point = parts.point_of_place[parts.first_place[place]];
        return point == Parts::kFree ? others.at(place) : points[point];
    };
    for (std::size_t k = 0; k < result.stack.layers.size(); ++k) {
        PrismShell& layer = result.stack.layers[k];
        for (std::size_t v = 0; v < vertices; ++v) {
            layer.outer[v] = at(k * vertices + v);
            layer.inner[v] = at((k + 1) * vertices + v);
        }
    }
    result.core = parts.core;
    for (std::size_t i = 0; i < result.core.points.size(); ++i)
        result.core.points[i] = points[parts.tets.points.size() + i];
}

} // namespace

OptionList describe(PoseOptions& o)
{
    return in_group(
        "Pose",
        {option(
             "most_distortion", o.most_distortion, "--most-distortion",
             "Distortion of a tet up to which points stay where the skin carries them; 1 is rest")
             .within(above(1)),
         option("rounds", o.rounds, "--pose-rounds", "Rounds of moves of points at most")
             .in(Unit::count)
             .within(at_least(0))});
}

PoseResult pose_shell(const RestShell& rest, const std::vector<Vec3s>& skin,
                      const PoseOptions& options, Interrupter* interrupter)
{
    const StageProgress progress(interrupter, "pose");
    const Parts& parts = rest.parts();
    require_in_range(options, "pose");
    require_skin(parts, skin);
    PoseResult result;
    PoseReport& report = result.report;
    report.tets = parts.all.size();
    for (const auto& colour : parts.colour)
        report.free_points += colour.size();
    PoseState state = carry(parts, skin);
    report.inverted_carried = inverted_tets(parts, stored_points(parts, state, skin)).size();
    const SkinCrossings crossings = find_skin_crossings(parts, state, skin, interrupter);
    report.skin_crossings = crossings.pairs;
    for (const std::uint8_t in : crossings.region)
        report.excused_triangles += in;
    if (can_mend_sides(parts)) {
        mend_sides(parts, state, skin, crossings, options, report, progress);
    } else {
        report.rounds = static_cast<std::size_t>(
            relax_pose(parts, state, options.most_distortion,
                       std::vector<std::uint8_t>(parts.rest.size(), 1), progress));
        part_faces(parts, state, skin, crossings, options, report, progress);
    }
    const std::vector<Vec3s> points = stored_points(parts, state, skin);
    tell_tets(parts, state, points, options.most_distortion, report);
    put_points(parts, points, skin, result);
    return result;
}

} // namespace vdb_shell
