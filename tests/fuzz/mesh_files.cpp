// SPDX-License-Identifier: Apache-2.0
#include "fuzz/targets.h"

#include "io/file_scan.h"
#include "io/texture_of_bytes.h"
#include "vdb_shell/core/error.h"
#include "vdb_shell/mesh/check_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace vdb_shell::fuzz
{
namespace
{

void require_sound(const ReadResult& result, const ReadOptions& options)
{
    const TriangleMesh& mesh = result.mesh;
    require(!mesh.triangles.empty(), "a mesh without triangles");
    const std::size_t points = mesh.points.size();
    std::vector<bool> used(points, false);
    for (const openvdb::Vec3I& t : mesh.triangles) {
        require(t[0] < points && t[1] < points && t[2] < points, "a corner out of range");
        require(t[0] != t[1] && t[1] != t[2] && t[2] != t[0], "a triangle repeats a corner");
        for (int k = 0; k < 3; ++k)
            used[t[k]] = true;
    }
    require(std::find(used.begin(), used.end(), false) == used.end(), "a point without triangles");
    for (const openvdb::Vec3s& p : mesh.points)
        for (int axis = 0; axis < 3; ++axis)
            require(std::abs(double(p[axis])) <= kLargestCoordinate, "a coordinate out of range");
    const ReadReport& report = result.report;
    require(report.skipped_faces.size() < report.file_faces, "no face, yet triangles");
    if (!options.weld)
        require(report.welded_vertices == 0 || report.format.rfind("STL", 0) == 0,
                "welded unasked");
}

/// The options follow from the size, so that an input is the file itself.
void read(Scan scan, std::string_view bytes)
{
    if (bytes.empty()) // refused before it is scanned
        return;
    ReadOptions options;
    options.weld = bytes.size() % 2 == 0;
    options.recentre = bytes.size() % 3 == 0;
    options.rescale = bytes.size() % 5 == 0;
    try {
        require_sound(mesh_of_bytes("fuzz", scan, std::string(bytes), options), options);
    } catch (const ReadError& error) {
        require(std::string(error.what()).rfind("fuzz: ", 0) == 0, "refused without the name");
    }
}

void read_texture(const char* extension, std::string_view bytes)
{
    if (bytes.empty())
        return;
    try {
        const TextureCoordinates texture = texture_of_bytes("fuzz", extension, bytes);
        require(texture.corner.size() == texture.mesh.triangles.size(),
                "not three texture coordinates a triangle");
        for (const std::array<openvdb::Vec2d, 3>& corners : texture.corner)
            for (const openvdb::Vec2d& uv : corners)
                require(std::isfinite(uv[0]) && std::isfinite(uv[1]),
                        "a texture coordinate that is not finite");
    } catch (const ReadError& error) {
        require(std::string(error.what()).rfind("fuzz: ", 0) == 0, "refused without the name");
    }
}

} // namespace

void obj(std::string_view bytes)
{
    read(scan_obj, bytes);
}

void ply(std::string_view bytes)
{
    read(scan_ply, bytes);
}

void obj_texture(std::string_view bytes)
{
    read_texture(".obj", bytes);
}

void ply_texture(std::string_view bytes)
{
    read_texture(".ply", bytes);
}

void off(std::string_view bytes)
{
    read(scan_off, bytes);
}

void stl(std::string_view bytes)
{
    read(scan_stl, bytes);
}

} // namespace vdb_shell::fuzz
