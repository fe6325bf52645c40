// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/grid_instances.h"
#include "vdb_shell/core/error.h"
#include "vdb_shell/io/vdb_header.h"

#include <openvdb/io/File.h>

#include <filesystem>
#include <new>
#include <string>

namespace vdb_shell
{

/// Without delayed loading, which would keep the file mapped, so that damage is found late and in
/// the wrong place: at the first access to a voxel, outside of reading_vdb().
void open_vdb(openvdb::io::File& file);

/// For messages: the grids' names, with the type of their values and their class.
std::string list_of(const openvdb::GridPtrVec& grids);

/// The one of that name; `file` opens the messages. Throws ReadError, with the grids that there
/// are, for a name that none has or several have: OpenVDB would take the first of these and say so
/// on stderr.
openvdb::GridBase::Ptr grid_of_name(const openvdb::GridPtrVec& grids, const std::string& name,
                                    const std::string& file);

/// Runs `read` on a file that require_whole_vdb has passed, turning what OpenVDB throws at damaged
/// data into ReadError. Errors of our own pass as they are, since they already name the place; so
/// does std::bad_alloc, which says nothing against the file.
template <typename Read> auto reading_vdb(const std::filesystem::path& path, const Read& read)
{
    openvdb::initialize();
    try {
        require_whole_vdb(path);
        return read();
    } catch (const Error&) {
        throw;
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& error) {
        throw ReadError(path.string() + ": cannot be read: " + error.what());
    }
}

} // namespace vdb_shell
