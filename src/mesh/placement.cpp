// SPDX-License-Identifier: Apache-2.0

// Chooses the origin and the unit in which an object is read. Both are numbers of few binary
// digits, a multiple of a power of two and a power of two: dividing by the unit and multiplying by
// it again is exact in doubles, and the few digits of the origin keep differences from it nearly
// exact. Near the origin nothing moves, so that ordinary files are not changed by the option.

#include "vdb_shell/mesh/placement.h"

#include <algorithm>
#include <cmath>

namespace vdb_shell
{

Placement placement_for(const Bounds& box, bool recentre, bool rescale)
{
    Placement placement;
    const openvdb::Vec3d size = box.high - box.low;
    const double longest = std::max({size[0], size[1], size[2]});
    // Also for no points at all, whose box runs from plus to minus infinity.
    if (!(longest > 0) || !std::isfinite(longest))
        return placement;
    // Directly below a power of two the logarithm may round up to it. The unit is then twice what
    // it should be, which does no harm.
    const double unit = std::exp2(std::floor(std::log2(longest)));
    if (recentre) {
        const double step = 2 * unit;
        for (int axis = 0; axis < 3; ++axis)
            // The sum turns -0 into 0.
            placement.origin[axis] =
                std::round(0.5 * (box.low[axis] + box.high[axis]) / step) * step + 0.0;
    }
    if (rescale)
        placement.unit = unit;
    return placement;
}

void bring_into(const Placement& placement, const Placement& own,
                std::vector<openvdb::Vec3s>& points)
{
    if (!placement.moves() && !own.moves())
        return;
    for (openvdb::Vec3s& p : points)
        p = openvdb::Vec3s((own.in_file(p) - placement.origin) / placement.unit);
}

} // namespace vdb_shell
