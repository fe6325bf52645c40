// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "support/shapes.h"
#include "support/shells.h"

#include "vdb_shell/shell/tessellate.h"

#include <random>
#include <set>

// Shells that are wrong in one way each, and the sound ones that they are made from.

namespace vdb_shell::test
{

struct SplitShell {
    PrismShell shell;
    PrismSplit split;
};

inline SplitShell with_split(PrismShell shell)
{
    PrismSplit split = split_prisms(shell, {SplitRule::vertex_index, 1});
    return {std::move(shell), std::move(split)};
}

/// Inner vertices moved from outer ones by a formula on position; equal ones are pinned.
template <typename Move> SplitShell moved_shell(const TriangleMesh& mesh, const Move& inner_of)
{
    PrismShell shell{mesh.points, mesh.points, mesh.triangles, {}};
    for (openvdb::Vec3s& p : shell.inner)
        p = inner_of(p);
    shell.stop.assign(mesh.points.size(), StopReason::thickness);
    return with_split(std::move(shell));
}

inline SplitShell scaled_shell(const TriangleMesh& mesh, float factor)
{
    return moved_shell(mesh, [=](const openvdb::Vec3s& p) { return p * factor; });
}

/// Two shells side by side in one.
inline SplitShell joined(const SplitShell& first, const SplitShell& second)
{
    SplitShell both = first;
    const auto append = [](auto& to, const auto& from) {
        to.insert(to.end(), from.begin(), from.end());
    };
    const auto shift = static_cast<std::uint32_t>(first.shell.outer.size());
    append(both.shell.outer, second.shell.outer);
    append(both.shell.inner, second.shell.inner);
    append(both.shell.stop, second.shell.stop);
    append(both.split.order, second.split.order);
    for (const openvdb::Vec3I& t : second.shell.triangles)
        both.shell.triangles.emplace_back(t[0] + shift, t[1] + shift, t[2] + shift);
    return both;
}

/// The inner surface turned about z: embedded and disjoint from the outer one, but every prism
/// twisted.
inline SplitShell twisted_shell(double radians)
{
    const auto c = static_cast<float>(std::cos(radians)), s = static_cast<float>(std::sin(radians));
    return moved_shell(icosphere(1, 1), [=](const openvdb::Vec3s& p) {
        return openvdb::Vec3s(c * p[0] - s * p[1], s * p[0] + c * p[1], p[2]) * 0.5f;
    });
}

/// The inner points of a cube scattered at random, the same for each seed: some of these shells are
/// valid with their own diagonals and with no others.
inline SplitShell scattered_shell(unsigned seed)
{
    const TriangleMesh cube = box(openvdb::Vec3d(-1), openvdb::Vec3d(1));
    PrismShell shell{cube.points, cube.points, cube.triangles, {}};
    shell.stop.assign(cube.points.size(), StopReason::prism);
    std::minstd_rand random(seed + 1);
    for (openvdb::Vec3s& p : shell.inner)
        for (int k = 0; k < 3; ++k)
            p[k] = 0.3f * p[k] + 0.5f * (float(random()) / float(random.max()) - 0.5f);
    return with_split(std::move(shell));
}

/// A double pyramid, pinned at both ends of the edge {0, 1}. The inner triangles 0 and 3 beside it
/// lie folded onto each other in the plane z = 0, one inside the other; every tet is positive.
inline SplitShell folded_shell()
{
    const TriangleMesh mesh{{{-6, -4, 0}, {6, -4, 0}, {0, 8, -3.375f}, {0, 0, 3}, {0, 0, -3}},
                            {{3, 0, 1}, {3, 1, 2}, {3, 2, 0}, {4, 1, 0}, {4, 2, 1}, {4, 0, 2}}};
    PrismShell shell{mesh.points, mesh.points, mesh.triangles, {}};
    shell.inner[2] = {0, 1, -0.75f};
    shell.inner[3] = {0, 0.125f, 0};
    shell.inner[4] = {0, -2.25f, 0};
    shell.stop.assign(5, StopReason::thickness);
    return with_split(std::move(shell));
}

/// A plate of 4 x 4 x 1. Points of the rim move inward by 0.1 a side; those inside the upper and
/// the lower face straight down and up by the given lengths.
inline SplitShell plate_shell(float down, float up)
{
    const TriangleMesh plate = gridded_box({0, 0, 0}, {4, 4, 1}, 4);
    return moved_shell(plate, [=](const openvdb::Vec3s& p) {
        const bool rim = p[0] == 0 || p[0] == 4 || p[1] == 0 || p[1] == 4;
        openvdb::Vec3s inner = p;
        if (!rim)
            inner[2] = p[2] == 1 ? 1 - down : up;
        else
            for (int k = 0; k < 3; ++k) {
                const float high = k == 2 ? 1.0f : 4.0f;
                inner[k] += p[k] == 0 ? 0.1f : p[k] == high ? -0.1f : 0.0f;
            }
        return inner;
    });
}

/// The lower face and the sides are pinned, and the inner surface of the upper one is bent through
/// the lower one.
inline SplitShell pierced_shell()
{
    const TriangleMesh plate = gridded_box({0, 0, 0}, {4, 4, 1}, 4);
    return moved_shell(plate, [=](const openvdb::Vec3s& p) {
        const bool rim = p[0] == 0 || p[0] == 4 || p[1] == 0 || p[1] == 4;
        return rim || p[2] < 1 ? p : openvdb::Vec3s(p[0], p[1], -0.25f);
    });
}

/// Two unit cubes that overlap by a corner of 0.1; all is pinned but their far corners.
inline SplitShell crossing_shell()
{
    const auto cube = [](double low, float corner, float inward) {
        return moved_shell(box(openvdb::Vec3d(low), openvdb::Vec3d(low + 1)),
                           [=](const openvdb::Vec3s& p) {
                               const bool moves = p == openvdb::Vec3s(corner);
                               return moves ? p + openvdb::Vec3s(inward) : p;
                           });
    };
    return joined(cube(0, 0.0f, 0.2f), cube(0.9, 1.9f, -0.2f));
}

/// A small ball with its own shell inside the shell of a large one.
inline SplitShell swallowed_shell()
{
    SplitShell small = scaled_shell(icosphere(0.05, 1), 0.5f);
    for (auto* points : {&small.shell.outer, &small.shell.inner})
        for (openvdb::Vec3s& p : *points)
            p += openvdb::Vec3s(0.75f, 0, 0);
    return joined(scaled_shell(icosphere(1, 2), 0.5f), small);
}

/// One prism whose order differs from its neighbours' over the edge of its first two corners only.
inline SplitShell disagreeing_shell(std::size_t prism)
{
    SplitShell made = scaled_shell(icosphere(1, 1), 0.5f);
    std::swap(made.split.order[prism][0], made.split.order[prism][1]);
    return made;
}

inline SplitShell open_shell()
{
    return scaled_shell(without_triangle(icosphere(1, 1), 7), 0.5f);
}

/// The inner surface reflected in the centre.
inline SplitShell inside_out_shell()
{
    return scaled_shell(icosphere(1, 1), -0.5f);
}

/// A box whose pillars are one float long along each axis: no point lies between their ends.
inline SplitShell one_float_shell()
{
    const float low = 8388608; // 2^23, from where floats are whole numbers
    return moved_shell(box(openvdb::Vec3d(low), openvdb::Vec3d(low + 16.0)), [=](openvdb::Vec3s p) {
        for (int k = 0; k < 3; ++k)
            p[k] += p[k] == low ? 1.0f : -1.0f;
        return p;
    });
}

/// Of a ball, sound, with every fifth vertex pinned.
inline SplitShell pinned_shell()
{
    return with_split(
        radial_shell(icosphere(1, 2), [](std::size_t v) { return v % 5 == 0 ? 0.0 : 0.4; }));
}

} // namespace vdb_shell::test
