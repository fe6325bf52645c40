// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "command/build_command.h"

#include <array>
#include <string>
#include <vector>

namespace vdb_shell::command
{

class Call;
struct DeformArguments;
struct PoseArguments;

/// What a call would cost, by a model that was fitted to measured ones. docs/farm.md has its errors
/// for each kind of call, the largest included: seconds are a guess, memory is nearly right.
struct CallCost {
    std::string file;       ///< what the call is told of by
    double triangles = 0;   ///< that the shell is made of
    double voxel_size = 0;  ///< world units; 0: there are no volumes
    double cpu_seconds = 0; ///< on one thread
    double memory = 0;      ///< peak, bytes
    double disk = 0;        ///< all outputs, bytes
    /// Options of the call that the model does not know, and whose cost comes on top.
    std::vector<std::string> not_counted;

    double seconds(int threads) const;
};

/// Reads the surface; makes nothing of it. Throws what reading throws, InvalidOption for a level
/// set.
CallCost estimate_build(const BuildArguments& arguments);
/// Reads shell and surface. Throws what `pose` throws before it begins.
CallCost estimate_pose(const PoseArguments& arguments);
/// Reads shell and volumes. Throws what reading throws.
CallCost estimate_deform(const DeformArguments& arguments);

/// The commands that the model knows.
inline constexpr std::array<const char*, 3> kModelled{"build", "pose", "deform"};
bool is_modelled(const std::string& command);
/// Of a call of one of them, after its plan().
CallCost estimate_call(const Call& call);

} // namespace vdb_shell::command
