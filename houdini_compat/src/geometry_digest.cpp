// SPDX-License-Identifier: Apache-2.0

// Digests of the parts of a geometry, of what they mean and not of the bytes they are stored in: a
// file that Houdini has saved again holds the same. Changed bytes that change no value that is read
// go unnoticed, and do not matter.

#include "geometry_digest.h"

#include "vdb_shell/core/digest.h"
#include "vdb_shell/io/read_file.h"

#include "detail_figures.h"
#include "shell_names.h"

#include <algorithm>
#include <map>
#include <sstream>

namespace vdb_shell::houdini
{
namespace
{

using Lines = std::map<std::string, std::string>; ///< digests by class and name

void add(Digest& digest, const Strings& strings)
{
    for (std::size_t i = 0; i < strings.index.size(); ++i)
        digest.add_text(strings.at(i));
}

template <typename T> void add(Digest& digest, const std::vector<T>& values)
{
    digest.add_values(values);
}

void add_attributes(const std::string& kind, const std::vector<Attribute>& attributes, Lines& lines)
{
    for (const Attribute& attribute : attributes) {
        if (attribute.name == kDigests || attribute.name == kDigestCount)
            continue;
        Digest digest;
        digest.add_number(attribute.size);
        digest.add_text(attribute.meaning);
        digest.add_number(attribute.values.index());
        std::visit([&](const auto& values) { add(digest, values); }, attribute.values);
        lines[kind + " " + attribute.name] = digest.hex();
    }
}

void add_groups(const std::string& kind, const std::vector<Group>& groups, Lines& lines)
{
    for (const Group& group : groups) {
        Digest digest;
        digest.add_values(std::vector<std::uint8_t>(group.members.begin(), group.members.end()));
        lines[kind + " " + group.name] = digest.hex();
    }
}

std::string primitives_digest(const HoudiniGeometry& geometry)
{
    Digest digest;
    digest.add_number(std::uint64_t(geometry.points));
    digest.add_values(geometry.vertex_point);
    std::vector<std::uint32_t> kinds;
    kinds.reserve(2 * geometry.primitives.size());
    for (const Primitive& primitive : geometry.primitives) {
        kinds.push_back(std::uint32_t(primitive.type));
        kinds.push_back(primitive.vertices);
    }
    digest.add_values(kinds);
    return digest.hex();
}

Lines lines_of(const HoudiniGeometry& geometry)
{
    Lines lines;
    lines["geometry primitives"] = primitives_digest(geometry);
    add_attributes("point", geometry.point_attributes, lines);
    add_attributes("vertex", geometry.vertex_attributes, lines);
    add_attributes("primitive", geometry.primitive_attributes, lines);
    add_attributes("detail", geometry.detail_attributes, lines);
    add_groups("point_group", geometry.point_groups, lines);
    add_groups("vertex_group", geometry.vertex_groups, lines);
    add_groups("primitive_group", geometry.primitive_groups, lines);
    return lines;
}

} // namespace

std::string digests_of(const HoudiniGeometry& geometry)
{
    std::string text;
    for (const auto& [part, hex] : lines_of(geometry))
        text.append(part).append(" ").append(hex).append("\n");
    return text;
}

void add_digests(HoudiniGeometry& geometry)
{
    const std::string lines = digests_of(geometry);
    const auto count = std::size_t(std::count(lines.begin(), lines.end(), '\n'));
    // A changed bit in the name of one of the two leaves the other.
    add_count(geometry, kDigestCount, count);
    add_text(geometry, kDigests, lines);
}

std::size_t require_digests(const HoudiniGeometry& geometry, const std::string& name)
{
    const Attribute* const attribute = find(geometry.detail_attributes, kDigests);
    if (!attribute) {
        if (find(geometry.detail_attributes, kDigestCount))
            refuse(name, std::string("detail attribute \"") + kDigests + "\" is missing");
        return 0;
    }
    const auto* const strings = std::get_if<Strings>(&attribute->values);
    if (!strings || strings->index.size() != 1)
        refuse(name, std::string("detail attribute \"") + kDigests + "\" is not one string");
    const Lines found = lines_of(geometry);
    std::istringstream stated(strings->at(0));
    std::size_t count = 0;
    for (std::string line; std::getline(stated, line); ++count) {
        std::istringstream words(line);
        std::string kind, part, hex;
        words >> kind >> part >> hex;
        const std::string whole = std::string(kind).append(" ").append(part);
        const auto here = found.find(whole);
        if (here == found.end())
            refuse(name, vdb_shell::quoted(whole) + " is missing, or was not there");
        if (here->second != hex)
            refuse(name, vdb_shell::quoted(whole) + " is not what was written: its digest is " +
                             here->second + ", the file says " + vdb_shell::quoted(hex));
    }
    if (count == 0)
        refuse(name, std::string("detail attribute \"") + kDigests + "\" is empty");
    const Attribute* const number = find(geometry.detail_attributes, kDigestCount);
    const auto* const said =
        number ? std::get_if<std::vector<std::int32_t>>(&number->values) : nullptr;
    if (number && (!said || said->size() != 1 || std::size_t(said->front()) != count))
        refuse(name, std::string("detail attribute \"") + kDigestCount +
                         "\" is not what was written: there are " + std::to_string(count) +
                         " digests");
    return count;
}

} // namespace vdb_shell::houdini
