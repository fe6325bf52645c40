// SPDX-License-Identifier: Apache-2.0

// Times `map_volume` on a shell: map_probe SHELL.vdb. Prints one JSON object;
// docs/scripts/map_figures.py makes a page of several.

#include "benchmarks/resampling.h"
#include "vdb_shell/volume/map_volume.h"
#include "vdb_shell/write/vdb_file.h"

#include <openvdb/openvdb.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace
{

using namespace vdb_shell;
using openvdb::FloatGrid;
using openvdb::Vec3d;

constexpr int kTile = 64; // voxels a side

FloatGrid::Ptr tile()
{
    const auto grid = FloatGrid::create();
    grid->setName("density");
    for (int x = 0; x < kTile; ++x)
        for (int y = 0; y < kTile; ++y)
            for (int z = 0; z < kTile; ++z)
                grid->tree().setValue({x, y, z}, float(2 + std::sin(0.3 * x) * std::cos(0.5 * y) +
                                                       std::sin(0.2 * z)));
    return grid;
}

/// Each triangle along the axis that its normal is nearest to; one for the length of a tile of the
/// shell's voxels.
std::vector<std::array<openvdb::Vec2d, 3>> projected(const ShellStack& stack, double tile_length)
{
    const std::vector<openvdb::Vec3s>& points = stack.surface(stack.skin);
    std::vector<std::array<openvdb::Vec2d, 3>> corners;
    for (const openvdb::Vec3I& t : stack.triangles()) {
        const Vec3d a(points[t[0]]), b(points[t[1]]), c(points[t[2]]);
        const Vec3d normal = (b - a).cross(c - a);
        const int axis = int(openvdb::math::MaxIndex(openvdb::math::Abs(normal)));
        const int u = (axis + 1) % 3, v = (axis + 2) % 3;
        auto& corner = corners.emplace_back();
        for (int k = 0; k < 3; ++k)
            corner[std::size_t(k)] = openvdb::Vec2d(points[t[k]][u], points[t[k]][v]) / tile_length;
    }
    return corners;
}

} // namespace

int main(int count, char** words)
{
    if (count != 2) {
        std::fprintf(stderr, "usage: map_probe SHELL.vdb\n");
        return 2;
    }
    openvdb::initialize();
    const ShellFile file = read_shell_vdb(words[1]);
    const ShellMap map(file.stack, file.tets);
    MapOptions filtered;
    filtered.voxel_size = file.surface->voxelSize()[0];
    MapOptions single = filtered;
    single.most_samples = 1;
    const auto corner = projected(file.stack, kTile * filtered.voxel_size);
    const FloatGrid::Ptr texture = tile();
    MapFigures figures;
    double with = 1e30, without = 1e30;
    Resampling resampling;
    // The best of three of each: the machine does other things as well.
    for (int i = 0; i < 3; ++i) {
        GridBasePtr made;
        without = std::min(
            without, seconds([&] { made = map_volume(*texture, map, corner, single, figures); }));
        with = std::min(
            with, seconds([&] { made = map_volume(*texture, map, corner, filtered, figures); }));
        resampling.measure(*openvdb::gridPtrCast<FloatGrid>(made));
    }
    const double voxels = double(figures.active), each = resampling.per_voxel();
    std::printf("{\"voxels\": %zu, \"stretch\": %.4g, \"limited_samples\": %zu, "
                "\"ratio_single\": %.4g, \"ratio_filtered\": %.4g, \"seconds\": %.4g}\n",
                figures.active, figures.stretch, figures.limited_samples, without / voxels / each,
                with / voxels / each, with);
    return 0;
}
