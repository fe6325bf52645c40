// SPDX-License-Identifier: Apache-2.0

// The rules for what a grid holds: its class against its values, its background and its voxels; the
// type of its vectors; and half floats. A wrong class makes no error in Houdini: the grid is just
// drawn, filtered or transformed as something that it is not (docs/vdb_conventions.md has the
// table). Only the rule of half floats looks at every value, and only at grids that say they were
// saved so.

#include "vdb_rules.h"

#include <cmath>
#include <type_traits>

namespace vdb_shell
{
namespace
{

using openvdb::GridBase;

bool is_vector(const GridBase& grid)
{
    return grid.valueType().compare(0, 4, "vec3") == 0;
}

bool has_reals(const GridBase& grid)
{
    const std::string type = grid.valueType();
    return type == "float" || type == "double" || type == "vec3s" || type == "vec3d";
}

/// The string under a key, or `otherwise` when it is missing. A wrong type counts as missing here,
/// because it is the matter of the rule "own-metadata", and one fault should be named once.
std::string text_of(const GridBase& grid, const char* key, const std::string& otherwise)
{
    const openvdb::Metadata::ConstPtr found = grid[key];
    return found && found->typeName() == "string" ? found->str() : otherwise;
}

template <typename Grid> double background_of(const GridBase& grid)
{
    return double(static_cast<const Grid&>(grid).background());
}

/// The background of a grid of one real a voxel; not a number for all others, which no class with a
/// background takes.
double real_background(const GridBase& grid)
{
    if (grid.isType<openvdb::FloatGrid>())
        return background_of<openvdb::FloatGrid>(grid);
    if (grid.isType<openvdb::DoubleGrid>())
        return background_of<openvdb::DoubleGrid>(grid);
    return std::nan("");
}

void check_level_set(const GridBase& grid, VdbViolations& found)
{
    const double background = real_background(grid);
    if (std::isnan(background))
        found.push_back({"level-set", grid.getName(), "",
                         "the value type is " + grid.valueType() + ", expected float or double"});
    // Negated, so that a background that is not a number fails as well.
    else if (!(background > 0.0) || !std::isfinite(background))
        found.push_back({"level-set", grid.getName(), "",
                         "the background is " + std::to_string(background) +
                             ", expected the width of the band outside, more than 0"});
    // Distances are world units, so a gradient by voxels is right only if all sides of a voxel are
    // equal.
    const openvdb::Vec3d voxel = grid.voxelSize();
    if (!grid.hasUniformVoxels())
        found.push_back(
            {"level-set", grid.getName(), "", "the voxel is " + voxel.str() + ", expected a cube"});
}

void check_fog_volume(const GridBase& grid, VdbViolations& found)
{
    const double background = real_background(grid);
    if (std::isnan(background))
        found.push_back({"fog-volume", grid.getName(), "",
                         "the value type is " + grid.valueType() + ", expected float or double"});
    else if (background != 0.0)
        found.push_back({"fog-volume", grid.getName(), "",
                         "the background is " + std::to_string(background) + ", expected 0"});
}

void check_class(const GridBase& grid, VdbViolations& found)
{
    const std::string text = text_of(grid, GridBase::META_GRID_CLASS, "unknown");
    // There and back: OpenVDB turns a text that it does not know into "unknown", so an unknown
    // class shows by a text that changes.
    if (GridBase::gridClassToString(GridBase::stringToGridClass(text)) != text) {
        found.push_back({"class", grid.getName(), GridBase::META_GRID_CLASS,
                         "it is \"" + text +
                             "\", expected \"level set\", \"fog volume\", "
                             "\"staggered\" or \"unknown\""});
        return;
    }
    if (text == "level set")
        check_level_set(grid, found);
    else if (text == "fog volume")
        check_fog_volume(grid, found);
    else if (text == "staggered" && !(is_vector(grid) && has_reals(grid)))
        found.push_back({"staggered", grid.getName(), "",
                         "the value type is " + grid.valueType() + ", expected vec3s or vec3d"});
}

/// How the vectors turn with their grid, by the names that tools give them; empty where the name
/// says nothing. Normals and gradients follow the surface and turn by the inverse transpose;
/// velocities and displacements turn with the points but do not move with them.
std::string wanted_vector_type(const std::string& name)
{
    if (name == "gradient" || name == "grad")
        return "covariant";
    if (name == "N" || name == "normal" || name == "normals")
        return "covariant normalize";
    if (name == "v" || name == "vel" || name == "velocity" || name == "displacement")
        return "contravariant relative";
    return {};
}

void check_vector_type(const GridBase& grid, VdbViolations& found)
{
    const char* const key = GridBase::META_VECTOR_TYPE;
    if (!is_vector(grid)) {
        if (grid[key])
            found.push_back({"vector-type", grid.getName(), key,
                             "the value type is " + grid.valueType() + ", which is no vector"});
        return;
    }
    const std::string text = text_of(grid, key, "invariant");
    if (GridBase::vecTypeToString(GridBase::stringToVecType(text)) != text) {
        found.push_back({"vector-type", grid.getName(), key,
                         "it is \"" + text + "\", which OpenVDB does not know"});
        return;
    }
    const std::string wanted = wanted_vector_type(grid.getName());
    if (!wanted.empty() && wanted != text)
        found.push_back({"vector-meaning", grid.getName(), key,
                         "it is \"" + text + "\"; of this name \"" + wanted + "\" is expected"});
}

/// Inactive values and the background count too, as they may be written as well.
struct MagnitudeOfLargest {
    double result = 0.0;
    template <typename Grid> void operator()(const Grid& grid)
    {
        for (auto value = grid.cbeginValueAll(); value; ++value)
            take(*value);
        take(grid.background());
    }
    void take(double value)
    {
        // A value that is not a number stays one in half floats, so it breaks no rule of range; the
        // comparison is false for it.
        if (std::abs(value) > result)
            result = std::abs(value);
    }
    template <typename T> void take(const openvdb::math::Vec3<T>& value)
    {
        for (int axis = 0; axis < 3; ++axis)
            take(double(value[axis]));
    }
};

void check_half(const GridBase& grid, VdbViolations& found)
{
    if (!grid.saveFloatAsHalf())
        return;
    const char* const key = GridBase::META_SAVE_HALF_FLOAT;
    if (!has_reals(grid)) {
        found.push_back(
            {"half", grid.getName(), key, "it is set, but the value type is " + grid.valueType()});
        return;
    }
    // The largest finite half float. What is larger has become infinite in the file, so the values
    // read back show it as infinity.
    constexpr double kLargestHalf = 65504.0;
    MagnitudeOfLargest magnitude;
    using Reals = openvdb::TypeList<openvdb::FloatGrid, openvdb::DoubleGrid, openvdb::Vec3SGrid,
                                    openvdb::Vec3DGrid>;
    grid.apply<Reals>(magnitude);
    if (magnitude.result > kLargestHalf)
        found.push_back(
            {"half-range", grid.getName(), key,
             "a value is " + std::to_string(magnitude.result) + ", half floats end at 65504"});
}

} // namespace

void check_values(const GridBase& grid, VdbViolations& found)
{
    check_class(grid, found);
    check_vector_type(grid, found);
    check_half(grid, found);
}

} // namespace vdb_shell
