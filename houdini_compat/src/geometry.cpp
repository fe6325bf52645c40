// SPDX-License-Identifier: Apache-2.0

// The geometry in memory that all three forms of Houdini's files share, and the test that it is
// sound. What passes require_consistent can be written in each form and is read back the same; a
// geometry that is wrong is refused by name and number instead of making a file that Houdini reads
// as something else. The limits are those of the format: all counts and indices are int32 there.

#include "vdb_shell/houdini/geometry.h"

#include "vdb_shell/core/error.h"

#include "vdb_shell/io/read_file.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <limits>
#include <set>

namespace vdb_shell::houdini
{
namespace
{

// What is checked before a geometry is written, so that no file is made that the reader of this
// program would refuse, or that would be read as something else.

constexpr std::size_t kMost = std::numeric_limits<std::int32_t>::max();

[[noreturn]] void reject(const std::string& what)
{
    throw InvalidOption("the Houdini geometry cannot be written: " + what);
}

void require_count(std::size_t count, const char* what)
{
    if (count > kMost)
        reject(std::to_string(count) + " " + what + ", more than int32 can number");
}

/// Letters, digits, _ and :, no digit first.
bool is_name(const std::string& name)
{
    // The cast is needed: isalnum is undefined for negative values, which bytes beyond ASCII may
    // have.
    const auto fits = [](char c) {
        return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == ':';
    };
    return !name.empty() && !std::isdigit(static_cast<unsigned char>(name[0])) &&
           std::all_of(name.begin(), name.end(), fits);
}

template <typename Named> void require_names(const std::vector<Named>& list, const char* what)
{
    // Attributes and groups are found by name, so a second one of the same name would be lost.
    std::set<std::string> seen;
    for (const Named& one : list) {
        if (!is_name(one.name))
            reject(std::string(what) + " " + vdb_shell::quoted(one.name) +
                   ": Houdini's names are of letters, digits, _ and :");
        if (!seen.insert(one.name).second)
            reject(std::string(what) + " " + vdb_shell::quoted(one.name) + " is there twice");
    }
}

/// Indices into the table of strings. -1 stands for the empty string, which need not be in the
/// table.
void require_indices(const Strings& strings, const std::string& where)
{
    for (std::size_t i = 0; i < strings.index.size(); ++i)
        if (strings.index[i] < -1 ||
            strings.index[i] >= static_cast<std::int64_t>(strings.table.size()))
            reject(where + ": value " + std::to_string(i) + " is string " +
                   std::to_string(strings.index[i]) + " of " +
                   std::to_string(strings.table.size()));
}

void require_attributes(const std::vector<Attribute>& attributes, std::size_t elements,
                        const char* what)
{
    require_names(attributes, what);
    for (const Attribute& attribute : attributes) {
        const std::string where = std::string(what) + " " + vdb_shell::quoted(attribute.name);
        // The size is tested before it multiplies, so a negative one cannot wrap into a number that
        // happens to fit.
        const std::size_t found = count_of(attribute.values);
        if (attribute.size < 1 || found != elements * static_cast<std::size_t>(attribute.size))
            reject(where + " has " + std::to_string(found) + " values in tuples of " +
                   std::to_string(attribute.size) + " for " + std::to_string(elements) +
                   " elements");
        // An attribute of long tuples can have more values than int32 numbers although its elements
        // are few.
        require_count(found, "values of an attribute");
        if (const auto* strings = std::get_if<Strings>(&attribute.values))
            require_indices(*strings, where);
    }
}

void require_groups(const std::vector<Group>& groups, std::size_t elements, const char* what)
{
    require_names(groups, what);
    for (const Group& group : groups)
        if (group.members.size() != elements)
            reject(std::string(what) + " " + vdb_shell::quoted(group.name) + " has " +
                   std::to_string(group.members.size()) + " entries for " +
                   std::to_string(elements) + " elements");
}

void require_primitives(const HoudiniGeometry& geometry)
{
    // 64 bits: the sum of damaged counts may exceed 32, and then equal the right number by
    // wrapping.
    std::uint64_t vertices = 0;
    for (std::size_t i = 0; i < geometry.primitives.size(); ++i) {
        const Primitive& primitive = geometry.primitives[i];
        const bool tet = primitive.type == PrimitiveType::tetrahedron;
        if (tet ? primitive.vertices != 4 : primitive.vertices < 1)
            reject("primitive " + std::to_string(i) + " is a " +
                   (tet ? "tetrahedron of " : "polygon of ") + std::to_string(primitive.vertices) +
                   " vertices");
        vertices += primitive.vertices;
    }
    // Primitives do not name their vertices: each takes those that follow the vertices of all
    // before it, so the sum has to be exact.
    if (vertices != geometry.vertex_point.size())
        reject("the primitives have " + std::to_string(vertices) +
               " vertices together, there are " + std::to_string(geometry.vertex_point.size()));
    for (std::size_t v = 0; v < geometry.vertex_point.size(); ++v)
        if (geometry.vertex_point[v] >= geometry.points)
            reject("vertex " + std::to_string(v) + " is at point " +
                   std::to_string(geometry.vertex_point[v]) + " of " +
                   std::to_string(geometry.points));
}

/// P is the one attribute that every reader wants. NaN and infinity could be stored in the binary
/// forms but not as text, and no point lies there.
void require_positions(const HoudiniGeometry& geometry)
{
    const Attribute* p = find(geometry.point_attributes, "P");
    const auto* positions = p ? std::get_if<std::vector<float>>(&p->values) : nullptr;
    if (!positions || p->size != 3)
        reject("there is no point attribute P of three floats");
    for (std::size_t i = 0; i < positions->size(); ++i)
        if (!std::isfinite((*positions)[i]))
            reject("P of point " + std::to_string(i / 3) + " is not finite");
}

template <typename Named>
const Named* find_named(const std::vector<Named>& list, const std::string& name)
{
    const auto found =
        std::find_if(list.begin(), list.end(), [&](const Named& one) { return one.name == name; });
    return found == list.end() ? nullptr : &*found;
}

} // namespace

const std::string& Strings::at(std::size_t value) const
{
    static const std::string empty;
    return index[value] < 0 ? empty : table[static_cast<std::size_t>(index[value])];
}

/// Strings count by their indices, one for each component; the table has each text once.
std::size_t count_of(const Values& values)
{
    if (const auto* strings = std::get_if<Strings>(&values))
        return strings->index.size();
    return std::visit(
        [](const auto& held) -> std::size_t {
            if constexpr (std::is_same_v<std::decay_t<decltype(held)>, Strings>)
                return 0;
            else
                return held.size();
        },
        values);
}

const Attribute* find(const std::vector<Attribute>& attributes, const std::string& name)
{
    return find_named(attributes, name);
}

const Group* find(const std::vector<Group>& groups, const std::string& name)
{
    return find_named(groups, name);
}

void require_consistent(const HoudiniGeometry& geometry)
{
    require_count(geometry.points, "points");
    require_count(geometry.vertex_point.size(), "vertices");
    require_count(geometry.primitives.size(), "primitives");
    // Primitives go first, as they tell whether the numbers of vertices and points agree that the
    // other tests use.
    require_primitives(geometry);
    require_attributes(geometry.vertex_attributes, geometry.vertex_point.size(),
                       "vertex attribute");
    require_attributes(geometry.point_attributes, geometry.points, "point attribute");
    require_attributes(geometry.primitive_attributes, geometry.primitives.size(),
                       "primitive attribute");
    require_attributes(geometry.detail_attributes, 1, "detail attribute");
    require_groups(geometry.vertex_groups, geometry.vertex_point.size(), "vertex group");
    require_groups(geometry.point_groups, geometry.points, "point group");
    require_groups(geometry.primitive_groups, geometry.primitives.size(), "primitive group");
    require_positions(geometry);
}

} // namespace vdb_shell::houdini
