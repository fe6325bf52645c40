// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/io/read_mesh.h"

#include "io/coordinates.h"
#include "io/file_scan.h"
#include "io/openmesh_read.h"
#include "io/polygon_soup.h"

#include <algorithm>
#include <cctype>

namespace vdb_shell
{
namespace
{

namespace fs = std::filesystem;

FileScan scan_file(const fs::path& path, Coordinates& coordinates)
{
    const std::string name = path.string();
    std::string extension = path.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (extension != ".obj" && extension != ".ply" && extension != ".off" && extension != ".stl")
        refuse(name, "the extension \"" + extension +
                         "\" is none of the mesh formats .obj, .ply, .off, .stl");
    std::string bytes = read_whole_file(path);
    FileScan scan = extension == ".obj"   ? scan_obj(name, bytes, coordinates)
                    : extension == ".ply" ? scan_ply(name, bytes, coordinates)
                    : extension == ".off" ? scan_off(name, bytes, coordinates)
                                          : scan_stl(name, std::move(bytes), coordinates);
    if (scan.file_faces == 0)
        refuse(name, "it has no faces (and " + std::to_string(scan.file_vertices) + " vertices)");
    return scan;
}

} // namespace

ReadResult read_mesh(const fs::path& path, const ReadOptions& options)
{
    Coordinates coordinates;
    if (options.recentre || options.rescale) {
        Coordinates looked = Coordinates::first_look();
        scan_file(path, looked);
        coordinates = Coordinates(placement_for(looked.box(), options.recentre, options.rescale));
    }
    const FileScan scan = scan_file(path, coordinates);
    ReadResult result =
        mesh_of_soup(path.string(), scan, read_with_openmesh(path.string(), scan), options);
    result.report.placement = coordinates.placement();
    result.report.largest_rounding = coordinates.largest_rounding();
    return result;
}

} // namespace vdb_shell
