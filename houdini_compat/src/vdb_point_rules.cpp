// SPDX-License-Identifier: Apache-2.0

// The rules for attributes of point grids: what unpacking in Houdini leaves out, shortens or
// changes. All grids of points of a file unpack into one geometry, where an attribute has one type
// and size, so clashes between grids are looked for as well. The rules come from the published
// conversion code (docs/vdb_conventions.md). Types are read from the first leaf: OpenVDB keeps the
// attributes of all leaves of a grid alike.

#include "vdb_rules.h"

#include <openvdb/points/AttributeArrayString.h>
#include <openvdb/points/AttributeGroup.h>
#include <openvdb/points/PointDataGrid.h>

#include <cstdlib>
#include <set>

namespace vdb_shell
{
namespace
{

namespace points = openvdb::points;
using openvdb::GridBase;
using points::AttributeArray;
using points::PointDataGrid;

/// The types of attributes that unpacking keeps; others are left out without a word.
bool is_kept(const std::string& type)
{
    static const std::set<std::string> kept{"string", "bool",   "int8",  "int16", "int32", "int64",
                                            "float",  "double", "vec3i", "vec3s", "vec3d", "quats",
                                            "quatd",  "mat3s",  "mat3d", "mat4s", "mat4d"};
    return kept.count(type) > 0;
}

/// Types that have a fixed number of components in Houdini. Of several values of such a type a
/// point gets the first only.
bool is_compound(const std::string& type)
{
    return type.compare(0, 3, "vec") == 0 || type.compare(0, 4, "quat") == 0 ||
           type.compare(0, 3, "mat") == 0;
}

/// The largest magnitude of a vec3i attribute's numbers over the whole grid. In 64 bits, because
/// the magnitude of the least int32 does not fit an int32.
std::int64_t largest_integer(const PointDataGrid& grid, std::size_t index)
{
    std::int64_t largest = 0;
    for (auto leaf = grid.tree().cbeginLeaf(); leaf; ++leaf) {
        const points::AttributeHandle<openvdb::Vec3i> handle(leaf->constAttributeArray(index));
        for (openvdb::Index i = 0; i < handle.size(); ++i)
            for (int axis = 0; axis < 3; ++axis)
                largest = std::max(largest, std::abs(std::int64_t(handle.get(i)[axis])));
    }
    return largest;
}

void check_type(const PointDataGrid& grid, const std::string& name, std::size_t index,
                const std::string& type, VdbViolations& found)
{
    // What is left out cannot also be changed, so the other rules do not apply.
    if (!is_kept(type)) {
        found.push_back({"attribute-type", grid.getName(), name,
                         "the type is " + type + ", which Houdini leaves out"});
        return;
    }
    const auto stride = grid.tree().cbeginLeaf()->constAttributeArray(index).stride();
    if (stride > 1 && is_compound(type))
        found.push_back({"attribute-stride", grid.getName(), name,
                         std::to_string(stride) + " values of type " + type +
                             " a point; Houdini keeps the first"});
    if ((name == "N" || name == "Cd" || name == "v" || name == "rest") && type != "vec3s" &&
        type != "vec3d")
        found.push_back({"role", grid.getName(), name,
                         "the type is " + type + "; Houdini knows this name as a vec3s"});
    // Houdini passes a vec3i on as float32, which holds all integers up to 2^24. An int32 with a
    // stride keeps its type and stays exact.
    constexpr std::int64_t kLargestExact = 1 << 24;
    if (type == "vec3i") {
        const std::int64_t largest = largest_integer(grid, index);
        if (largest > kLargestExact)
            found.push_back({"integer-vector", grid.getName(), name,
                             "a value is " + std::to_string(largest) +
                                 "; as vec3i only up to 16777216 stay exact, use int32 with a "
                                 "stride"});
    }
}

void check_attribute(const PointDataGrid& grid, const std::string& name, std::size_t index,
                     TypesByName& types, VdbViolations& found)
{
    const AttributeArray& array = grid.tree().cbeginLeaf()->constAttributeArray(index);
    // Strings are stored as indices with a codec of their own; the type of the array would say only
    // that.
    const std::string type = points::isString(array) ? "string" : array.type().first;
    if (!is_houdini_name(name))
        found.push_back({"attribute-name", grid.getName(), name,
                         "a name of letters, digits and _ is expected, no digit first"});
    check_type(grid, name, index, type, found);
    const std::string described = type + " x " + std::to_string(array.stride());
    const auto [first, is_new] =
        types.attributes.insert({name, TypesByName::Entry{described, grid.getName()}});
    if (!is_new && first->second.type != described)
        found.push_back({"attribute-clash", grid.getName(), name,
                         "the type is " + described + ", in grid \"" + first->second.grid +
                             "\" it is " + first->second.type});
}

void check_groups(const PointDataGrid& grid, const points::AttributeSet::Descriptor& descriptor,
                  VdbViolations& found)
{
    for (const auto& [name, offset] : descriptor.groupMap())
        if (!is_houdini_name(name))
            found.push_back({"group-name", grid.getName(), name,
                             "a name of letters, digits and _ is expected, no digit first"});
    const auto viewport = grid.getMetadata<openvdb::StringMetadata>("group_viewport");
    if (viewport && !descriptor.groupMap().count(viewport->value()))
        found.push_back({"viewport-group", grid.getName(), "group_viewport",
                         "it names \"" + viewport->value() + "\", which is none of the groups"});
}

} // namespace

void check_point_attributes(const GridBase& base, TypesByName& types, VdbViolations& found)
{
    if (!base.isType<PointDataGrid>())
        return;
    const auto& grid = static_cast<const PointDataGrid&>(base);
    const auto leaf = grid.tree().cbeginLeaf();
    // A grid without points has no leaf, and so no attribute that could be wrong.
    if (!leaf)
        return;
    const points::AttributeSet::Descriptor& descriptor = leaf->attributeSet().descriptor();
    const std::size_t position = descriptor.find("P");
    if (position == points::AttributeSet::INVALID_POS || descriptor.valueType(position) != "vec3s")
        found.push_back({"position", grid.getName(), "P",
                         "it is missing or not vec3s; Houdini unpacks no point without it"});
    for (const auto& [name, index] : descriptor.map())
        // Groups share arrays of bits under names of OpenVDB's own, which are no attributes to the
        // user; their real names are checked below.
        if (!points::isGroup(leaf->constAttributeArray(index)))
            check_attribute(grid, name, index, types, found);
    check_groups(grid, descriptor, found);
}

} // namespace vdb_shell
