// SPDX-License-Identifier: Apache-2.0
#include "command/surface_input.h"

#include "vdb_shell/houdini/polygon_mesh.h"

#include <openvdb/tools/ChangeBackground.h>
#include <openvdb/tools/ValueTransformer.h>

#include <algorithm>
#include <iostream>

namespace vdb_shell::command
{
ReadResult read_surface(const std::filesystem::path& path, const ReadOptions& options)
{
    return houdini::has_geometry_extension(path) ? houdini::read_polygon_mesh(path, options)
                                                 : read_mesh(path, options);
}

openvdb::FloatGrid::Ptr in_place(const openvdb::FloatGrid::Ptr& grid, const Placement& placement)
{
    if (!grid || !placement.moves())
        return grid;
    auto moved = grid->deepCopy();
    moved->transform().postTranslate(-placement.origin);
    moved->transform().postScale(1.0 / placement.unit);
    const auto divided = [&](const auto& value) {
        value.setValue(static_cast<float>(double(*value) / placement.unit));
    };
    openvdb::tools::foreach (moved->beginValueAll(), divided);
    openvdb::tools::changeBackground(
        moved->tree(), static_cast<float>(double(moved->background()) / placement.unit));
    return moved;
}

void warn_of_lost_digits(const std::filesystem::path& path, const ReadResult& read)
{
    const Bounds bounds = bounds_of(read.mesh.points);
    const openvdb::Vec3d size = bounds.high - bounds.low;
    const double longest = std::max({size[0], size[1], size[2]});
    constexpr double kShare = 1.0 / (1 << 18);
    if (read.report.largest_rounding > kShare * longest)
        std::cerr << "vdb_shell: warning: " << path.string() << ": rounding to float32 moved "
                  << "coordinates by up to " << read.report.largest_rounding
                  << " of an object of size " << longest
                  << ", which lies far from the origin; --recentre keeps the digits of the file\n";
}

} // namespace vdb_shell::command
