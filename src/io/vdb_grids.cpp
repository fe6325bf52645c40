// SPDX-License-Identifier: Apache-2.0

// What all readers of .vdb files do alike before a grid is decoded.

#include "io/vdb_grids.h"

#include "vdb_shell/io/read_file.h"

#include <algorithm>

namespace vdb_shell
{

using openvdb::GridBase;

void open_vdb(openvdb::io::File& file)
{
    file.open(/*delayLoad=*/false);
}

std::string list_of(const openvdb::GridPtrVec& grids)
{
    std::string list;
    for (const GridBase::Ptr& grid : grids)
        list += (list.empty() ? "" : ", ") + vdb_shell::quoted(grid->getName()) + " (" +
                grid->valueType() + (grid->saveFloatAsHalf() ? " as half, " : ", ") +
                GridBase::gridClassToString(grid->getGridClass()) + ")";
    return list.empty() ? "no grids" : list;
}

GridBase::Ptr grid_of_name(const openvdb::GridPtrVec& grids, const std::string& name,
                           const std::string& file)
{
    const auto has_name = [&](const GridBase::Ptr& grid) { return grid->getName() == name; };
    const auto found = std::find_if(grids.begin(), grids.end(), has_name);
    if (found == grids.end())
        throw ReadError(file + ": has no grid " + vdb_shell::quoted(name) + "; it has " +
                        list_of(grids));
    if (std::any_of(found + 1, grids.end(), has_name))
        throw ReadError(file + ": has two grids of the name " + vdb_shell::quoted(name) +
                        "; it has " + list_of(grids));
    return *found;
}

} // namespace vdb_shell
