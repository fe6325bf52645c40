// SPDX-License-Identifier: Apache-2.0

// Volumes of any origin. A shell's own .vdb goes through write/vdb_file.h, which knows what has to
// be in it.

#include "vdb_shell/io/volume_file.h"

#include "core/grid_instances.h"
#include "core/point_grid_instances.h"
#include "io/vdb_archive.h"
#include "io/vdb_grids.h"
#include "io/vdb_seal.h"
#include "io/volume_types.h"
#include "vdb_shell/core/error.h"
#include "vdb_shell/core/output_set.h"
#include "vdb_shell/io/read_file.h"

#include <set>

namespace vdb_shell
{
namespace
{

using openvdb::GridBase;

/// For messages.
std::string text_of(GridKinds kinds)
{
    const std::string volume = "volume of floats, vectors or whole numbers";
    return kinds == GridKinds::volumes ? volume : volume + ", nor of points";
}

std::vector<GridBasePtr> read_opened(openvdb::io::File& file, const std::string& path,
                                     std::vector<std::string> names, GridKinds kinds)
{
    const openvdb::GridPtrVecPtr all = file.readAllGridMetadata();
    if (names.empty())
        for (const GridBase::Ptr& grid : *all)
            if (is_volume(*grid, kinds))
                names.push_back(grid->getName());
    if (names.empty())
        throw ReadError(path + ": has no " + text_of(kinds) + "; it has " + list_of(*all));
    std::vector<GridBasePtr> grids;
    for (const std::string& name : names) {
        // By its metadata: grids of other types have not been walked, and nothing may decode them.
        if (!is_volume(*grid_of_name(*all, name, path), kinds))
            throw ReadError(path + ": grid " + vdb_shell::quoted(name) + " is no " +
                            text_of(kinds) + "; the file has " + list_of(*all));
        grids.push_back(file.readGrid(name));
    }
    return grids;
}

} // namespace

bool is_volume(const GridBase& grid, GridKinds kinds)
{
    return grid.apply<VolumeTypes>([](const auto&) {
    }) || (kinds == GridKinds::volumes_and_points && grid.isType<openvdb::points::PointDataGrid>());
}

std::vector<GridBasePtr> read_volumes(const std::filesystem::path& path,
                                      const std::vector<std::string>& names, GridKinds kinds)
{
    return reading_vdb(path, [&] {
        openvdb::io::File file(path.string());
        open_vdb(file);
        return read_opened(file, path.string(), names, kinds);
    });
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
