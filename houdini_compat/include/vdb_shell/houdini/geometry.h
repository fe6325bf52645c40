// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

namespace vdb_shell::houdini
{

enum class PrimitiveType : std::uint8_t {
    tetrahedron, ///< four vertices with det(b-a, c-a, d-a) < 0: Houdini's own orientation
    polygon,     ///< closed, clockwise seen from outside
};

/// A primitive's vertices follow those of the primitive before it.
struct Primitive {
    PrimitiveType type = PrimitiveType::polygon;
    std::uint32_t vertices = 0;
};

/// Strings of an attribute: an index into the table per value, -1 for the empty string.
struct Strings {
    std::vector<std::string> table;
    std::vector<std::int32_t> index;
    const std::string& at(std::size_t value) const;
};

/// One of Houdini's numeric storages each (int32, int64, fpreal32, fpreal64), or strings.
using Values = std::variant<std::vector<std::int32_t>, std::vector<std::int64_t>,
                            std::vector<float>, std::vector<double>, Strings>;

/// Values of a tuple stand together: value `k` of element `e` is number e * size + k.
struct Attribute {
    std::string name;
    int size = 1;
    std::string meaning; ///< what transforms do to it: "point", "normal", "vector", ... or ""
    Values values;
};
std::size_t count_of(const Values& values);

struct Group {
    std::string name;
    std::vector<bool> members; ///< one per element
};

/// A Houdini geometry ("detail") of polygons and tetrahedra. Vertices are the primitives' corners,
/// and each refers to a point; the position is the point attribute P.
struct HoudiniGeometry {
    std::size_t points = 0;
    std::vector<std::uint32_t> vertex_point;
    std::vector<Primitive> primitives;
    std::vector<Attribute> vertex_attributes, point_attributes, primitive_attributes;
    std::vector<Attribute> detail_attributes; ///< one element
    std::vector<Group> vertex_groups, point_groups, primitive_groups;
    std::vector<std::string> unread; ///< parts of a file that have no place here, in words
};

/// By name; null when there is none.
const Attribute* find(const std::vector<Attribute>& attributes, const std::string& name);
const Group* find(const std::vector<Group>& groups, const std::string& name);

/// Throws InvalidOption unless the parts fit together: counts, ranges, names that Houdini takes, no
/// name twice in a class, a P of three finite floats, at most 2^31 - 1 of everything. What passes
/// here can be written, and read back.
void require_consistent(const HoudiniGeometry& geometry);

} // namespace vdb_shell::houdini
