// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/step/line_step.h"

#include <algorithm>
#include <cmath>
#include <limits>

// One extrusion line, free of threads and grids: Field is anything with
// `FieldSample at(const Vec3d& world)`, so that a test can give it a formula.

namespace vdb_shell
{

/// The options in world units.
struct MarchRules {
    StopTest test = StopTest::normal;
    double rho = 0.9;
    double sheet_cosine = 0.985;
    double step = 0;
    double distance_threshold = 0;
    double reference = 0;    ///< from here on relative_normal measures s0 and own_sheet compares
    double period = 0;       ///< s0 is taken over this distance
    double entry = 0;        ///< a line that is not inside by here has missed the solid
    double search_depth = 0; ///< bisection looks no deeper: half the diagonal
    double interval = 0;     ///< bisection has converged when its interval is this short
    int bisection_iterations = 0;
};

struct Line {
    openvdb::Vec3d start{0.0};
    openvdb::Vec3d inward{0.0}; ///< unit length
    double max_length = std::numeric_limits<double>::infinity();
    double own_slope = 1; ///< own_sheet_slopes
};

struct LineEnd {
    double length = 0;
    std::uint32_t steps = 0;
    StopReason reason = StopReason::none;
};

/// On a sheet the interpolated slope swings with the position in the cell, by a share of how far
/// the sheet's gradients are apart: up to 0.15 between two planes and 0.31 between three, over
/// random lattices.
inline constexpr double kStencilSwing = 0.31;

/// The slope below which a line is no longer on its own sheet.
inline double sheet_threshold(double own_slope, double sheet_cosine)
{
    const double apart = std::sqrt(std::max(0.0, 1 - own_slope * own_slope));
    return std::max(0.0, sheet_cosine * own_slope - kStencilSwing * apart);
}

/// Bisection on eq. 1: the largest length at which e = -phi(q) up to the threshold, taking for
/// granted that it holds up to some length and fails beyond.
template <typename Field>
LineEnd bisect_line(Field& field, const Line& line, const MarchRules& rules)
{
    const auto holds = [&](double e) {
        const auto sample = field.at(line.start + e * line.inward);
        // Where the grid ends, its values no longer say how deep the point is.
        return sample.in_band && std::abs(e + sample.phi) < rules.distance_threshold;
    };
    double low = 0, high = std::min(line.max_length, rules.search_depth);
    if (line.max_length <= rules.search_depth && holds(high))
        return {high, 1, StopReason::thickness};
    LineEnd end{0, 1, StopReason::iterations};
    for (int i = 0; i < rules.bisection_iterations; ++i) {
        if (high - low <= rules.interval) {
            end.reason = StopReason::converged;
            break;
        }
        const double middle = 0.5 * (low + high);
        (holds(middle) ? low : high) = middle;
        ++end.steps;
    }
    end.length = low;
    return end;
}

/// The stop test along one line. relative_normal remembers the least slope it has seen, so lengths
/// are tested in ascending order.
class RunningTest
{
public:
    RunningTest(const Line& line, const MarchRules& rules, const openvdb::Vec3d& start_gradient)
        : line_(line), rules_(rules), start_gradient_(start_gradient),
          sheet_threshold_(sheet_threshold(line.own_slope, rules.sheet_cosine))
    {
    }

    template <typename Sample> double slope_of(const Sample& sample) const
    {
        return -sample.gradient.dot(line_.inward);
    }
    void set_reference(double slope) { reference_slope_ = slope; }

    template <typename Sample> bool holds(double e, const Sample& sample)
    {
        switch (rules_.test) {
        case StopTest::normal:
            return slope_of(sample) > rules_.rho;
        case StopTest::start_gradient:
            return sample.gradient.dot(start_gradient_) > rules_.rho;
        case StopTest::distance:
            return std::abs(e + sample.phi) < rules_.distance_threshold;
        case StopTest::relative_normal:
            return relative_holds(e, slope_of(sample));
        case StopTest::own_sheet:
            return slope_of(sample) > (e < rules_.reference ? 0.0 : sheet_threshold_);
        case StopTest::none:
        case StopTest::bisection:
            break;
        }
        return true;
    }

    /// Beyond this length the test no longer changes.
    double settled() const
    {
        switch (rules_.test) {
        case StopTest::relative_normal:
            return rules_.reference + rules_.period;
        case StopTest::own_sheet:
            return rules_.reference;
        default:
            return 0;
        }
    }

    /// The slope towards -inward over which the test holds, whatever else, once it has settled;
    /// over 1 where a slope cannot tell.
    double slope_wanted() const
    {
        switch (rules_.test) {
        case StopTest::normal:
            return rules_.rho;
        case StopTest::relative_normal:
            return rules_.rho * std::max(0.0, reference_slope_);
        case StopTest::own_sheet:
            return sheet_threshold_;
        case StopTest::start_gradient: {
            // A gradient within this angle of the line is near enough to the one at the start.
            const double length = start_gradient_.length();
            const double cosine = -start_gradient_.dot(line_.inward) / length;
            const double apart = std::acos(std::clamp(cosine, -1.0, 1.0));
            const double angle = length > rules_.rho ? std::acos(rules_.rho / length) - apart : 0.0;
            return angle > 0 ? std::cos(angle) : 2.0;
        }
        default:
            return 2.0;
        }
    }

private:
    bool relative_holds(double e, double slope)
    {
        if (e > settled())
            return slope > rules_.rho * std::max(0.0, reference_slope_);
        if (e >= rules_.reference)
            reference_slope_ = std::min(reference_slope_, slope);
        return slope > 0;
    }

    const Line& line_;
    const MarchRules& rules_;
    openvdb::Vec3d start_gradient_;
    double sheet_threshold_;
    double reference_slope_ = 0;
};

/// Looks at every step; step/skip_ahead.h has one that does not.
struct NoSkip {
    static constexpr bool kWanted = false;
    static double back() { return 0; }
    static double holds_up_to(const Line&, const MarchRules&, const RunningTest&, double from)
    {
        return from;
    }
};

/// Where a line jumps to, in steps, and from where: steps just before a stop are looked at, and if
/// the first of them already fails, the ones before are.
struct Jump {
    std::uint32_t from = 0, to = 0;
    bool done = false;

    void back_by(double steps)
    {
        to = to - from > steps ? to - static_cast<std::uint32_t>(steps) : from;
    }
};

/// How the step to length e ends the line, if it does: StopReason::none to go on.
template <typename Sample>
StopReason stop_at(double e, const Sample& sample, bool inside, double entry, RunningTest& test)
{
    const bool solid = sample.phi <= 0;
    if (!solid && (inside || e > entry))
        return StopReason::left_solid;
    if (solid && !sample.in_band)
        return StopReason::left_band;
    return test.holds(e, sample) ? StopReason::none : StopReason::stop_test;
}

/// From `steps` on as far as the test is known to hold. The last step before the largest length is
/// looked at, like all that stop a line.
inline Jump jump_of(const Line& line, const MarchRules& rules, std::uint32_t steps, double known)
{
    const double last =
        std::min(std::floor(known / rules.step), std::ceil(line.max_length / rules.step) - 1);
    return {steps, std::max(steps, static_cast<std::uint32_t>(last)), true};
}

/// Steps along the line while the test holds. The length is the last one at which it held.
/// `skip` may know without looking that the test holds up to some length.
template <typename Field, typename Skip = NoSkip>
LineEnd march_line(Field& field, const Line& line, const MarchRules& rules, const Skip& skip = {})
{
    const auto sample_at = [&](double e) { return field.at(line.start + e * line.inward); };
    const auto start = sample_at(0);
    // Smoothing can leave a vertex outside the zero crossing: it has that much further to go in.
    const double entry = rules.entry + std::max(0.0, start.phi);
    RunningTest test(line, rules, start.gradient);
    if (rules.test == StopTest::relative_normal)
        test.set_reference(test.slope_of(sample_at(std::min(rules.reference, line.max_length))));

    LineEnd end;
    Jump jump;
    bool inside = false;
    while (true) {
        if (Skip::kWanted && !jump.done && inside && end.length > test.settled()) {
            jump = jump_of(line, rules, end.steps, skip.holds_up_to(line, rules, test, end.length));
            end.steps = jump.to;
            end.length = end.steps * rules.step;
        }
        const double e = std::min(++end.steps * rules.step, line.max_length);
        const auto sample = sample_at(e);
        inside = inside || sample.phi <= 0;
        end.reason = stop_at(e, sample, inside, entry, test);
        if (end.reason != StopReason::none) {
            if (end.steps > jump.to + 1 || jump.to == jump.from)
                break;
            jump.back_by(skip.back() / rules.step + 1);
            end.steps = jump.to;
            end.length = end.steps * rules.step;
            continue;
        }
        end.length = e;
        if (e >= line.max_length) {
            end.reason = StopReason::thickness;
            break;
        }
    }
    // Steps taken outside, on the way in, are no depth.
    if (!inside)
        end.length = 0;
    return end;
}

template <typename Field, typename Skip = NoSkip>
LineEnd step_one(Field& field, const Line& line, const MarchRules& rules, const Skip& skip = {})
{
    if (line.inward.lengthSqr() == 0)
        return {0, 0, StopReason::no_direction};
    if (line.max_length == 0)
        return {0, 0, StopReason::thickness};
    switch (rules.test) {
    case StopTest::none:
        return {line.max_length, 0,
                std::isfinite(line.max_length) ? StopReason::thickness : StopReason::none};
    case StopTest::bisection:
        return bisect_line(field, line, rules);
    default:
        return march_line(field, line, rules, skip);
    }
}

} // namespace vdb_shell
