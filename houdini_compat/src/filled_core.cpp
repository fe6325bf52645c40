// SPDX-License-Identifier: Apache-2.0

// Tets that fill a shell, behind the shell's own points and primitives, and back. So a reader of
// the shell sees the shell that it would see without them. Each attribute of the shell has a value
// for them: -1 for what belongs to no prism or vertex, 0 for what would be a pillar's.

#include "filled_core.h"

#include "vdb_shell/io/read_file.h"
#include "vdb_shell/shell/quality.h"

#include "shell_columns.h"
#include "shell_names.h"

#include <algorithm>
#include <cstdint>
#include <numeric>

namespace vdb_shell::houdini
{
namespace
{

using openvdb::Vec3s;

/// A value for each added element, where the attribute has something to say of it.
struct Added {
    std::string name;
    Values values;
};

std::vector<float> as_floats(const std::vector<Vec3s>& vectors)
{
    std::vector<float> values;
    values.reserve(3 * vectors.size());
    for (const Vec3s& v : vectors)
        values.insert(values.end(), {v[0], v[1], v[2]});
    return values;
}

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

void append_values(std::vector<Attribute>& attributes, std::size_t count,
                   const std::vector<Added>& known)
{
    for (Attribute& attribute : attributes) {
        std::visit(
            [&](auto& values) { append(values, count * static_cast<std::size_t>(attribute.size)); },
            attribute.values);
        for (const Added& added : known) {
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

/// Of each tet its mean ratio.
std::vector<float> qualities(const TetMesh& all, std::size_t first)
{
    std::vector<float> quality;
    for (std::size_t t = first; t < all.tets.size(); ++t)
        quality.push_back(static_cast<float>(shape_of(all, t).mean_ratio));
    return quality;
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

template <typename T> std::vector<T> last_of(const std::vector<T>& list, std::size_t count)
{
    return {list.end() - static_cast<std::ptrdiff_t>(count), list.end()};
}

} // namespace

void append_core(const ShellFile& file, const ShellPoints& points, HoudiniGeometry& geometry)
{
    const CoreTets& core = file.core;
    const std::size_t count = core.points.size(), tets = core.tets.size();
    const std::vector<float> position = as_floats(core.points);
    append_values(geometry.point_attributes, count,
                  {{"P", position},
                   {kRest, file.rest.posed() ? as_floats(file.rest.core) : position},
                   // It is the end of no pillar, so its other end is where it is.
                   {kOpposite, position},
                   {kVelocity, as_floats(file.rest.velocity.core)},
                   {"depth", std::vector<float>(count, 1.0f)},
                   {kSourceVertex, signed_numbers(core.source_vertex)}});
    append_group(geometry.point_groups, geometry.points, count, kCorePoints);
    append_values(geometry.primitive_attributes, tets,
                  {{"quality", qualities(joined_tets(file.tets, core), file.tets.tets.size())}});
    append_group(geometry.primitive_groups, geometry.primitives.size(), tets, kCoreTets);
    const std::size_t shared = file.tets.points.size();
    for (const openvdb::Vec4I& tet : core.tets) {
        // Houdini counts the corners of a tetrahedron with the other orientation.
        for (const int corner : {0, 1, 3, 2}) {
            const std::uint32_t p = tet[corner];
            geometry.vertex_point.push_back(
                p < shared ? points.id_of_tet_point[p]
                           : static_cast<std::uint32_t>(geometry.points + (p - shared)));
        }
        geometry.primitives.push_back({PrimitiveType::tetrahedron, 4});
    }
    geometry.points += count;
}

HoudiniGeometry without_core(const HoudiniGeometry& geometry, const CoreSize& size,
                             const std::string& name)
{
    if (size.points > geometry.points || size.tets > geometry.primitives.size())
        refuse(name, "it has fewer points or primitives than the core that it tells of");
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
            refuse(name, "vertex " + std::to_string(i) + " of the shell is a point of the core");
    shorten(shell.point_attributes, shell.point_groups, shell.points);
    shorten(shell.primitive_attributes, shell.primitive_groups, primitives);
    // Of vertices a shell has nothing.
    shell.vertex_attributes.clear();
    shell.vertex_groups.clear();
    return shell;
}

void read_core(const HoudiniGeometry& geometry, const CoreSize& size, const std::string& name,
               ShellFile& file)
{
    const Columns points(geometry.point_attributes, "point attribute", name);
    const std::size_t first = geometry.points - size.points;
    const std::size_t shared = file.tets.points.size();
    CoreTets& core = file.core;
    core.points = last_of(points.vectors("P"), size.points);
    const auto vertices = static_cast<std::int64_t>(file.stack.surface(0).size());
    for (const std::int32_t v : last_of(points.integers(kSourceVertex), size.points)) {
        if (v < -1 || v >= vertices)
            points.fail(kSourceVertex, "of a point of the core is " + std::to_string(v) + " of " +
                                           std::to_string(vertices));
        core.source_vertex.push_back(v < 0 ? CoreTets::kNoVertex : static_cast<std::uint32_t>(v));
    }
    const ShellPoints shell = number_points(file.stack, file.tets);
    const std::vector<std::uint32_t> corners = last_of(geometry.vertex_point, 4 * size.tets);
    const auto number = [&](std::size_t k) {
        const std::uint32_t p = corners[k];
        if (p < first && shell.tet_point[p] == ShellPoints::kUnused)
            refuse(name, "tet " + std::to_string(k / 4) + " of the core: point " +
                             std::to_string(p) + " is of no tet of the shell");
        return p < first ? static_cast<std::uint32_t>(shell.tet_point[p])
                         : static_cast<std::uint32_t>(shared + (p - first));
    };
    for (std::size_t k = 0; k < corners.size(); k += 4)
        core.tets.emplace_back(number(k), number(k + 1), number(k + 3), number(k + 2));
    if (file.rest.posed())
        file.rest.core = last_of(points.vectors(kRest), size.points);
    if (!file.rest.velocity.empty())
        file.rest.velocity.core = last_of(points.vectors(kVelocity), size.points);
}

} // namespace vdb_shell::houdini
