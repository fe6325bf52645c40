// SPDX-License-Identifier: Apache-2.0

// Takes: a point, a unit direction and a length. Gives: the end of the pillar as a float32 point,
// so that the pillar is not longer than the length, in exact arithmetic and by the double formula
// that reports use. Rounding to the nearest point can make a pillar longer than its bound by the
// last bit, and a user's thickness, or a cap, is a promise; so a point that is too far is stepped
// back by single floats. Lengths are in world units. Each vertex is by itself, so the number of
// threads changes nothing.

#include "vdb_shell/shell/prism_shell.h"

#include "core/exact.h"
#include "core/parallel.h"
#include "shell/pillar.h"

#include <cassert>
#include <cmath>

namespace vdb_shell
{
namespace
{

using openvdb::Vec3d;
using openvdb::Vec3s;

/// Moves the component that is farthest beyond `target` (seen from `outer`) one float32 back.
void step_back(const Vec3s& outer, const Vec3d& target, Vec3s& inner)
{
    int worst = -1;
    double worst_excess = 0;
    for (int axis = 0; axis < 3; ++axis) {
        // A component that has come back to the outer point cannot shorten the pillar any more.
        if (inner[axis] == outer[axis])
            continue;
        const double excess =
            std::abs(double(inner[axis]) - outer[axis]) - std::abs(target[axis] - outer[axis]);
        if (worst < 0 || excess > worst_excess) {
            worst = axis;
            worst_excess = excess;
        }
    }
    // Some component differs, for the caller steps back only while the two points are different.
    assert(worst >= 0);
    inner[worst] = std::nextafter(inner[worst], outer[worst]);
}

} // namespace

Vec3s end_of_pillar(const Vec3s& outer, const Vec3d& inward, double length)
{
    const Vec3d target = Vec3d(outer) + length * inward;
    Vec3s inner(target);
    // After one step per axis every component is rounded towards the outer point; then only the
    // last bit of the direction's own norm can be left, so this ends within a few steps.
    while (inner != outer && exact::longer_than(outer, inner, length))
        step_back(outer, target, inner);
    // A coordinate of -0 may have become 0 in the sum. Both compare equal, but shell/pillar.h
    // promises the bits of the outer point.
    return inner == outer ? outer : inner;
}

PrismShell extrude(const TriangleMesh& mesh, const Directions& directions,
                   const LineLengths& lengths)
{
    const std::size_t vertices = mesh.points.size();
    assert(directions.inward.size() == vertices);
    assert(lengths.length.size() == vertices && lengths.reason.size() == vertices);
    PrismShell shell{mesh.points, mesh.points, mesh.triangles, lengths.reason};
    for_each_index(vertices, [&](std::size_t v) {
        assert(std::isfinite(lengths.length[v]) && lengths.length[v] >= 0);
        shell.inner[v] = end_of_pillar(mesh.points[v], directions.inward[v], lengths.length[v]);
    });
    return shell;
}

TriangleMesh inner_surface(const PrismShell& shell)
{
    return {shell.inner, shell.triangles};
}

} // namespace vdb_shell
