// SPDX-License-Identifier: Apache-2.0

// What stands behind a shell's own points and primitives, so that a reader of the shell sees the
// shell that it would see without: appended with a value in each of the shell's attributes, and
// taken off again.

#include "added_elements.h"

#include "vdb_shell/io/read_file.h"
#include "vdb_shell/shell/prism_shell.h"

#include <algorithm>
#include <cstdint>
#include <type_traits>
#include <utility>

namespace vdb_shell::houdini
{
namespace
{

using openvdb::Vec3s;

void append(std::vector<std::int32_t>& values, std::size_t count)
{
    values.resize(values.size() + count, -1);
}
void append(std::vector<float>& values, std::size_t count)
{
    values.resize(values.size() + count, 0.0f);
}
/// Of a shell's attributes of strings, which are stop reasons.
void append(Strings& strings, std::size_t count)
{
    const std::string none(name_of(StopReason::none));
    const auto found = std::find(strings.table.begin(), strings.table.end(), none);
    const auto place = static_cast<std::int32_t>(found - strings.table.begin());
    if (found == strings.table.end())
        strings.table.push_back(none);
    strings.index.resize(strings.index.size() + count, place);
}
/// A shell has no columns of these.
template <typename T> void append(std::vector<T>& values, std::size_t count)
{
    values.resize(values.size() + count);
}

template <typename List> void shorten(List& list, std::size_t count)
{
    list.resize(count);
}
void shorten(Strings& strings, std::size_t count)
{
    strings.index.resize(count);
}

void shorten(std::vector<Attribute>& attributes, std::vector<Group>& groups, std::size_t count)
{
    for (Attribute& attribute : attributes)
        std::visit(
            [&](auto& values) {
                shorten(values, count * static_cast<std::size_t>(attribute.size));
            },
            attribute.values);
    for (Group& group : groups)
        group.members.resize(count);
}

} // namespace

std::vector<float> as_floats(const std::vector<Vec3s>& vectors)
{
    std::vector<float> values;
    values.reserve(3 * vectors.size());
    for (const Vec3s& v : vectors)
        values.insert(values.end(), {v[0], v[1], v[2]});
    return values;
}

void append_values(std::vector<Attribute>& attributes, std::size_t count,
                   const std::vector<AddedValues>& known)
{
    for (Attribute& attribute : attributes) {
        std::visit(
            [&](auto& values) { append(values, count * static_cast<std::size_t>(attribute.size)); },
            attribute.values);
        for (const AddedValues& added : known) {
            if (added.name != attribute.name)
                continue;
            std::visit(
                [&](auto& values) {
                    using Column = std::decay_t<decltype(values)>;
                    if constexpr (!std::is_same_v<Column, Strings>) {
                        const auto& news = std::get<Column>(added.values);
                        std::copy(news.begin(), news.end(),
                                  values.end() - static_cast<std::ptrdiff_t>(news.size()));
                    }
                },
                attribute.values);
        }
    }
}

void append_group(std::vector<Group>& groups, std::size_t before, std::size_t count,
                  const char* name)
{
    for (Group& group : groups)
        group.members.resize(before + count, false);
    Group own{name, std::vector<bool>(before, false)};
    own.members.resize(before + count, true);
    groups.push_back(std::move(own));
}

HoudiniGeometry without_last(const HoudiniGeometry& geometry, const AddedSize& size,
                             const std::string& name)
{
    if (size.points > geometry.points || size.tets > geometry.primitives.size())
        refuse(name, "it has fewer points or primitives than it tells of");
    HoudiniGeometry shell = geometry;
    shell.points -= size.points;
    const std::size_t primitives = geometry.primitives.size() - size.tets;
    for (std::size_t i = primitives; i < geometry.primitives.size(); ++i)
        if (geometry.primitives[i].type != PrimitiveType::tetrahedron ||
            geometry.primitives[i].vertices != 4)
            refuse(name, "primitive " + std::to_string(i) + " is no tetrahedron of the core");
    shell.primitives.resize(primitives);
    shell.vertex_point.resize(geometry.vertex_point.size() - 4 * size.tets);
    for (std::size_t i = 0; i < shell.vertex_point.size(); ++i)
        if (shell.vertex_point[i] >= shell.points)
            refuse(name,
                   "vertex " + std::to_string(i) + " of the shell is a point behind the shell's");
    shorten(shell.point_attributes, shell.point_groups, shell.points);
    shorten(shell.primitive_attributes, shell.primitive_groups, primitives);
    // Of vertices a shell has nothing.
    shell.vertex_attributes.clear();
    shell.vertex_groups.clear();
    return shell;
}

} // namespace vdb_shell::houdini
