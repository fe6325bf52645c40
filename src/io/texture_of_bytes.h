// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/io/texture_coordinates.h"

#include <string>
#include <string_view>

namespace vdb_shell
{

/// read_texture_coordinates of a file's bytes. `extension`: ".obj" or ".ply"; others are refused.
TextureCoordinates texture_of_bytes(const std::string& name, const std::string& extension,
                                    std::string_view bytes, const Placement& placement = {});

} // namespace vdb_shell
