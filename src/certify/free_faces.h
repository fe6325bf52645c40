// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/shell/shell_stack.h"

#include <cstdint>
#include <vector>

namespace vdb_shell
{

/// The triangles that may bound what the tets cover: the outer triangles, whether or not they are
/// faces of tets, then all other faces of a single tet, in the order of their tets.
struct FreeFaces {
    static constexpr std::uint32_t kNoTet = ~std::uint32_t(0);

    std::vector<openvdb::Vec3s> points; ///< those of the tets, then outer ones that no tet has
    std::vector<openvdb::Vec3I> faces;  ///< indices into `points`
    /// By face: the only tet that has it, kNoTet where an outer triangle has none, or several.
    std::vector<std::uint32_t> tet;
    std::size_t outer_count = 0;
    /// By tet: the first of those that hang together with it by faces of two tets.
    std::vector<std::uint32_t> piece;

    bool inner(std::size_t face) const { return face >= outer_count; }
};

FreeFaces find_free_faces(const ShellStack& stack, const TetMesh& tets);

/// Of each piece of the faces that have a tet, connected through edges of exactly two of them, the
/// first face, ascending.
std::vector<std::uint32_t> first_faces_of_pieces(const FreeFaces& free);

} // namespace vdb_shell
