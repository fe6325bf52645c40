// SPDX-License-Identifier: Apache-2.0
#include "step/skip_ahead.h"

namespace vdb_shell
{
namespace
{

// The stencil sees a sheet that the line has not reached yet: up to two voxels ahead when they meet
// head on, farther when they graze. A jump that ends less far before one fails more often at its
// first look, and then goes back.
constexpr double kAheadVoxels = 1.5;
constexpr double kBackVoxels = 3.0;
// Where a link of the chain proves less than this, slopes this far apart are held against each
// other instead.
constexpr double kLinkVoxels = 4.0;
constexpr int kMostLinks = 8;
// Lines that begin with less of a stride than this look more often than it saves.
constexpr double kFirstStrideVoxels = 6.0;
// The search ends when it knows the place this well; it looks this far before where it expects it.
constexpr double kNearVoxels = 0.5, kShyVoxels = 0.25;
// Interpolation across a sheet makes a distance shorter by less than this.
constexpr double kBlurVoxels = 0.5;
// Below it the distance to the surface grows too slowly to rule out that the line leaves the solid
// between two looks.
constexpr double kLeastSlope = 0.25;

/// The slope from which on the stencil's swing (sheet_threshold) cannot bring it under a threshold.
double safe_slope(double threshold)
{
    const double length = std::sqrt(1 + kStencilSwing * kStencilSwing);
    const double angle = std::acos(std::min(1.0, threshold / length)) - std::atan(kStencilSwing);
    return angle > 0 ? std::cos(angle) : 2.0;
}

/// The length at which the line is as far from one point as from another, relative to its start;
/// not finite where there is none.
double equally_far(const Line& line, const openvdb::Vec3d& one, const openvdb::Vec3d& other)
{
    return 0.5 * (other.lengthSqr() - one.lengthSqr()) / (other - one).dot(line.inward);
}

} // namespace

SkipAhead::SkipAhead(const DeepField& field, double deepest)
    : back_(kBackVoxels * field.voxel()), field_(field), deepest_(deepest)
{
}

SkipAhead::Probe SkipAhead::probe(const Line& line, double length, TriangleTree::Seed& seed) const
{
    const openvdb::Vec3d at = line.start + length * line.inward;
    const openvdb::Vec3d foot = field_.nearest_point(at, seed), off = at - foot;
    const double distance = off.length();
    return {distance, distance > 0 ? off.dot(line.inward) / distance : 0.0, foot - line.start};
}

bool SkipAhead::chain_holds(const Line& line, double low, double high, double slope,
                            TriangleTree::Seed& seed, Probe& at_high) const
{
    const double cotangent = slope / std::sqrt(1 - slope * slope);
    double at = high, gap = 0, above = 0;
    for (int link = 0; link < kMostLinks; ++link) {
        const Probe p = probe(line, at, seed);
        if (link == 0)
            at_high = p;
        if (p.slope < slope)
            return false;
        // From a sampled gap: the mean slope over it, and room enough that the line has not left
        // the solid and come back.
        if (gap > 0 && (above - p.distance < slope * gap || p.distance < gap))
            return false;
        if (at <= low)
            return true;
        const double aside = p.distance * std::sqrt(std::max(0.0, 1 - p.slope * p.slope));
        const double proven = p.distance * p.slope - aside * cotangent;
        if (at - proven <= low)
            return true;
        const bool weak = proven < kLinkVoxels * field_.voxel();
        gap = weak ? std::min({kLinkVoxels * field_.voxel(), at - low, at / 3}) : 0.0;
        above = p.distance;
        at -= weak ? gap : proven;
    }
    return false;
}

/// Strides that double while they hold; then to where the point nearest to the last place that held
/// and the one nearest to the first that did not are equally far, which is mostly the end already.
template <typename Holds>
double SkipAhead::search(const Line& line, double from, const Holds& holds) const
{
    const double voxel = field_.voxel(), end = std::min(line.max_length, deepest_);
    double known = from, fails = end, stride = std::max(from, kFirstStrideVoxels * voxel);
    Probe at_known{}, at_fails{}, at_next{};
    bool growing = true, crossed = false;
    while (!crossed && known < end && (growing || fails - known >= kNearVoxels * voxel)) {
        double next = std::min(known + stride, end);
        if (!growing) {
            next = equally_far(line, at_known.foot, at_fails.foot) - kShyVoxels * voxel;
            crossed = next > known && next < fails;
            next = crossed ? next : 0.5 * (known + fails);
        }
        stride *= 2;
        if (holds(known, next, at_next)) {
            known = next;
            at_known = at_next;
        } else {
            fails = next;
            at_fails = at_next;
            growing = crossed = false;
        }
    }
    return std::max(from, known - kAheadVoxels * voxel);
}

double SkipAhead::holds_up_to(const Line& line, const MarchRules& rules, const RunningTest& test,
                              double from) const
{
    // Of this line alone, so that lengths do not depend on which thread steps which lines.
    TriangleTree::Seed seed = TriangleTree::kNoSeed;
    // Length less distance never falls along a line, for distances grow by no more than lengths.
    const double limit = rules.distance_threshold - kBlurVoxels * field_.voxel();
    if (rules.test == StopTest::distance)
        return search(line, from, [&](double, double high, Probe& at_high) {
            at_high = probe(line, high, seed);
            return high - at_high.distance < limit;
        });
    const double slope = std::max(kLeastSlope, safe_slope(test.slope_wanted()));
    if (slope >= 1)
        return from;
    return search(line, from, [&](double low, double high, Probe& at_high) {
        return chain_holds(line, low, high, slope, seed, at_high);
    });
}

} // namespace vdb_shell
