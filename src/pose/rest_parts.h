// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "certify/free_faces.h"
#include "pose/skin_motion.h"
#include "vdb_shell/pose/pose_shell.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace vdb_shell
{

/// Of each corner of a tet the others, so that with it as the last the tet is turned as it is.
inline constexpr std::array<std::array<std::size_t, 3>, 4> kOtherCorners{
    {{1, 3, 2}, {0, 2, 3}, {0, 3, 1}, {0, 1, 2}}};

/// A tet at rest, as its deformation is measured: `gradient[i]` is that of corner i's barycentric
/// coordinate, so the map's Jacobian is the sum of posed corners times gradients.
struct RestTet {
    std::array<openvdb::Vec3d, 4> gradient;

    /// False for a tet so flat at rest that doubles do not see it as positive.
    bool measurable() const { return gradient[1].lengthSqr() > 0; }
};

/// The shell at rest in the terms of posing. *Points* are those of its tets, the core's behind
/// them.
struct RestShell::Parts {
    static constexpr std::uint32_t kFree = ~std::uint32_t(0);

    ShellStack stack;
    CoreTets core;
    TetMesh tets; ///< of the shell alone

    std::vector<openvdb::Vec3d> rest; ///< by point
    std::vector<openvdb::Vec4I> all;  ///< tets of shell and core
    std::vector<RestTet> rest_tet;    ///< by tet
    std::vector<std::uint32_t>
        skin_vertex; ///< by point: the vertex of the skin that it is, or kFree
    std::vector<std::uint32_t> first, incident; ///< point -> its tets
    std::vector<double> spacing;                ///< by point: mean length of its tets' edges there
    std::vector<std::vector<std::uint32_t>> colour; ///< free points, none beside one of the same
    /// By point: the vertices whose pillars it is an end of; none for points inside the core.
    std::vector<std::uint32_t> first_source, source;
    std::vector<std::uint32_t> point_of_place; ///< by place (shell/shared_points.h); kFree: none
    std::vector<std::uint32_t> first_place;    ///< first_places()
    SkinMotion motion;
    std::vector<std::array<std::uint32_t, 2>> neighbours; ///< triangles that share an edge
    /// Of a tapered shell: the triangles that bound what its tets cover, and the triangle of the
    /// surface that each of them belongs to. None where something fills the shell: then all faces
    /// but the surface's have two tets.
    FreeFaces free;
    std::vector<std::uint32_t> triangle_of_face;
    /// Pairs of them that share an edge, with nothing but void between them there.
    std::vector<std::array<std::uint32_t, 2>> neighbour_faces;

    explicit Parts(ShellStack s, CoreTets c);
};

} // namespace vdb_shell
