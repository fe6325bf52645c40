// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/grid_instances.h"

#include <string>
#include <vector>

namespace vdb_shell
{

/// A part of a file, "surface", "shell_points.rest", and the digest of what it holds.
struct NamedDigest {
    std::string name;
    std::string hex;
};

/// Digests of a grid of floats or points: its name, type, transform, metadata, topology, background
/// and values, and apart from that each attribute of points. Of what the grid means, not of how it
/// is stored: a grid has the same before it is written (floats as half floats if they will be saved
/// so) and after it was read, from this library's file or from one that another program wrote of
/// it. Zeros of either sign count as the same value, for OpenVDB does not keep the sign of inactive
/// ones. Same for any number of threads. Empty for other types of grids.
std::vector<NamedDigest> digests_of(const openvdb::GridBase& grid);

/// Of a file's metadata: those that describe a shell, but not the entry `except`.
NamedDigest digest_of_metadata(const openvdb::MetaMap& metadata, const std::string& except);

} // namespace vdb_shell
