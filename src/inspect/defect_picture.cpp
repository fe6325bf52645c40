// SPDX-License-Identifier: Apache-2.0

// Takes a mesh however bad it is and writes it with its defects as colours, so that a person finds
// the places in any program that shows a PLY with colours. Points and triangles both have marks:
// holes and blind vertices are seen best at points, what belongs to a triangle at the triangle. All
// marks stand in a property of bits beside the colour, which shows the worst one only. Unlike the
// report, which names the first few of each kind, this marks every one. The same marks as the
// report's come from mark_defects(), so the two cannot disagree.

#include "inspect/marks.h"

#include "vdb_shell/core/atomic_file.h"
#include "vdb_shell/core/error.h"
#include "vdb_shell/core/words.h"

#include <array>
#include <cstring>
#include <ostream>

namespace vdb_shell
{
namespace
{

/// The bits of the property `defects`, worst last: the highest one gives the colour. They are a
/// part of the file, and docs/stages/repair.md tells their meaning to other programs, so the values
/// never change.
enum Mark : std::uint16_t {
    thin = 1,
    blind = 2,
    flipped = 4,
    boundary = 8,
    one_sided = 16,
    degenerate = 32,
    duplicate = 64,
    non_manifold = 128,
    crossing = 256,
};
constexpr int kMarks = 9;
using Colour = std::array<unsigned char, 3>;
constexpr Colour kSound{200, 200, 200};
constexpr std::array<Colour, kMarks> kColours{{{150, 200, 255}, // thin: light blue
                                               {0, 0, 160},     // blind: dark blue
                                               {160, 32, 240},  // flipped: violet
                                               {255, 165, 0},   // boundary: orange
                                               {0, 160, 160},   // one-sided: teal
                                               {120, 70, 20},   // degenerate: brown
                                               {0, 160, 0},     // duplicate: green
                                               {255, 0, 255},   // non-manifold: magenta
                                               {220, 0, 0}}};   // crossing: red

struct Marked {
    std::vector<std::uint16_t> points, triangles;
};

Colour colour_of(std::uint16_t marks)
{
    for (std::size_t bit = kMarks; bit-- > 0;)
        if (marks >> bit & 1)
            return kColours[bit];
    return kSound;
}

void mark_edges(Marked& marked, const std::vector<Edge>& edges, Mark mark)
{
    for (const Edge& edge : edges)
        for (const std::uint32_t point : edge)
            marked.points[point] |= mark;
}

/// The triangles of the marked edges: those at the edge, not all at its ends, where most triangles
/// are sound. The uses come sorted by edge, so those of one edge stand together.
void mark_triangles_at(Marked& marked, const EdgeUses& uses)
{
    for (std::size_t begin = 0, end = 0; begin < uses.size(); begin = end) {
        while (end < uses.size() && uses[end].edge == uses[begin].edge)
            ++end;
        const std::uint16_t mark = end - begin == 1  ? Mark::boundary
                                   : end - begin > 2 ? Mark::non_manifold
                                                     : 0;
        for (std::size_t i = begin; i < end; ++i)
            marked.triangles[uses[i].triangle] |= mark;
    }
}

Marked marks_of(const TriangleMesh& mesh, const DefectMarks& found)
{
    Marked marked{std::vector<std::uint16_t>(mesh.points.size()),
                  std::vector<std::uint16_t>(mesh.triangles.size())};
    const auto raise = [](std::vector<std::uint16_t>& marks,
                          const std::vector<std::uint32_t>& indices, Mark mark) {
        for (const std::uint32_t i : indices)
            marks[i] |= mark;
    };
    // Edges have no place of their own in the file, so their ends and their triangles are marked
    // instead.
    mark_edges(marked, found.surface.boundary_edges, Mark::boundary);
    mark_edges(marked, found.surface.non_manifold_edges, Mark::non_manifold);
    mark_triangles_at(marked, found.uses);
    raise(marked.points, found.surface.non_manifold_vertices, Mark::non_manifold);
    raise(marked.points, found.blind, Mark::blind);
    raise(marked.triangles, found.thin, Mark::thin);
    raise(marked.triangles, found.flipped, Mark::flipped);
    raise(marked.triangles, found.one_sided, Mark::one_sided);
    raise(marked.triangles, found.surface.degenerate_triangles, Mark::degenerate);
    raise(marked.triangles, found.surface.duplicate_triangles, Mark::duplicate);
    for (const TrianglePair& pair : found.surface.self_intersections)
        for (const std::uint32_t t : pair)
            marked.triangles[t] |= Mark::crossing;
    return marked;
}

/// Little-endian whatever the machine, since the bytes are taken out by shifts. The header says so.
template <typename Unsigned> void put(std::string& out, Unsigned value)
{
    for (std::size_t byte = 0; byte < sizeof value; ++byte)
        out.push_back(static_cast<char>(value >> (8 * byte) & 0xFF));
}

void put_marks(std::string& out, std::uint16_t marks)
{
    for (const unsigned char channel : colour_of(marks))
        put(out, channel);
    put(out, marks);
}

std::string ply_bytes(const TriangleMesh& mesh, const Marked& marked)
{
    const std::string attributes = "property uchar red\nproperty uchar green\n"
                                   "property uchar blue\nproperty ushort defects\n";
    std::string out = "ply\nformat binary_little_endian 1.0\nelement vertex " +
                      std::to_string(mesh.points.size()) +
                      "\nproperty float x\nproperty float y\nproperty float z\n" + attributes +
                      "element face " + std::to_string(mesh.triangles.size()) +
                      "\nproperty list uchar int vertex_indices\n" + attributes + "end_header\n";
    for (std::size_t v = 0; v < mesh.points.size(); ++v) {
        for (int axis = 0; axis < 3; ++axis) {
            const float value = mesh.points[v][axis];
            std::uint32_t bits = 0;
            // The bits of the float as they are, which keeps every coordinate exactly, also those
            // that are -0.
            std::memcpy(&bits, &value, sizeof bits);
            put(out, bits);
        }
        put_marks(out, marked.points[v]);
    }
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        out.push_back(3);
        for (int corner = 0; corner < 3; ++corner)
            put(out, std::uint32_t(mesh.triangles[t][corner]));
        put_marks(out, marked.triangles[t]);
    }
    return out;
}

} // namespace

void write_defect_picture(const std::filesystem::path& path, const TriangleMesh& mesh,
                          const InspectOptions& options, OutputSet* with, Interrupter* interrupter)
{
    if (lower_case_extension(path) != ".ply")
        throw InvalidOption(path.string() + ": the coloured mesh of the defects is a .ply, not \"" +
                            path.extension().string() + "\"");
    require_well_formed(mesh, "write_defect_picture");
    const DefectMarks found = mark_defects(mesh, voxel_size_to_inspect(mesh, options), interrupter);
    // All bytes are made before the file is opened, and the file then appears whole or not at all.
    const std::string bytes = ply_bytes(mesh, marks_of(mesh, found));
    write_stream_atomically(
        path,
        [&](std::ostream& out) {
            out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
        },
        with);
}

} // namespace vdb_shell
