// SPDX-License-Identifier: Apache-2.0
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
    if (!(longest > 0) || !std::isfinite(longest))
        return placement;
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

} // namespace vdb_shell
