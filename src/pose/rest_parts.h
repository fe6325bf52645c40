// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pose/skin_motion.h"
#include "vdb_shell/pose/pose_shell.h"

#include <array>
#include <cstdint>
#include <vector>

namespace vdb_shell
{

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

    explicit Parts(ShellStack s, CoreTets c);
};

} // namespace vdb_shell
