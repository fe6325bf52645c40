// SPDX-License-Identifier: Apache-2.0

// Writes a geometry as a document of Houdini in any of the three forms. The document is the same in
// all of them, but for attributes, which stand in pages in binary and in lists in text, as Houdini
// has them. Of several spellings that Houdini accepts, the one is written that most other readers
// take too (docs/houdini.md tells who read the files). The bytes depend on the geometry and the
// program's version only: no date, user or machine. Precondition: require_consistent, which the
// function that takes a path calls.

#include "vdb_shell/houdini/geometry_file.h"

#include "vdb_shell/core/atomic_file.h"
#include "vdb_shell/core/error.h"

#include "document_writer.h"

#include <algorithm>
#include <cctype>
#include <limits>
#include <ostream>

namespace vdb_shell::houdini
{
namespace
{

namespace fs = std::filesystem;

/// The number of elements in a page; it matters to readers only where pages are constant, and none
/// is written so.
constexpr int kPageSize = 1024;
/// The version of Houdini that the layout follows. Nothing here is newer than what Houdini 19
/// writes, and later ones read older files.
constexpr const char* kFileVersion = "19.0.0";

/// The four types that Values holds; narrower storages are read but never written.
template <typename T> constexpr const char* storage_of()
{
    if constexpr (std::is_same_v<T, std::int32_t>)
        return "int32";
    else if constexpr (std::is_same_v<T, std::int64_t>)
        return "int64";
    else if constexpr (std::is_same_v<T, float>)
        return "fpreal32";
    else
        return "fpreal64";
}

void key_text(DocumentWriter& out, const char* key, std::string_view value)
{
    out.text(key);
    out.text(value);
}

void key_integer(DocumentWriter& out, const char* key, std::size_t value)
{
    out.text(key);
    out.integer(static_cast<std::int64_t>(value));
}

/// The lowest and highest coordinate of each axis in turn, as Houdini lists them: x, x, y, y, z, z.
/// A geometry without points has a box of zeros.
std::vector<double> bounds_of(const HoudiniGeometry& geometry)
{
    const auto& p = std::get<std::vector<float>>(find(geometry.point_attributes, "P")->values);
    std::vector<double> bounds(6, 0.0);
    for (std::size_t axis = 0; axis < 3 && !p.empty(); ++axis) {
        float low = p[axis], high = p[axis];
        for (std::size_t i = axis; i < p.size(); i += 3) {
            low = std::min(low, p[i]);
            high = std::max(high, p[i]);
        }
        bounds[2 * axis] = static_cast<double>(low);
        bounds[2 * axis + 1] = static_cast<double>(high);
    }
    return bounds;
}

/// The counts come first, because readers take memory by them.
void write_head(DocumentWriter& out, const HoudiniGeometry& geometry)
{
    key_text(out, "fileversion", kFileVersion);
    out.text("hasindex");
    out.boolean(false);
    key_integer(out, "pointcount", geometry.points);
    key_integer(out, "vertexcount", geometry.vertex_point.size());
    key_integer(out, "primitivecount", geometry.primitives.size());
    out.new_line();
    out.text("info");
    out.open_map();
    key_text(out, "software", "vdb_shell " VDB_SHELL_VERSION);
    out.text("bounds");
    const std::vector<double> bounds = bounds_of(geometry);
    out.open_list();
    for (const double bound : bounds)
        out.real(bound);
    out.close_list();
    out.close_map();
}

void write_topology(DocumentWriter& out, const HoudiniGeometry& geometry)
{
    out.new_line();
    out.text("topology");
    out.open_list();
    out.text("pointref");
    out.open_list();
    out.text("indices");
    // The cast from unsigned is safe: require_consistent has bounded the number of points by int32.
    const std::vector<std::int32_t> indices(geometry.vertex_point.begin(),
                                            geometry.vertex_point.end());
    out.numbers(indices.data(), indices.size());
    out.close_list();
    out.close_list();
}

/// The size of the tuples, their storage and the values. Pages without flags hold all tuples one
/// after the other, so the vector is written as it is.
template <typename T>
void write_column(DocumentWriter& out, const char* key, std::size_t size,
                  const std::vector<T>& values)
{
    out.text(key);
    out.open_list();
    key_integer(out, "size", size);
    key_text(out, "storage", storage_of<T>());
    if (out.paged()) {
        key_integer(out, "pagesize", kPageSize);
        out.text("rawpagedata");
        out.numbers(values.data(), values.size());
    } else if (size == 1) {
        out.text("arrays");
        out.open_list();
        out.numbers(values.data(), values.size());
        out.close_list();
    } else {
        out.text("tuples");
        out.open_list();
        for (std::size_t i = 0; i < values.size(); i += size)
            out.numbers(values.data() + i, size);
        out.close_list();
    }
    out.close_list();
}

template <typename T>
void write_values(DocumentWriter& out, std::size_t size, const std::vector<T>& values)
{
    key_integer(out, "size", size);
    key_text(out, "storage", storage_of<T>());
    // What elements get that are made later in Houdini.
    out.text("defaults");
    out.open_list();
    key_integer(out, "size", 1);
    key_text(out, "storage", std::is_integral_v<T> ? "int64" : "fpreal64");
    out.text("values");
    out.open_list();
    if (std::is_integral_v<T>)
        out.integer(0);
    else
        out.real(0);
    out.close_list();
    out.close_list();
    write_column(out, "values", size, values);
}

/// The texts once, in a table, and for each component the number of its text; -1 stands for the
/// empty string.
void write_values(DocumentWriter& out, std::size_t size, const Strings& strings)
{
    key_integer(out, "size", size);
    key_text(out, "storage", "int32");
    out.text("strings");
    out.open_list();
    for (const std::string& string : strings.table)
        out.text(string);
    out.close_list();
    write_column(out, "indices", size, strings.index);
}

/// Two lists: what the attribute is, and what it holds. The option "type" tells Houdini what a
/// vector means, a point or a normal for instance, so that transforms treat it as that.
void write_attribute(DocumentWriter& out, const Attribute& attribute)
{
    out.new_line();
    out.open_list();
    out.open_list();
    key_text(out, "scope", "public");
    key_text(out, "type", std::holds_alternative<Strings>(attribute.values) ? "string" : "numeric");
    key_text(out, "name", attribute.name);
    out.text("options");
    out.open_map();
    if (!attribute.meaning.empty()) {
        out.text("type");
        out.open_map();
        key_text(out, "type", "string");
        key_text(out, "value", attribute.meaning);
        out.close_map();
    }
    out.close_map();
    out.close_list();
    out.open_list();
    const auto size = static_cast<std::size_t>(attribute.size);
    std::visit([&](const auto& values) { write_values(out, size, values); }, attribute.values);
    out.close_list();
    out.close_list();
}

/// An empty class is left out; readers take a missing key for none.
void write_class(DocumentWriter& out, const char* key, const std::vector<Attribute>& attributes)
{
    if (attributes.empty())
        return;
    out.new_line();
    out.text(key);
    out.open_list();
    for (const Attribute& attribute : attributes)
        write_attribute(out, attribute);
    out.close_list();
}

void write_attributes(DocumentWriter& out, const HoudiniGeometry& geometry)
{
    out.new_line();
    out.text("attributes");
    out.open_list();
    write_class(out, "vertexattributes", geometry.vertex_attributes);
    write_class(out, "pointattributes", geometry.point_attributes);
    write_class(out, "primitiveattributes", geometry.primitive_attributes);
    write_class(out, "globalattributes", geometry.detail_attributes);
    out.close_list();
}

/// Values and how often each comes, in turn, for what the primitives of a run have in common. A
/// shell has triangles only, so its run is one pair.
std::vector<std::int32_t> run_lengths(const std::vector<Primitive>& primitives, std::size_t begin,
                                      std::size_t end)
{
    std::vector<std::int32_t> runs;
    for (std::size_t i = begin; i < end; ++i) {
        const auto vertices = static_cast<std::int32_t>(primitives[i].vertices);
        if (runs.empty() || runs[runs.size() - 2] != vertices)
            runs.insert(runs.end(), {vertices, 0});
        ++runs.back();
    }
    return runs;
}

/// The long names in both forms: they are what is known to be read in both (docs/houdini.md).
void write_primitives(DocumentWriter& out, const HoudiniGeometry& geometry)
{
    const std::vector<Primitive>& primitives = geometry.primitives;
    out.new_line();
    out.text("primitives");
    out.open_list();
    std::size_t vertex = 0;
    for (std::size_t begin = 0, end = 0; begin < primitives.size(); begin = end) {
        const PrimitiveType type = primitives[begin].type;
        std::size_t vertices = 0;
        // A run is as long as the type stays the same, so the order of the primitives is kept.
        for (end = begin; end < primitives.size() && primitives[end].type == type; ++end)
            vertices += primitives[end].vertices;
        const bool tets = type == PrimitiveType::tetrahedron;
        out.new_line();
        out.open_list();
        out.open_list();
        key_text(out, "type", tets ? "Tetrahedron_run" : "Polygon_run");
        out.close_list();
        out.open_list();
        // A run gives only its first vertex: the others follow, as all vertices are in the order of
        // their primitives.
        key_integer(out, "startvertex", vertex);
        key_integer(out, "nprimitives", end - begin);
        if (!tets) {
            const std::vector<std::int32_t> runs = run_lengths(primitives, begin, end);
            out.text("nvertices_rle");
            out.numbers(runs.data(), runs.size());
        }
        out.close_list();
        out.close_list();
        vertex += vertices;
    }
    out.close_list();
}

/// A byte per element: Houdini's other way, of run lengths, is not read by all readers.
void write_group(DocumentWriter& out, const Group& group)
{
    out.new_line();
    out.open_list();
    out.open_list();
    key_text(out, "name", group.name);
    out.close_list();
    out.open_list();
    out.text("selection");
    out.open_list();
    out.text("unordered");
    out.open_list();
    out.text("i8");
    const std::vector<std::int8_t> members(group.members.begin(), group.members.end());
    out.numbers(members.data(), members.size());
    out.close_list();
    out.close_list();
    out.close_list();
    out.close_list();
}

void write_groups(DocumentWriter& out, const char* key, const std::vector<Group>& groups)
{
    if (groups.empty())
        return;
    out.new_line();
    out.text(key);
    out.open_list();
    for (const Group& group : groups)
        write_group(out, group);
    out.close_list();
}

/// A flat list of keys and values in turn, which is how Houdini writes most maps. The order of the
/// keys is that of docs/houdini.md, with all counts before what they count.
void write_document(DocumentWriter& out, const HoudiniGeometry& geometry)
{
    out.open_list();
    out.new_line();
    write_head(out, geometry);
    write_topology(out, geometry);
    write_attributes(out, geometry);
    write_primitives(out, geometry);
    write_groups(out, "pointgroups", geometry.point_groups);
    write_groups(out, "vertexgroups", geometry.vertex_groups);
    write_groups(out, "primitivegroups", geometry.primitive_groups);
    out.new_line();
    out.close_list();
    out.finish();
}

std::string lower_name(const fs::path& path)
{
    std::string name = path.filename().string();
    std::transform(name.begin(), name.end(), name.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return name;
}

bool ends_in(const std::string& name, std::string_view extension)
{
    return name.size() >= extension.size() &&
           name.compare(name.size() - extension.size(), extension.size(), extension) == 0;
}

/// The reader goes by the content; a writer has nothing but the name.
Format format_by_extension(const fs::path& path)
{
    const std::string name = lower_name(path);
    // By the whole name, since std::filesystem takes .sc alone for the extension.
    if (ends_in(name, ".bgeo.sc"))
        return Format::compressed;
    if (ends_in(name, ".bgeo"))
        return Format::binary;
    if (ends_in(name, ".geo"))
        return Format::text;
    throw InvalidOption(path.string() +
                        ": unknown extension for Houdini geometry; known are .geo .bgeo .bgeo.sc");
}

} // namespace

const char* name_of(Format format)
{
    switch (format) {
    case Format::text:
        return "Houdini geometry (text)";
    case Format::binary:
        return "Houdini geometry (binary)";
    case Format::compressed:
        return "Houdini geometry (compressed)";
    }
    return "";
}

bool has_geometry_extension(const fs::path& path)
{
    const std::string name = lower_name(path);
    return ends_in(name, ".geo") || ends_in(name, ".bgeo") || ends_in(name, ".bgeo.sc");
}

void write_geometry(std::ostream& out, const HoudiniGeometry& geometry, Format format)
{
    const Sink stream = [&out](const char* data, std::size_t size) {
        out.write(data, static_cast<std::streamsize>(size));
    };
    if (format == Format::text)
        return write_document(*make_text_writer(stream), geometry);
    if (format == Format::binary)
        return write_document(*make_binary_writer(stream), geometry);
    // The writer's bytes go through the container piece by piece, so the uncompressed document is
    // never in memory as a whole.
    ScfWriter compressed(stream);
    write_document(*make_binary_writer([&compressed](const char* data, std::size_t size) {
        compressed.write(data, size);
    }),
                   geometry);
    compressed.finish();
}

void write_geometry(const fs::path& path, const HoudiniGeometry& geometry)
{
    // Name and geometry are tested before the file is opened, so nothing is written that could not
    // be read back.
    const Format format = format_by_extension(path);
    require_consistent(geometry);
    write_stream_atomically(path,
                            [&](std::ostream& out) { write_geometry(out, geometry, format); });
}

} // namespace vdb_shell::houdini
