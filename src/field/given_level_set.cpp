// SPDX-License-Identifier: Apache-2.0
// Reads a level set that some other tool has written, refuses what cannot be meshed, and says
// whether lines can step through the field itself or need a new one. What passes has finite values
// of both signs, a positive background and a linear transform; nothing else is taken for granted.
// Messages name the file, the grid and the property, since the file is somebody else's.
// docs/stages/wrap.md, "Level sets as input", has the table of what is refused and what is made
// anew.

#include "vdb_shell/field/given_level_set.h"

#include "core/text_stream.h"
#include "field/field_sampler.h"
#include "field/value_range.h"
#include "io/vdb_grids.h"
#include "vdb_shell/core/error.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace vdb_shell
{

using openvdb::FloatGrid;
using openvdb::GridBase;
using openvdb::Vec3d;

namespace
{

// Three voxels of band, less what rounding takes of them.
constexpr double kExteriorVoxels = 2.99;
// By how much the squares of a voxel's sides and their products may differ from those of a cube, as
// a share: matrices are often written from float32.
constexpr double kCubeTolerance = 1e-5;
// A distance has slope 1. At creases the sampled slope is less, so it is the median over the
// surface that has to lie between these.
constexpr double kLeastSlope = 0.8, kMostSlope = 1.25;

template <typename... Parts> std::string text(const Parts&... parts)
{
    OutText out;
    (out << ... << parts);
    return out.str();
}

bool is_level_set(const GridBase& grid)
{
    return grid.isType<FloatGrid>() && grid.getGridClass() == openvdb::GRID_LEVEL_SET;
}

/// The name to read, when none is given: the only level set's; of a file without any, the only
/// float grid's, which is then refused for what it is.
std::string only_level_set(const openvdb::GridPtrVec& grids, const std::string& file)
{
    std::vector<std::string> level_sets, floats;
    for (const GridBase::Ptr& grid : grids) {
        if (is_level_set(*grid))
            level_sets.push_back(grid->getName());
        if (grid->isType<FloatGrid>())
            floats.push_back(grid->getName());
    }
    const std::vector<std::string>& choice = level_sets.empty() ? floats : level_sets;
    if (choice.size() == 1)
        return choice.front();
    throw ReadError(text(file, ": has ", level_sets.size(),
                         " float level sets, expected one or a name (FILE.vdb:GRID); it has ",
                         list_of(grids)));
}

FloatGrid::Ptr read_named(const std::string& file, const std::string& name)
{
    openvdb::io::File in(file);
    open_vdb(in);
    const openvdb::GridPtrVecPtr grids = in.readAllGridMetadata();
    const std::string chosen = name.empty() ? only_level_set(*grids, file) : name;
    // The type is looked at before the voxels are read: a wrong grid may be a large one.
    const GridBase::Ptr metadata = grid_of_name(*grids, chosen, file);
    if (!metadata->isType<FloatGrid>())
        throw ReadError(text(file, ": grid \"", chosen, "\" holds ", metadata->valueType(),
                             " values, a level set of floats is wanted; it has ", list_of(*grids)));
    return openvdb::gridPtrCast<FloatGrid>(in.readGrid(chosen));
}

/// Edges of a voxel, in world units.
std::array<Vec3d, 3> voxel_edges(const FloatGrid& grid)
{
    const auto& map = *grid.transform().baseMap();
    return {map.applyJacobian(Vec3d(1, 0, 0)), map.applyJacobian(Vec3d(0, 1, 0)),
            map.applyJacobian(Vec3d(0, 0, 1))};
}

bool has_cubic_voxels(const FloatGrid& grid)
{
    const auto edges = voxel_edges(grid);
    const double square = edges[0].lengthSqr();
    for (std::size_t i = 0; i < 3; ++i)
        if (std::abs(edges[i].lengthSqr() - square) > kCubeTolerance * square ||
            std::abs(edges[i].dot(edges[(i + 1) % 3])) > kCubeTolerance * square)
            return false;
    return true;
}

/// Inactive voxels and tiles inside stand for any depth beyond the band. Where there are none, the
/// deepest value there is tells how deep the solid is, and no line can go deeper.
bool all_inside_is_active(const FloatGrid& grid)
{
    for (auto value = grid.cbeginValueOff(); value; ++value)
        if (*value < 0)
            return false;
    return true;
}

double median_slope(const FloatGrid& grid, const TriangleMesh& surface)
{
    FieldSampler field(grid);
    std::vector<double> slopes;
    for (const openvdb::Vec3s& point : surface.points)
        slopes.push_back(field.at(Vec3d(point)).gradient.length());
    const auto middle = slopes.begin() + static_cast<std::ptrdiff_t>(slopes.size() / 2);
    std::nth_element(slopes.begin(), middle, slopes.end());
    return *middle;
}

} // namespace

openvdb::FloatGrid::Ptr read_level_set(const std::filesystem::path& path, const std::string& name)
{
    FloatGrid::Ptr grid = reading_vdb(path, [&] { return read_named(path.string(), name); });
    require_level_set(*grid, text(path.string(), ": grid \"", grid->getName(), "\""));
    return grid;
}

void require_level_set(const openvdb::FloatGrid& grid, const std::string& where)
{
    const auto refuse = [&](const auto&... parts) {
        throw GeometryError(text(where, ": ", parts...));
    };
    if (grid.getGridClass() != openvdb::GRID_LEVEL_SET)
        refuse("class is ", GridBase::gridClassToString(grid.getGridClass()),
               ", a level set is wanted");
    if (!grid.transform().isLinear())
        refuse("transform is ", grid.transform().mapType(),
               ", a linear one is wanted; resample the grid");
    if (!(std::isfinite(grid.background()) && grid.background() > 0))
        refuse("background is ", grid.background(), ", must be positive and finite");
    bool inside = false, outside = false;
    // Inactive values count as well, since the flood-filled inside and outside are made of them.
    for (auto value = grid.cbeginValueAll(); value; ++value) {
        if (!std::isfinite(*value))
            refuse("value at voxel ", value.getCoord(), " is ", *value, ", must be finite");
        (*value < 0 ? inside : outside) = true;
    }
    if (!inside)
        refuse("no voxel of ", grid.activeVoxelCount(), " active ones is inside (negative)");
    if (!outside)
        refuse("no voxel of ", grid.activeVoxelCount(), " active ones is outside (positive)");
}

std::string why_not_steppable(const openvdb::FloatGrid& grid, const TriangleMesh& surface,
                              const LevelSetOptions& options)
{
    if (!has_cubic_voxels(grid)) {
        const auto edges = voxel_edges(grid);
        return text("its voxels are no cubes: edges ", edges[0].length(), " x ", edges[1].length(),
                    " x ", edges[2].length());
    }
    const double voxel = voxel_edges(grid)[0].length();
    if (options.voxel_size && std::abs(voxel / *options.voxel_size - 1.0) > kCubeTolerance)
        return text("its voxel size is ", voxel, ", ", *options.voxel_size, " is asked for");
    if (grid.background() < kExteriorVoxels * voxel)
        return text("its band outside is ", grid.background() / voxel,
                    " voxels wide, 3 are wanted");
    // No point of the solid is deeper than half the diagonal of its box, so no more is wanted.
    const double deepest = 0.5 * diagonal_of(bounds_of(surface.points));
    const double wanted = std::min(options.interior_depth.value_or(deepest), deepest);
    const double depth = -double(value_range(grid).least);
    if (depth < wanted && !all_inside_is_active(grid))
        return text("its band inside is ", depth / voxel, " voxels deep, ", wanted / voxel,
                    " are wanted");
    const double slope = median_slope(grid, surface);
    if (!(slope >= kLeastSlope && slope <= kMostSlope))
        return text("its values are no distances: slope ", slope, " at the surface");
    return {};
}

} // namespace vdb_shell
