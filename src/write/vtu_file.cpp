// SPDX-License-Identifier: Apache-2.0

// Tets as VTK's XML file of an unstructured grid. The arrays are in base 64 inside of the XML: they
// are exact, and any XML parser reads the file, which it would not with raw data appended. There is
// no compression, so the bytes depend on no library. Coordinates are Float32 as long as no
// placement moves them; else they are Float64, since the sum with the origin need not fit a float.
// What the arrays hold is in docs/file_format.md.

#include "core/byte_order.h"
#include "core/parallel.h"
#include "vdb_shell/shell/core_tets.h"
#include "vdb_shell/shell/quality.h"
#include "vdb_shell/write/text_out.h"
#include "write/base64.h"
#include "write/tet_formats.h"

#include <cstdint>
#include <string>

namespace vdb_shell
{
namespace
{

constexpr std::uint8_t kVtkTetra = 10;

/// The arrays are written as they lie in memory, so the header tells the byte order of this
/// machine.
const char* byte_order()
{
    return little_endian_machine() ? "LittleEndian" : "BigEndian";
}

template <typename T>
void write_array(TextOut& text, const char* type, const char* name, int components,
                 const std::vector<T>& values, std::size_t tuples = 0)
{
    const std::uint64_t size = values.size() * sizeof(T);
    text << "<DataArray type=\"" << type << "\" Name=\"" << name << "\" NumberOfComponents=\""
         << components << '"';
    // Of points and cells VTK knows how many there are.
    if (tuples > 0)
        text << " NumberOfTuples=\"" << tuples << '"';
    text << " format=\"binary\">\n";
    // The length is a base-64 block of its own, padded before the data begin: VTK decodes the
    // header before it knows how much follows.
    text << base64(reinterpret_cast<const unsigned char*>(&size), sizeof size)
         << base64(reinterpret_cast<const unsigned char*>(values.data()), std::size_t(size))
         << "\n</DataArray>\n";
}

/// With a core there are numbers below 0.
template <typename T>
void write_numbers(TextOut& text, const TetMesh& tets, const char* type, const char* name,
                   const std::vector<T>& values)
{
    if (has_core(tets))
        write_array(text, "Int32", name, 1, signed_numbers(values));
    else
        write_array(text, type, name, 1, values);
}

void write_cells(TextOut& text, const TetMesh& tets)
{
    const std::size_t count = tets.tets.size();
    // `offsets` has the end of each cell in the list of corners, not its start.
    // 64 bits, for four corners a tet pass 32 bits at half a billion tets.
    std::vector<std::int64_t> corners(4 * count), ends(count);
    for (std::size_t t = 0; t < count; ++t) {
        for (std::size_t corner = 0; corner < 4; ++corner)
            corners[4 * t + corner] = tets.tets[t][int(corner)];
        ends[t] = std::int64_t(4 * (t + 1));
    }
    text << "<Cells>\n";
    write_array(text, "Int64", "connectivity", 1, corners);
    write_array(text, "Int64", "offsets", 1, ends);
    write_array(text, "UInt8", "types", 1, std::vector<std::uint8_t>(count, kVtkTetra));
    text << "</Cells>\n";
}

/// Places in the file's coordinates.
void write_places(TextOut& text, const char* name, const std::vector<openvdb::Vec3s>& places,
                  const Placement& placement)
{
    // Vectors are written as one run of numbers, which holds only if they have no padding.
    static_assert(sizeof(openvdb::Vec3s) == 3 * sizeof(float));
    static_assert(sizeof(openvdb::Vec3d) == 3 * sizeof(double));
    if (!placement.moves())
        return write_array(text, "Float32", name, 3, places);
    std::vector<openvdb::Vec3d> placed;
    placed.reserve(places.size());
    for (const openvdb::Vec3s& place : places)
        placed.push_back(placement.in_file(place));
    write_array(text, "Float64", name, 3, placed);
}

/// Differences of places, lengths. The unit is a power of two, so nothing is rounded.
std::vector<openvdb::Vec3s> in_unit_of_file(std::vector<openvdb::Vec3s> vectors,
                                            const Placement& placement)
{
    for (openvdb::Vec3s& vector : vectors)
        vector *= float(placement.unit);
    return vectors;
}

void write_feet(TextOut& text, const std::vector<CoreFoot>& feet, const Placement& placement)
{
    if (feet.empty())
        return;
    // A column each, as VTK has arrays of one type only.
    std::vector<std::int32_t> core, triangle;
    std::vector<openvdb::Vec3s> uvw;
    std::vector<float> distance;
    for (const CoreFoot& foot : feet) {
        core.push_back(foot.core);
        triangle.push_back(foot.triangle);
        uvw.push_back(foot.uvw);
        distance.push_back(foot.distance * float(placement.unit));
    }
    write_array(text, "Int32", "core", 1, core);
    write_array(text, "Int32", "core_triangle", 1, triangle);
    write_array(text, "Float32", "core_uvw", 3, uvw);
    write_array(text, "Float32", "core_distance", 1, distance);
}

void write_pillars(TextOut& text, const PillarValues& pillars, const Placement& placement)
{
    if (!pillars.thickness.empty()) {
        std::vector<float> thickness = pillars.thickness;
        for (float& length : thickness)
            length *= float(placement.unit);
        write_array(text, "Float32", "thickness", 1, thickness);
    }
    if (!pillars.stop_reason.empty())
        write_array(text, "Int32", "stop_reason", 1, pillars.stop_reason);
}

/// By tet, the shape that the report's quality.mean_ratio is about.
std::vector<float> mean_ratios(const TetMesh& tets)
{
    std::vector<float> ratios(tets.tets.size());
    for_each_index(ratios.size(), [&](std::size_t t) { ratios[t] = float(mean_ratio(tets, t)); });
    return ratios;
}

/// Arrays of the whole file, as long as they are.
void write_input(TextOut& text, const InputPoints& input, const Placement& placement)
{
    if (input.empty())
        return;
    std::vector<openvdb::Vec3d> points;
    for (const openvdb::Vec3s& point : input.points)
        points.push_back(placement.in_file(point));
    std::vector<std::int32_t> corners;
    for (const openvdb::Vec3I& c : input.corners)
        for (int k = 0; k < 3; ++k)
            corners.push_back(std::int32_t(c[k]));
    text << "<FieldData>\n";
    const std::size_t tuples = points.size();
    write_array(text, "Float64", "input_points", 3, points, tuples);
    write_array(text, "Int32", "input_corners", 3, corners, tuples);
    write_array(text, "Float32", "input_weights", 3, input.weights, tuples);
    text << "</FieldData>\n";
}

} // namespace

void write_vtu(std::ostream& out, const TetMesh& tets, const std::vector<std::uint8_t>& certified,
               const Placement& placement, const PointExtras& extras)
{
    TextOut text(out);
    text << "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" "
            "byte_order=\""
         << byte_order() << "\" header_type=\"UInt64\">\n<UnstructuredGrid>\n";
    // Before the piece: arrays of the file stand outside of it, and have their own lengths.
    write_input(text, extras.input, placement);
    text << "<Piece NumberOfPoints=\"" << tets.points.size() << "\" NumberOfCells=\""
         << tets.tets.size() << "\">\n<PointData>\n";
    write_numbers(text, tets, "UInt32", "source_vertex", tets.source_vertex);
    write_numbers(text, tets, "UInt8", "layer", tets.layer);
    write_pillars(text, extras.pillars, placement);
    write_feet(text, extras.feet, placement);
    if (!extras.rest.empty())
        write_places(text, "rest", extras.rest, placement);
    if (!extras.velocity.empty())
        write_array(text, "Float32", "v", 3, in_unit_of_file(extras.velocity, placement));
    text << "</PointData>\n<CellData>\n";
    write_numbers(text, tets, "UInt32", "prism", tets.prism);
    if (has_layers(tets))
        write_numbers(text, tets, "UInt8", "layer", tets.prism_layer);
    write_array(text, "Float32", "mean_ratio", 1, mean_ratios(tets));
    if (!certified.empty())
        write_array(text, "UInt8", "certified", 1, certified);
    text << "</CellData>\n<Points>\n";
    write_places(text, "Points", tets.points, placement);
    text << "</Points>\n";
    write_cells(text, tets);
    text << "</Piece>\n</UnstructuredGrid>\n</VTKFile>\n";
}

} // namespace vdb_shell
