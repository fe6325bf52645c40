// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/grid_instances.h"
#include "write/grid_digest.h"

#include <filesystem>
#include <vector>

namespace vdb_shell
{

/// Adds the entry with the digests of these grids, their attributes and the metadata, with room for
/// those of the bytes (io/vdb_seal.h). Nothing may be changed afterwards.
void add_digests(openvdb::MetaMap& metadata, const openvdb::GridPtrVec& grids);

/// What a file states of its parts.
class StatedDigests
{
public:
    /// None where the file has no entry. Throws ReadError for one that cannot be read or is lost,
    /// and where the metadata are not those that were written.
    StatedDigests(const openvdb::MetaMap& metadata, std::filesystem::path path);

    /// Throws ReadError with grid and attribute unless the grid is the one that was written.
    void require(const openvdb::GridBase& grid) const;

    std::size_t count() const { return stated_.size(); }

private:
    void require_same(const NamedDigest& found) const;
    std::filesystem::path path_;
    std::vector<NamedDigest> stated_;
};

} // namespace vdb_shell
