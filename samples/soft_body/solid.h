// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include <array>
#include <filesystem>
#include <vector>

namespace soft_body
{

using Points = Eigen::Matrix3Xd; ///< a column a point; also displacements, forces, velocities
using Tet = std::array<int, 4>;
using Triangle = std::array<int, 3>;

struct Solid {
    Points points;
    std::vector<Tet> tets;  ///< det(b-a, c-a, d-a) > 0
    std::vector<int> layer; ///< per point, 0 on the outer surface, -1 in a filled core; empty where
                            ///< the file does not say
};

/// Reads a shell's .vdb by the library's reader; .node with its .ele, of this project (then with
/// layers) or of TetGen; legacy ASCII .vtk, cells that are no tets left out. Points of no tet are
/// dropped. Throws vdb_shell::ReadError with file, element and value, and GeometryError for a tet
/// that is not positive.
Solid read_solid(const std::filesystem::path& path);

/// Triangles of one tet only, outward.
std::vector<Triangle> boundary(const Solid& solid);

/// Those of the boundary that can be seen: where layers are known, the ones of the outer surface.
std::vector<Triangle> skin(const Solid& solid);

/// The triangles and their points as .obj. Throws vdb_shell::WriteError.
void write_obj(const std::filesystem::path& path, const Points& points,
               const std::vector<Triangle>& triangles);

} // namespace soft_body
