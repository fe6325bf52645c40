// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "io/polygon_soup.h"

#include <string>

namespace vdb_shell
{

/// Has OpenMesh read scan.stream, and holds what it delivers against the scan. Throws ReadError
/// when a vertex or a face is missing, added or changed.
PolygonSoup read_with_openmesh(const std::string& name, const FileScan& scan);

} // namespace vdb_shell
