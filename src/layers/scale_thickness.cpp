// SPDX-License-Identifier: Apache-2.0
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
    GrowState s = growth::make_state(connectivity, shell.outer, pillars.length);
    s.twelve = test == PrismTest::twelve_tets;
    for (std::size_t f = 0; f < split.order.size(); ++f)
        s.order[f] = static_cast<std::uint8_t>(growth::order_index(split.order[f]));
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
        const Vec3s inner(s.b[v]);
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
