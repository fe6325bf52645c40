// SPDX-License-Identifier: Apache-2.0

// Reads a mesh file: chooses the scan by the extension, reads the bytes, and hands the scan to the
// last steps of all formats. With an origin or a unit to be chosen the bytes are scanned twice,
// since the choice needs all coordinates before one of them is rounded; the first time every test
// is made too, but for the limit on size.

#include "vdb_shell/io/read_mesh.h"

#include "io/coordinates.h"
#include "io/file_scan.h"
#include "io/mesh_formats.h"
#include "vdb_shell/io/read_file.h"

#include <optional>
#include <string_view>
#include <utility>

namespace vdb_shell
{
namespace
{

namespace fs = std::filesystem;

Scan scan_for(const fs::path& path)
{
    const std::optional<MeshFormat> format = mesh_format_of(path);
    if (!format)
        refuse(path.string(), no_mesh_format(path));
    switch (*format) {
    case MeshFormat::obj:
        return scan_obj;
    case MeshFormat::ply:
        return scan_ply;
    case MeshFormat::off:
        return scan_off;
    case MeshFormat::stl:
        break;
    }
    return scan_stl;
}

/// Editors that write UTF-16 begin with its mark, which no text that is read here does, nor a
/// binary PLY. The header of a binary STL may hold any bytes.
void require_no_utf16(const std::string& name, std::string_view bytes)
{
    const std::string_view mark = bytes.substr(0, 2);
    if (mark == "\xFE\xFF" || mark == "\xFF\xFE")
        refuse(name, "the text is UTF-16, by its byte-order mark; UTF-8 or ASCII is needed");
}

} // namespace

ReadResult mesh_of_bytes(const std::string& name, Scan scan, std::string bytes,
                         const ReadOptions& options)
{
    if (scan != scan_stl)
        require_no_utf16(name, bytes);
    Coordinates coordinates;
    if (options.recentre || options.rescale) {
        // The origin must be known before the first coordinate is rounded.
        Coordinates looked = Coordinates::first_look();
        scan(name, bytes, looked);
        coordinates = Coordinates(placement_for(looked.box(), options.recentre, options.rescale));
    }
    FileScan found = scan(name, bytes, coordinates);
    // A large file and the mesh that comes of it need not be in memory at the same time.
    std::string().swap(bytes);
    return mesh_of_scan(name, std::move(found), coordinates, options);
}

ReadResult read_mesh(const fs::path& path, const ReadOptions& options)
{
    // Before the file is read, so a wrong name costs no time.
    const Scan scan = scan_for(path);
    return mesh_of_bytes(path.string(), scan, read_whole_file(path), options);
}

} // namespace vdb_shell
