// SPDX-License-Identifier: Apache-2.0
#pragma once

// Our own look at a mesh file, before OpenMesh reads it. OpenMesh's readers trust their input: they
// allocate by the counts of a header, take a truncated file for a short one, leave out faces, and
// misread legal files (docs of each scan). So a scan checks the file, counts what it holds and
// keeps of it what OpenMesh reads correctly.

#include "io/coordinates.h"
#include "io/scan_text.h"

#include <openvdb/Types.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace vdb_shell
{

struct FileScan {
    std::string format;  ///< for the report
    std::string reader;  ///< the extension by which OpenMesh picks its reader
    bool binary = false; ///< what that reader has to be told
    std::string stream;  ///< what that reader is given
    std::size_t file_vertices = 0;
    std::size_t file_faces = 0;
    std::size_t corners_passed_on = 0;
    std::vector<openvdb::Vec3s> points;     ///< what OpenMesh must deliver, in this order
    std::vector<std::size_t> skipped_faces; ///< file faces that are not passed on, ascending

    std::size_t faces_passed_on() const { return file_faces - skipped_faces.size(); }
};

// `coordinates` gets every coordinate of the file. Each throws ReadError as read_mesh documents it;
// `name` is the file's, for messages.
FileScan scan_obj(const std::string& name, const std::string& bytes, Coordinates& coordinates);
FileScan scan_ply(const std::string& name, const std::string& bytes, Coordinates& coordinates);
FileScan scan_off(const std::string& name, const std::string& bytes, Coordinates& coordinates);
FileScan scan_stl(const std::string& name, std::string bytes, Coordinates& coordinates);

using Corners = std::vector<std::uint32_t>;

/// Removes corners that repeat the corner before them. False when what is left is no polygon: fewer
/// than three corners, or none that comes only once.
bool tidy_polygon(Corners& corners);

/// The position of the first corner that comes only once; corners.size() when there is none.
std::size_t first_unique_corner(const Corners& corners);

/// Counts one more face of the file; false, and the face is recorded as skipped, when it is not
/// worth passing on.
bool count_face(FileScan& scan, Corners& corners);

/// Throws unless `index` is one of `vertices` vertices; `shown` is the index as the file has it.
void require_corner(const std::string& name, const Place& face, std::int64_t index,
                    std::size_t vertices, const std::string& shown);

/// For each point the first point that equals it (0 and -0 are equal).
std::vector<std::uint32_t> first_equal_point(const std::vector<openvdb::Vec3s>& points);

/// Appends the bytes of a number to the body of a PLY file that a header of
/// "binary_little_endian" announces.
template <typename Value> void append_bytes(std::string& out, Value value)
{
    out.append(reinterpret_cast<const char*>(&value), sizeof value);
}

/// The header of a PLY file of `coordinate` x, y, z and of faces as lists of int.
std::string plain_ply_header(const char* encoding, const char* coordinate, std::size_t vertices,
                             std::size_t faces);

} // namespace vdb_shell
