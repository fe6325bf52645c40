// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/io/read_mesh.h"

#include "io/file_scan.h"

#include <filesystem>
#include <string>
#include <vector>

namespace vdb_shell
{

/// Points and polygons as a file has them.
struct PolygonSoup {
    std::vector<openvdb::Vec3s> points;
    std::vector<Corners> faces;
};

/// The last steps of every reader: welds, triangulates, drops points without triangles. `soup` has
/// the faces that `scan` did not skip, in order. Throws ReadError, opened by `name`, when no
/// triangle comes of it.
ReadResult mesh_of_soup(const std::string& name, const FileScan& scan, PolygonSoup soup,
                        const ReadOptions& options);

/// Throws ReadError for what is no regular file, cannot be read or is empty.
std::string read_whole_file(const std::filesystem::path& path);

} // namespace vdb_shell
