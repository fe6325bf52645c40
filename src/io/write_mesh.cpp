// SPDX-License-Identifier: Apache-2.0

// Writes a mesh so that reading it gives the same float32 bit for bit: the shortest decimals that
// do so, or the bits themselves. An object that was read about an origin is put back in doubles,
// where it stood. Nothing depends on the locale or on the machine's byte order: numbers are made by
// std::to_chars and std::to_string, since streams may put separators into large integers, and bits
// are written byte by byte. The file appears whole or not at all (core/atomic_file.cpp).

#include "core/unit_vector.h"
#include "io/mesh_formats.h"
#include "vdb_shell/core/atomic_file.h"
#include "vdb_shell/core/error.h"
#include "vdb_shell/io/read_mesh.h"

#include <array>
#include <charconv>
#include <cstring>
#include <optional>
#include <ostream>

namespace vdb_shell
{
namespace
{

/// The shortest decimals that give the same number when read.
template <typename Vec> void put_decimals(std::ostream& out, const Vec& point)
{
    for (int axis = 0; axis < 3; ++axis) {
        std::array<char, 32> digits{};
        const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), point[axis]);
        if (axis > 0)
            out.put(' ');
        out.write(digits.data(), end.ptr - digits.data());
    }
    out.put('\n');
}

/// Moved points are doubles: the digits of the float would put them elsewhere.
void put(std::ostream& out, const openvdb::Vec3s& point, const Placement& placement)
{
    if (placement.moves())
        put_decimals(out, placement.in_file(point));
    else
        put_decimals(out, point);
}

/// Lowest byte first whatever the machine, as binary STL and the PLY header below say.
void put_bits(std::ostream& out, std::uint32_t value)
{
    for (int byte = 0; byte < 4; ++byte)
        out.put(static_cast<char>(value >> (8 * byte) & 0xFF));
}

void put_bits(std::ostream& out, const openvdb::Vec3s& point)
{
    for (int axis = 0; axis < 3; ++axis) {
        const float value = point[axis];
        std::uint32_t bits = 0;
        std::memcpy(&bits, &value, sizeof bits);
        put_bits(out, bits);
    }
}

void put_bits(std::ostream& out, const openvdb::Vec3d& point)
{
    for (int axis = 0; axis < 3; ++axis) {
        const double value = point[axis];
        std::uint64_t bits = 0;
        std::memcpy(&bits, &value, sizeof bits);
        put_bits(out, static_cast<std::uint32_t>(bits));
        put_bits(out, static_cast<std::uint32_t>(bits >> 32));
    }
}

void write_obj(std::ostream& out, const TriangleMesh& mesh, const Placement& placement)
{
    for (const openvdb::Vec3s& point : mesh.points) {
        out << "v ";
        put(out, point, placement);
    }
    for (const openvdb::Vec3I& t : mesh.triangles)
        // OBJ counts from 1.
        out << "f " << std::to_string(t[0] + 1) << ' ' << std::to_string(t[1] + 1) << ' '
            << std::to_string(t[2] + 1) << '\n';
}

void write_off(std::ostream& out, const TriangleMesh& mesh, const Placement& placement)
{
    out << "OFF\n"
        << std::to_string(mesh.points.size()) << ' ' << std::to_string(mesh.triangles.size())
        << " 0\n";
    for (const openvdb::Vec3s& point : mesh.points)
        put(out, point, placement);
    for (const openvdb::Vec3I& t : mesh.triangles)
        out << "3 " << std::to_string(t[0]) << ' ' << std::to_string(t[1]) << ' '
            << std::to_string(t[2]) << '\n';
}

void write_ply(std::ostream& out, const TriangleMesh& mesh, const Placement& placement)
{
    const bool moves = placement.moves();
    const std::string type = moves ? "double" : "float";
    out << "ply\nformat binary_little_endian 1.0\nelement vertex "
        << std::to_string(mesh.points.size()) << "\nproperty " << type << " x\nproperty " << type
        << " y\nproperty " << type << " z\nelement face " << std::to_string(mesh.triangles.size())
        << "\nproperty list int int vertex_indices\nend_header\n";
    for (const openvdb::Vec3s& point : mesh.points)
        moves ? put_bits(out, placement.in_file(point)) : put_bits(out, point);
    for (const openvdb::Vec3I& t : mesh.triangles) {
        put_bits(out, 3);
        for (int corner = 0; corner < 3; ++corner)
            put_bits(out, t[corner]);
    }
}

void write_stl(std::ostream& out, const TriangleMesh& mesh, const Placement&)
{
    // The header must not begin with "solid", by which readers tell text.
    std::array<char, 80> header{};
    std::strcpy(header.data(), "vdb_shell");
    out.write(header.data(), header.size());
    put_bits(out, static_cast<std::uint32_t>(mesh.triangles.size()));
    for (const openvdb::Vec3I& t : mesh.triangles) {
        const openvdb::Vec3d a(mesh.points[t[0]]), b(mesh.points[t[1]]), c(mesh.points[t[2]]);
        // A facet has the same order of corners as the mesh, so its normal points outward too.
        put_bits(out, openvdb::Vec3s(unit_vector((b - a).cross(c - a))));
        for (int corner = 0; corner < 3; ++corner)
            put_bits(out, mesh.points[t[corner]]);
        // The attribute bytes, which have no meaning that programs agree on.
        out.put(0).put(0);
    }
}

} // namespace

void require_place_for(const std::filesystem::path& path, const Placement& placement)
{
    if (mesh_format_of(path) == MeshFormat::stl && placement.moves())
        throw InvalidOption(path.string() + ": STL holds float32 only, which cannot say where the "
                                            "object stands; write .obj, .off or .ply");
}

void write_mesh(const std::filesystem::path& path, const TriangleMesh& mesh,
                const Placement& placement, OutputSet* with)
{
    const std::optional<MeshFormat> format = mesh_format_of(path);
    if (!format)
        throw InvalidOption(path.string() + ": " + no_mesh_format(path));
    const auto write = *format == MeshFormat::obj   ? write_obj
                       : *format == MeshFormat::off ? write_off
                       : *format == MeshFormat::ply ? write_ply
                                                    : write_stl;
    // Before the file is opened, so that what stands there stays.
    require_place_for(path, placement);
    write_stream_atomically(
        path, [&](std::ostream& out) { write(out, mesh, placement); }, with);
}

} // namespace vdb_shell
