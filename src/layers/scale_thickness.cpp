// SPDX-License-Identifier: Apache-2.0

// Takes: a valid shell and a factor. Leaves: the shell with every pillar that share of its length,
// valid again, and a count of what had to become shorter. With twelve positive tets in each prism
// every factor is valid but for the rounding (docs/theory.md, "Layers, and shells scaled down");
// with the chosen three it need not be. So all tests of growth's own start run on the scaled
// pillars, and what fails is shortened further, at last to nothing. Growth lends its state and its
// tests, not its moves: no pillar changes its direction, and the certificate decides afterwards as
// always. A factor of 1 changes no bit.

#include "vdb_shell/layers/scale_thickness.h"

#include "vdb_shell/core/error.h"
#include "vdb_shell/options/option.h"

#include "core/stage_progress.h"
#include "growth/initialise.h"
#include "shell/pillar.h"

#include <cassert>
#include <string>

namespace vdb_shell
{
namespace
{

using growth::GrowState;
using openvdb::Vec3d;
using openvdb::Vec3s;

struct Pillars {
    Directions directions;
    std::vector<double> length;
};

Pillars scaled_pillars(const PrismShell& shell, double factor)
{
    Pillars pillars;
    const std::size_t count = shell.outer.size();
    pillars.directions.inward.assign(count, Vec3d(0.0));
    pillars.directions.visibility.assign(count, 0.0);
    pillars.length.assign(count, 0.0);
    for (std::size_t v = 0; v < count; ++v) {
        // A pinned pillar has no direction. A visibility of nought makes the start pin it again.
        if (shell.pinned(v))
            continue;
        const Vec3d arm = Vec3d(shell.inner[v]) - Vec3d(shell.outer[v]);
        pillars.directions.inward[v] = arm / arm.length();
        pillars.directions.visibility[v] = 1.0; // of no account but for its sign
        pillars.length[v] = factor * arm.length();
    }
    return pillars;
}

GrowState state_of(const growth::Connectivity& connectivity, const PrismShell& shell,
                   const PrismSplit& split, const Pillars& pillars, PrismTest test)
{
    // The scaled lengths are the caps too, so no test can be passed by a longer pillar.
    GrowState s = growth::make_state(connectivity, shell.outer, pillars.length);
    s.twelve = test == PrismTest::twelve_tets;
    s.order = growth::order_indices(split.order);
    return s;
}

} // namespace

OptionList describe(ScaleOptions& o)
{
    return in_group("Layers", {option("factor", o.factor, "--thickness-scale",
                                      "Share of each pillar's length to keep after growth")
                                   .in(Unit::share)
                                   .within(above(0).at_most(1))});
}

void require_sensible(const ScaleOptions& options)
{
    require_in_range(options, "thickness scale");
}

ScaleReport scale_thickness(PrismShell& shell, const PrismSplit& split, const ScaleOptions& options,
                            PrismTest test, Interrupter* interrupter)
{
    require_sensible(options);
    assert(split.order.size() == shell.triangles.size());
    ScaleReport report;
    if (options.factor == 1.0)
        return report;
    const StageProgress progress(interrupter, "scale");
    const Pillars pillars = scaled_pillars(shell, options.factor);
    const growth::Connectivity connectivity = growth::connect(shell.outer.size(), shell.triangles);
    GrowState s = state_of(connectivity, shell, split, pillars, test);
    growth::shrink_until_valid(s, pillars.directions, pillars.length, progress);
    for (std::size_t v = 0; v < shell.outer.size(); ++v) {
        if (shell.pinned(v))
            continue;
        // The state holds float32 values in doubles, so nothing is rounded here.
        const Vec3s inner(s.b[v]);
        // Compared with the point and not with the length: two lengths may round to the same
        // float32 point, and then nothing had to give way.
        report.shortened +=
            inner != end_of_pillar(shell.outer[v], pillars.directions.inward[v], pillars.length[v]);
        shell.inner[v] = s.pinned[v] ? shell.outer[v] : inner;
        if (s.pinned[v]) {
            shell.stop[v] = StopReason::pinned;
            ++report.pinned;
        }
    }
    return report;
}

} // namespace vdb_shell
