// SPDX-License-Identifier: Apache-2.0

// Takes the bytes of a file; gives the geometry in it, whichever of the three forms they have. The
// content tells the form, not the name, since files get renamed. Order matters: the counts come
// first and are bounded by the size of the document, then the primitives, which decide the order of
// the vertices, then attributes and groups, which are held against those counts. What the geometry
// has no place for is listed in `unread` rather than refused, so that a surface can be read beside
// it.

#include "vdb_shell/houdini/geometry_file.h"

#include "geometry_parts.h"
#include "json_read.h"
#include "scf.h"
#include "vdb_shell/core/words.h"
#include "vdb_shell/io/read_file.h"

#include <algorithm>
#include <string_view>

namespace vdb_shell::houdini
{
namespace
{

/// Says what a file is that is none of the three forms. The ones that people mix up with them are
/// named, as "no Houdini geometry" would puzzle somebody whose file has the right extension.
[[noreturn]] void refuse_content(const std::string& name, const std::string& bytes)
{
    if (begins_with(bytes, "PGEOMETRY") || begins_with(bytes, "Bgeo"))
        refuse(name, "it is Houdini geometry from before version 12, which cannot be read; save it "
                     "again with a newer Houdini");
    if (begins_with(bytes, "1oeg_bdv") || begins_with(bytes, "vdb_geo1"))
        refuse(name, "it is vdb_tool's own kind of .geo, not Houdini's");
    refuse(name, "it is no Houdini geometry: it begins with " +
                     vdb_shell::quoted(std::string_view(bytes).substr(0, 8)));
}

Value read_document(const std::string& name, const std::string& bytes, Format& format,
                    std::size_t& document_size)
{
    document_size = bytes.size();
    if (begins_with(bytes, kScfMark)) {
        format = Format::compressed;
        const std::string unpacked = read_scf(name, bytes);
        // The budgets that follow are for the document, and it is the uncompressed one that memory
        // was already taken for.
        document_size = unpacked.size();
        return read_json_binary(name + " (uncompressed)", unpacked);
    }
    if (!bytes.empty() && bytes[0] == '\x7f') {
        format = Format::binary;
        return read_json_binary(name, bytes);
    }
    const std::size_t first = bytes.find_first_not_of(" \t\r\n");
    if (first == bytes.npos || bytes[first] != '[')
        refuse_content(name, bytes);
    format = Format::text;
    return read_json_text(name, bytes);
}

/// Brings the values of vertices into the order in which the primitives use them. A file may number
/// vertices otherwise; in memory the vertices of a primitive follow each other.
template <typename T>
void reorder(std::vector<T>& values, std::size_t size, const std::vector<std::uint32_t>& order)
{
    std::vector<T> moved;
    moved.reserve(values.size());
    for (const std::uint32_t vertex : order)
        for (std::size_t k = 0; k < size; ++k)
            moved.push_back(values[vertex * size + k]);
    values = std::move(moved);
}

void reorder(Strings& strings, std::size_t size, const std::vector<std::uint32_t>& order)
{
    reorder(strings.index, size, order);
}

void reorder_vertices(HoudiniGeometry& geometry, const std::vector<std::uint32_t>& order)
{
    for (Attribute& attribute : geometry.vertex_attributes)
        std::visit(
            [&](auto& values) { reorder(values, static_cast<std::size_t>(attribute.size), order); },
            attribute.values);
    for (Group& group : geometry.vertex_groups)
        reorder(group.members, 1, order);
}

void read_all_attributes(const Fields& document, const Where& where, Budget& budget,
                         HoudiniGeometry& geometry)
{
    // Missing counts as none. Whoever needs an attribute, as a surface needs P, says so when it
    // looks for it.
    const Value* attributes = document.find("attributes");
    if (!attributes)
        return;
    const Fields classes(*attributes, where.inside("attributes"));
    const auto read = [&](const char* key, const char* kind, std::size_t elements,
                          std::vector<Attribute>& into) {
        if (const Value* list = classes.find(key))
            into = read_attributes(*list, elements, where, kind, budget, geometry.unread);
    };
    read("vertexattributes", "vertex attribute", geometry.vertex_point.size(),
         geometry.vertex_attributes);
    read("pointattributes", "point attribute", geometry.points, geometry.point_attributes);
    read("primitiveattributes", "primitive attribute", geometry.primitives.size(),
         geometry.primitive_attributes);
    read("globalattributes", "detail attribute", 1, geometry.detail_attributes);
}

void read_all_groups(const Fields& document, const Where& where, Budget& budget,
                     HoudiniGeometry& geometry)
{
    const auto read = [&](const char* key, const char* kind, std::size_t elements,
                          std::vector<Group>& into) {
        if (const Value* list = document.find(key))
            into = read_groups(*list, elements, where, kind, budget, geometry.unread);
    };
    read("pointgroups", "point group", geometry.points, geometry.point_groups);
    read("vertexgroups", "vertex group", geometry.vertex_point.size(), geometry.vertex_groups);
    read("primitivegroups", "primitive group", geometry.primitives.size(),
         geometry.primitive_groups);
}

/// The keys that are read, and those that say nothing about the geometry itself. All others are
/// named in `unread`.
constexpr std::string_view kKnown[] = {
    "fileversion",  "hasindex",        "pointcount", "vertexcount",  "primitivecount",
    "info",         "topology",        "attributes", "primitives",   "pointgroups",
    "vertexgroups", "primitivegroups", "index",      "indexposition"};

} // namespace

ReadGeometry parse_geometry(const std::string& bytes, const std::string& name)
{
    ReadGeometry result;
    std::size_t size = 0;
    const Value tree = read_document(name, bytes, result.format, size);
    const Where where{name, {}};
    const Fields document(tree, where);
    // The version is not judged: some programs leave it out, and what can be read follows from the
    // parts themselves. It only has to be a text where it is there.
    if (const Value* version = document.find("fileversion"))
        text_of(*version, where, "fileversion");
    // An element takes a byte at least in every form, so counts beyond the size of the document are
    // false. A primitive has one vertex at least. These three bound all memory that is taken by
    // counts.
    HoudiniGeometry& geometry = result.geometry;
    geometry.points = count_of(document.at("pointcount"), where, "pointcount", size);
    const std::size_t vertices = count_of(document.at("vertexcount"), where, "vertexcount", size);
    const std::size_t primitives =
        count_of(document.at("primitivecount"), where, "primitivecount", vertices);
    Budget budget(size);
    const std::vector<std::uint32_t> order = read_primitives(
        document.at("topology"), document.at("primitives"), vertices, primitives, where, geometry);
    read_all_attributes(document, where, budget, geometry);
    read_all_groups(document, where, budget, geometry);
    // Attributes of vertices have been read in the order of the file, and can be moved now that all
    // are there.
    if (!order.empty())
        reorder_vertices(geometry, order);
    for (const std::string* key : document.keys())
        if (std::find(std::begin(kKnown), std::end(kKnown), *key) == std::end(kKnown))
            geometry.unread.push_back(vdb_shell::quoted(*key));
    return result;
}

ReadGeometry read_geometry(const std::filesystem::path& path)
{
    return parse_geometry(read_whole_file(path), path.string());
}

} // namespace vdb_shell::houdini
