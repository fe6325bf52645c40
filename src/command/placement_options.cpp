// SPDX-License-Identifier: Apache-2.0
#include "command/placement_options.h"

#include <CLI/CLI.hpp>
#include <openvdb/tools/ChangeBackground.h>
#include <openvdb/tools/ValueTransformer.h>

#include <algorithm>
#include <iostream>
#include <optional>

namespace vdb_shell::command
{
namespace
{

void divide(std::optional<double>& length, double unit)
{
    if (length)
        *length /= unit;
}

} // namespace

void add_placement_options(CLI::App& app, ReadOptions& read, const std::string& group)
{
    app.add_flag("--recentre,--recenter", read.recentre,
                 "Read the object about a point near its middle, which the files keep: far from "
                 "the origin float32 has few digits left")
        ->group(group);
    app.add_flag("--rescale", read.rescale,
                 "Read the object in a power of two near its size, which the files keep: for "
                 "microns in metres, and sizes over 1e18")
        ->group(group);
}

LevelSetOptions in_unit(LevelSetOptions options, double unit)
{
    divide(options.voxel_size, unit);
    divide(options.exterior_depth, unit);
    divide(options.interior_depth, unit);
    return options;
}

RepairOptions in_unit(RepairOptions options, double unit)
{
    options.weld_tolerance /= unit;
    options.sliver_height /= unit;
    return options;
}

ShellOptions in_unit(ShellOptions options, double unit)
{
    options.level_set = in_unit(options.level_set, unit);
    divide(options.wrap.voxel_size, unit);
    divide(options.line_step.thickness, unit);
    if (options.repair)
        options.repair = in_unit(*options.repair, unit);
    return options;
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
