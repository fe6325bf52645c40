// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/houdini/geometry.h"

#include <openvdb/Types.h>

#include <cstddef>
#include <string>
#include <vector>

namespace vdb_shell::houdini
{

// Points and primitives behind those of the shell, whose own keep their numbers.

struct AddedSize {
    std::size_t points = 0, tets = 0;
};

/// Of one attribute, a value for each added element.
struct AddedValues {
    std::string name;
    Values values;
};

/// Appends `count` elements to all attributes of a class. Where nothing is known of an attribute it
/// gets -1 for an integer, 0 for a float, and for a string, which is a stop reason, `none`.
void append_values(std::vector<Attribute>& attributes, std::size_t count,
                   const std::vector<AddedValues>& known);

/// Appends `count` elements to all groups, none of which they belong to, and adds one of their own.
void append_group(std::vector<Group>& groups, std::size_t before, std::size_t count,
                  const char* name);

/// The geometry without its last points and its last primitives. Throws ReadError where it has
/// fewer, where one of those is no tetrahedron, and where another primitive has one of the points.
HoudiniGeometry without_last(const HoudiniGeometry& geometry, const AddedSize& size,
                             const std::string& name);

std::vector<float> as_floats(const std::vector<openvdb::Vec3s>& vectors);

template <typename T> std::vector<T> last_of(const std::vector<T>& list, std::size_t count)
{
    return {list.end() - static_cast<std::ptrdiff_t>(count), list.end()};
}

} // namespace vdb_shell::houdini
