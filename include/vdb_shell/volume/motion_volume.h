// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/core/grid_types.h"
#include "vdb_shell/core/interrupter.h"
#include "vdb_shell/volume/shell_map.h"

namespace vdb_shell
{

/// The name that velocities have, of volumes as of attributes.
inline constexpr const char* kVelocityName = "v";

/// A shell with velocities in the place of points, so that ShellMap::point_of gives the velocity at
/// a place: both kinds of places are linear in the shell's points.
///
/// `stack` and `tets` are those of the posed shell, `by_tet_point` velocities by point of the tets,
/// `by_surface` by surface and vertex (ShellFile::rest.velocity).
ShellMap velocity_map(ShellStack stack, TetMesh tets,
                      const std::vector<std::vector<openvdb::Vec3s>>& by_surface,
                      std::vector<openvdb::Vec3s> by_tet_point);

/// How fast a shell moves, over the active voxels of a volume that lies in it: a grid "v" of
/// vectors of three floats (contravariant relative), in world units a second, on the volume's
/// lattice, for motion blur. Voxels outside the posed shell have none. Same bits for any number of
/// threads. `shift` as in deform_volume. Throws InvalidOption as deform_volume for types and
/// transforms; Cancelled.
GridBasePtr motion_volume(const openvdb::GridBase& volume, const ShellMap& posed,
                          const ShellMap& velocity, const openvdb::Vec3d& shift,
                          Interrupter* interrupter = nullptr);

} // namespace vdb_shell
