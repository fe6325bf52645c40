// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mesh/file_scan.h"

#include <string>
#include <vector>

namespace vdb_shell
{

/// Points and polygons as a file has them.
struct PolygonSoup {
    std::vector<openvdb::Vec3s> points;
    std::vector<Corners> faces;
};

/// Has OpenMesh read scan.stream, and holds what it delivers against the scan. Throws ReadError
/// when a vertex or a face is missing, added or changed.
PolygonSoup read_with_openmesh(const std::string& name, const FileScan& scan);

} // namespace vdb_shell
