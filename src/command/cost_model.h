// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "command/build_command.h"

#include <string>
#include <vector>

namespace vdb_shell::command
{

/// What a build would cost, by a model that was fitted to measured builds (docs/farm.md has its
/// errors: seconds within a factor of two, memory within a fifth, files within a factor of three).
struct BuildCost {
    double triangles = 0;   ///< that the shell is made of
    double voxel_size = 0;  ///< world units
    double cpu_seconds = 0; ///< on one thread
    double memory = 0;      ///< peak, bytes
    double disk = 0;        ///< all outputs, bytes
    /// Options of the call that the model does not know, and whose cost comes on top.
    std::vector<std::string> not_counted;

    double seconds(int threads) const;
};

/// Reads the surface; makes nothing of it. Throws what reading throws, InvalidOption for a level
/// set.
BuildCost estimate_build(const BuildArguments& arguments);

} // namespace vdb_shell::command
