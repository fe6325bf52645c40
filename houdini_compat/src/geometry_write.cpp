// SPDX-License-Identifier: Apache-2.0

// Writes a geometry as a document of Houdini in any of the three forms. The document is the same in
// all of them, but for attributes (attributes_write.cpp). Of several spellings that Houdini
// accepts, the one is written that most other readers take too (docs/houdini.md tells who read the
// files). The bytes depend on the geometry and the program's version only: no date, user or
// machine. Precondition: require_consistent, which the function that takes a path calls.

#include "vdb_shell/houdini/geometry_file.h"

#include "vdb_shell/core/atomic_file.h"
#include "vdb_shell/core/error.h"
#include "vdb_shell/core/words.h"

#include "attributes_write.h"
#include "document_writer.h"

#include <algorithm>
#include <ostream>

namespace vdb_shell::houdini
{
namespace
{

namespace fs = std::filesystem;

/// The version of Houdini that the layout follows. Nothing here is newer than what Houdini 19
/// writes, and later ones read older files.
constexpr const char* kFileVersion = "19.0.0";

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

bool ends_in(const std::string& name, std::string_view extension)
{
    return name.size() >= extension.size() &&
           name.compare(name.size() - extension.size(), extension.size(), extension) == 0;
}

/// The reader goes by the content; a writer has nothing but the name.
Format format_by_extension(const fs::path& path)
{
    const std::string name = lower_case(path.filename().string());
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
    const std::string name = lower_case(path.filename().string());
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

void write_geometry(const fs::path& path, const HoudiniGeometry& geometry, OutputSet* with)
{
    // Name and geometry are tested before the file is opened, so nothing is written that could not
    // be read back.
    const Format format = format_by_extension(path);
    require_consistent(geometry);
    write_stream_atomically(
        path,
        [&](std::ostream& out) {
            try {
                write_geometry(out, geometry, format);
            } catch (const WriteError& error) {
                // The writers know streams only.
                throw WriteError(path.string() + ": " + error.what());
            }
        },
        with);
}

} // namespace vdb_shell::houdini
