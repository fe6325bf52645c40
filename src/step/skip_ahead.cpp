// SPDX-License-Identifier: Apache-2.0
// Says up to which length a stop test holds along a line, from the nearest points of a few places
// instead of a look at each step. What makes it possible is that, along a line, the squared
// distance to the surface less the squared length is concave, so that one nearest point deep inside
// bounds the slope at all places before it. The proof is in docs/stages/line_stepping.md, "Skipping
// ahead". Where this proves too little the slope is sampled, so the result is a good guess and not
// a theorem; step/march.h looks at the steps just before a stop.

#include "step/skip_ahead.h"

namespace vdb_shell
{
namespace
{

// The stencil sees a sheet of the medial axis that the line has not reached yet: up to two voxels
// ahead when they meet head on, farther when the line grazes it. A jump that ends closer to a sheet
// than the first number fails more often at its first look. It then goes back by the second one.
constexpr double kAheadVoxels = 1.5;
constexpr double kBackVoxels = 3.0;
// Where a link of the chain proves less than this, places this far apart are sampled and the mean
// slope between them is compared with the threshold instead. The number of links bounds the cost of
// a look.
constexpr double kLinkVoxels = 4.0;
constexpr int kMostLinks = 8;
// A line that begins with a shorter stride than this spends more looks than it saves.
constexpr double kFirstStrideVoxels = 6.0;
// The search ends when it knows the place to the first number. It looks the second one before the
// place where it expects the test to fail, because a place where the test holds is of more use.
constexpr double kNearVoxels = 0.5, kShyVoxels = 0.25;
// Interpolation across a sheet makes a distance shorter by less than this.
constexpr double kBlurVoxels = 0.5;
// Below it the distance to the surface grows too slowly to rule out that the line leaves the solid
// between two looks.
constexpr double kLeastSlope = 0.25;

/// The slope from which on the stencil's swing (sheet_threshold) cannot bring it under a threshold.
double safe_slope(double threshold)
{
    // With the true slope cos(a), the sampled one is at least cos(a) - swing sin(a), which is
    // length cos(a + atan(swing)). It reaches the threshold at the angle below. When no angle is
    // left, 2 says that no slope is safe.
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
    // The caller has made sure that the slope is below 1. The chain runs backwards, from `high`
    // down to `low`, because a nearest point only bounds the slopes before its place.
    const double cotangent = slope / std::sqrt(1 - slope * slope);
    double at = high, gap = 0, above = 0;
    for (int link = 0; link < kMostLinks; ++link) {
        const Probe p = probe(line, at, seed);
        if (link == 0)
            at_high = p;
        if (p.slope < slope)
            return false;
        // After a sampled gap two things are needed: the mean slope over the gap, and a distance of
        // at least the gap, since a ball of that radius then holds the whole gap inside the solid
        // and the line cannot have left the solid and come back.
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

/// The strides double while the test holds. The next place is then where the point nearest to the
/// last place that held and the one nearest to the first that did not are equally far, which is
/// where the line crosses the sheet of the medial axis between the two; mostly the search ends
/// there.
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
    // The seed belongs to this line alone. A query with a tolerance may give another answer for
    // another seed, so a seed shared between lines would make lengths depend on which thread steps
    // which lines.
    TriangleTree::Seed seed = TriangleTree::kNoSeed;
    // Length less distance never falls along a line, because a distance grows by no more than the
    // length. So for this test one look answers for all that lies before it.
    const double limit = rules.distance_threshold - kBlurVoxels * field_.voxel();
    if (rules.test == StopTest::distance)
        return search(line, from, [&](double, double high, Probe& at_high) {
            at_high = probe(line, high, seed);
            // The test compares the length with the sampled distance, which may be shorter by the
            // blur, so the limit is smaller by that amount.
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
