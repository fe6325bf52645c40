// SPDX-License-Identifier: Apache-2.0

// Takes a mesh and says what float32 leaves of its coordinates. The spacing of floats grows with
// their size, so an object far from the origin stands on a coarse lattice however small it is. What
// counts is the farthest coordinate, where the spacing is largest, against the object's own size:
// the binary digits that its longest side has are the logarithm of their ratio, about 24 around the
// origin.

#include "inspect/marks.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vdb_shell
{

using openvdb::Vec3d;

FloatLimits float_limits(const TriangleMesh& mesh)
{
    FloatLimits limits;
    if (mesh.points.empty())
        return limits;
    float farthest = 0;
    for (const openvdb::Vec3s& p : mesh.points)
        for (int axis = 0; axis < 3; ++axis)
            farthest = std::max(farthest, std::abs(p[axis]));
    // The spacing just beyond the farthest coordinate. At a power of two the one below it is half
    // as large; the larger one is told.
    const float next = std::nextafter(farthest, std::numeric_limits<float>::infinity());
    limits.farthest = farthest;
    limits.spacing = double(next) - double(farthest);
    const Bounds bounds = bounds_of(mesh.points);
    const Vec3d size = bounds.high - bounds.low;
    const double longest = std::max({size[0], size[1], size[2]});
    limits.longest_side = longest;
    if (longest > 0)
        limits.digits = static_cast<int>(std::lround(std::log2(longest / limits.spacing)));
    double shortest = std::numeric_limits<double>::infinity();
    for (const openvdb::Vec3I& t : mesh.triangles)
        for (int side = 0; side < 3; ++side) {
            const double length =
                (Vec3d(mesh.points[t[side]]) - Vec3d(mesh.points[t[(side + 1) % 3]])).length();
            // Edges without length are a defect of their own, and would hide the shortest real one.
            if (length > 0)
                shortest = std::min(shortest, length);
        }
    limits.shortest_edge = std::isfinite(shortest) ? shortest : 0;
    return limits;
}

} // namespace vdb_shell
