// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "support/shapes.h"
#include "vdb_shell/volume/motion_volume.h"
#include "write/hand_made.h"

#include <functional>

// A ball's shell between radius 1 and 0.1, in poses.

namespace vdb_shell::test
{

struct Ball {
    ShellStack stack;
    TetMesh tets;
    ShellMap map() const { return {stack, tets}; }
};

inline Ball ball(const std::function<openvdb::Vec3d(const openvdb::Vec3d&)>& pose)
{
    HandMade made = hand_made_shell(icosphere(1.0, 3), 0.1);
    for (auto* points : {&made.shell.outer, &made.shell.inner, &made.tets.points})
        for (openvdb::Vec3s& p : *points)
            p = openvdb::Vec3s(pose(openvdb::Vec3d(p)));
    return {one_layer(made.shell, made.split), made.tets};
}

inline openvdb::Vec3d as_it_is(const openvdb::Vec3d& p)
{
    return p;
}

/// Turned a quarter about z, then made twice as long along x.
inline openvdb::Vec3d turned_long(const openvdb::Vec3d& p)
{
    return {-2.0 * p[1], p[0], p[2]};
}

/// The velocity of a turn about z: linear in place, so that it is exact in each prism.
inline openvdb::Vec3d turning(const openvdb::Vec3d& p)
{
    return {-p[1], p[0], 0.0};
}

inline ShellMap velocity_of_turning(const Ball& posed)
{
    const auto of = [](std::vector<openvdb::Vec3s> points) {
        for (openvdb::Vec3s& p : points)
            p = openvdb::Vec3s(turning(openvdb::Vec3d(p)));
        return points;
    };
    return velocity_map(posed.stack, posed.tets,
                        {of(posed.stack.surface(0)), of(posed.stack.surface(1))},
                        of(posed.tets.points));
}

} // namespace vdb_shell::test
