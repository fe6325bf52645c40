// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/grid_instances.h"

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace vdb_shell
{

/// "vdb_shell" and the version: what files and grids name as their creator.
std::string creator_name();

/// The bytes of a .vdb that was written, without those of its grids.
struct VdbArchive {
    struct Grid {
        std::string name;
        std::array<std::uint64_t, 2> digest; ///< of all its bytes, from its descriptor on
    };
    std::string head; ///< all bytes before the first grid
    std::vector<Grid> grids;
    std::uint64_t size = 0; ///< of the file
};

/// Writes what openvdb::io::File would write with Blosc and active masks, byte for byte but for the
/// random UUID, on all threads: OpenVDB compresses leaf by leaf on one, and each leaf twice, the
/// first time only to learn its size. Keeps two compressed grids in memory, one that is written and
/// the next one, and lets go of a grid as soon as it is written. Preconditions: grids are not null,
/// their names are not empty and differ, and no two share a tree. Throws std::runtime_error with
/// the system's reason when the file cannot be written.
VdbArchive write_vdb_archive(const std::filesystem::path& path, openvdb::GridPtrVec grids,
                             const openvdb::MetaMap& metadata);

} // namespace vdb_shell
