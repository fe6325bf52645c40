// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "field/deep_field.h"
#include "step/march.h"

namespace vdb_shell
{

/// Knows from few nearest points how far a stop test holds along a line. d(q)^2 - |q|^2 is the
/// least of affine functions, one for each point of the surface, hence concave: if f is the point
/// nearest to q(e), then at any earlier q(x) of the line the slope of the distance is at least the
/// cosine of the angle under which q(x) sees f from behind. One look deep inside thus answers for
/// all that lies before it, wherever f keeps within the cone of the test.
/// docs/stages/line_stepping.md.
class SkipAhead
{
public:
    static constexpr bool kWanted = true;

    SkipAhead(const DeepField& field, double deepest);

    /// By how much a line goes back when its first look after a jump fails.
    double back() const { return back_; }

    /// A length up to which the test holds, as far as nearest points can tell; at least `from`,
    /// where the test has settled.
    double holds_up_to(const Line& line, const MarchRules& rules, const RunningTest& test,
                       double from) const;

private:
    struct Probe {
        double distance, slope;
        openvdb::Vec3d foot; ///< the nearest point, from the line's start
    };
    Probe probe(const Line& line, double length, TriangleTree::Seed& seed) const;
    bool chain_holds(const Line& line, double low, double high, double slope,
                     TriangleTree::Seed& seed, Probe& at_high) const;
    template <typename Holds>
    double search(const Line& line, double from, const Holds& holds) const;

    double back_;
    const DeepField& field_;
    double deepest_;
};

} // namespace vdb_shell
