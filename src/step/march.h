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
    double reference = 0;    ///< relative_normal measures s0 from here on, own_sheet compares;
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

/// On a sheet the interpolated slope swings with the position in the cell, by a share of how far the
/// sheet's gradients are apart: up to 0.15 between two planes and 0.31 between three, over random
/// lattices.
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

/// Looks at every step; step/skip_ahead.h has one that does not.
struct NoSkip {
    static constexpr bool wanted = false;
};

/// What the slope towards -inward must be over for the test to hold, whatever else; over 1 where a
/// slope cannot tell.
inline double slope_wanted(const Line& line, const MarchRules& rules,
                           const openvdb::Vec3d& start_gradient, double reference_slope)
{
    switch (rules.test) {
    case StopTest::normal:
        return rules.rho;
    case StopTest::relative_normal:
        return rules.rho * std::max(0.0, reference_slope);
    case StopTest::own_sheet:
        return sheet_threshold(line.own_slope, rules.sheet_cosine);
    case StopTest::start_gradient: {
        // A gradient within this angle of the line is near enough to the one at the start.
        const double length = start_gradient.length();
        const double apart =
            std::acos(std::clamp(-start_gradient.dot(line.inward) / length, -1.0, 1.0));
        const double angle = length > rules.rho ? std::acos(rules.rho / length) - apart : -1.0;
        return angle > 0 ? std::cos(angle) : 2.0;
    }
    default:
        return 2.0;
    }
}

/// Steps along the line while the test holds. The length is the last one at which it held.
/// `skip` may know without looking that the test holds up to some length.
template <typename Field, typename Skip = NoSkip>
LineEnd march_line(Field& field, const Line& line, const MarchRules& rules, const Skip& skip = {})
{
    const openvdb::Vec3d outward = -line.inward;
    const auto sample_at = [&](double e) { return field.at(line.start + e * line.inward); };
    const auto start = sample_at(0);
    // Smoothing can leave a vertex outside the zero crossing: it has that much further to go in.
    const double entry = rules.entry + std::max(0.0, start.phi);

    const auto slope_of = [&](const auto& sample) { return sample.gradient.dot(outward); };

    double reference_slope = 0;
    if (rules.test == StopTest::relative_normal)
        reference_slope = slope_of(sample_at(std::min(rules.reference, line.max_length)));
    const auto relative_holds = [&](double e, double slope) {
        if (e > rules.reference + rules.period)
            return slope > rules.rho * std::max(0.0, reference_slope);
        if (e >= rules.reference)
            reference_slope = std::min(reference_slope, slope);
        return slope > 0;
    };
    const double threshold = sheet_threshold(line.own_slope, rules.sheet_cosine);
    const auto holds = [&](double e, const auto& sample) {
        switch (rules.test) {
        case StopTest::normal:
            return slope_of(sample) > rules.rho;
        case StopTest::start_gradient:
            return sample.gradient.dot(start.gradient) > rules.rho;
        case StopTest::distance:
            return std::abs(e + sample.phi) < rules.distance_threshold;
        case StopTest::relative_normal:
            return relative_holds(e, slope_of(sample));
        case StopTest::own_sheet:
            return slope_of(sample) > (e < rules.reference ? 0.0 : threshold);
        case StopTest::none:
        case StopTest::bisection:
            break;
        }
        return true;
    };

    LineEnd end;
    bool inside = false, skipped = !Skip::wanted;
    while (true) {
        if constexpr (Skip::wanted)
            if (!skipped && inside && end.length > rules.reference + rules.period) {
                skipped = true;
                const double known =
                    rules.test == StopTest::distance
                        ? skip.difference_holds(line, end.length, rules.distance_threshold)
                        : skip.slope_holds(line, end.length,
                                           slope_wanted(line, rules, start.gradient,
                                                        reference_slope));
                // The last step before the largest length is looked at, like all that stop a line.
                const double steps = std::min(std::floor(known / rules.step),
                                              std::ceil(line.max_length / rules.step) - 1);
                if (steps > end.steps) {
                    end.steps = static_cast<std::uint32_t>(steps);
                    end.length = end.steps * rules.step;
                }
            }
        const double e = std::min(++end.steps * rules.step, line.max_length);
        const auto sample = sample_at(e);
        inside = inside || sample.phi <= 0;
        const bool left = !(sample.phi <= 0) && (inside || e > entry);
        if (left || (sample.phi <= 0 && !sample.in_band)) {
            end.reason = left ? StopReason::left_solid : StopReason::left_band;
            break;
        }
        if (!holds(e, sample)) {
            end.reason = StopReason::stop_test;
            break;
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
