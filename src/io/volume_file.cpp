// SPDX-License-Identifier: Apache-2.0

// Volumes of any origin. A shell's own .vdb goes through write/vdb_file.h, which knows what has to
// be in it.

#include "vdb_shell/io/volume_file.h"

#include "core/grid_instances.h"
#include "core/point_grid_instances.h"
#include "io/vdb_archive.h"
#include "io/vdb_seal.h"
#include "io/volume_types.h"
#include "vdb_shell/core/error.h"
#include "vdb_shell/core/output_set.h"
#include "vdb_shell/io/read_file.h"
#include "vdb_shell/io/vdb_header.h"

#include <openvdb/io/File.h>

#include <new>
#include <set>

namespace vdb_shell
{
namespace
{

using openvdb::GridBase;

bool is_wanted(const GridBase& grid, GridKinds kinds)
{
    return grid.apply<VolumeTypes>([](const auto&) {
    }) || (kinds == GridKinds::volumes_and_points && grid.isType<openvdb::points::PointDataGrid>());
}

/// For messages.
std::string text_of(GridKinds kinds)
{
    const std::string volume = "volume of floats, vectors or whole numbers";
    return kinds == GridKinds::volumes ? volume : volume + ", nor of points";
}

std::string list_of(const openvdb::GridPtrVec& grids)
{
    std::string list;
    for (const GridBase::Ptr& grid : grids)
        list += (list.empty() ? "" : ", ") + vdb_shell::quoted(grid->getName()) + " (" +
                grid->valueType() + ")";
    return list.empty() ? "no grids" : list;
}

std::vector<GridBasePtr> read_opened(openvdb::io::File& file, const std::string& path,
                                     std::vector<std::string> names, GridKinds kinds)
{
    const openvdb::GridPtrVecPtr all = file.readAllGridMetadata();
    const auto metadata_of = [&](const std::string& name) {
        for (const GridBase::Ptr& grid : *all)
            if (grid->getName() == name)
                return grid;
        throw ReadError(path + ": has no grid " + vdb_shell::quoted(name) + "; it has " +
                        list_of(*all));
    };
    if (names.empty())
        for (const GridBase::Ptr& grid : *all)
            if (is_wanted(*grid, kinds))
                names.push_back(grid->getName());
    if (names.empty())
        throw ReadError(path + ": has no " + text_of(kinds) + "; it has " + list_of(*all));
    std::vector<GridBasePtr> grids;
    for (const std::string& name : names) {
        // By its metadata: grids of other types have not been walked, and nothing may decode them.
        if (!is_wanted(*metadata_of(name), kinds))
            throw ReadError(path + ": grid " + vdb_shell::quoted(name) + " is no " +
                            text_of(kinds) + "; the file has " + list_of(*all));
        grids.push_back(file.readGrid(name));
    }
    return grids;
}

} // namespace

std::vector<GridBasePtr> read_volumes(const std::filesystem::path& path,
                                      const std::vector<std::string>& names, GridKinds kinds)
{
    openvdb::initialize();
    try {
        require_whole_vdb(path);
        openvdb::io::File file(path.string());
        // Delayed loading would find damage at the first access to a voxel, outside of this.
        file.open(/*delayLoad=*/false);
        return read_opened(file, path.string(), names, kinds);
    } catch (const Error&) {
        throw;
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& error) {
        throw ReadError(path.string() + ": cannot be read: " + error.what());
    }
}

void write_volumes(const std::filesystem::path& path, const std::vector<GridBasePtr>& grids,
                   OutputSet* with)
{
    std::set<std::string> names;
    for (const GridBasePtr& grid : grids)
        // OpenVDB would tell them apart by a number that readers do not see, and Houdini renames
        // them.
        if (!names.insert(grid->getName()).second)
            throw InvalidOption(path.string() + ": two grids of the name " +
                                vdb_shell::quoted(grid->getName()));
    openvdb::initialize();
    openvdb::MetaMap metadata;
    metadata.insertMeta("creator", openvdb::StringMetadata(creator_name()));
    for (const GridBasePtr& grid : grids)
        grid->setCreator(creator_name());
    write_together(with, [&](OutputSet& set) {
        set.write(path, [&](const std::filesystem::path& temporary) {
            seal_vdb(temporary,
                     write_vdb_archive(temporary, {grids.begin(), grids.end()}, metadata));
        });
    });
}

} // namespace vdb_shell
