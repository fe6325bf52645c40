// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/mesh/triangle_mesh.h"
#include "vdb_shell/options/name_table.h"
#include "vdb_shell/shell/shell_stack.h"

namespace vdb_shell
{

/// On which side of the surface the shell lies.
enum class Side {
    inward,  ///< in the solid
    outward, ///< around it, in cavities too
    both,    ///< the two of them, with the surface between
};
const NameTable<Side>& names(Side);

/// Shells outside a surface are shells inside the reversed one: what was outside lies behind its
/// triangles, a solid without a bound. Stages from compute_directions to grow_shell run on the
/// reversed surface, with the level set negated and a finite cap on every length, and turn_back
/// then gives the shell in the orientation of the input (docs/theory.md, "Outward
/// shells, and shells on both sides").

/// Every triangle turned round: its second and third corner change places.
TriangleMesh reversed_surface(TriangleMesh mesh);

/// The cap on outward lengths where the user gives none: a share kOutwardShare of the diagonal of
/// the bounding box. Around a convex object there is no medial axis that could end a line, and no
/// length that follows from the shape.
inline constexpr double kOutwardShare = 0.1;
double default_outward_thickness(const TriangleMesh& mesh);

/// Layers of a reversed surface as layers of the surface itself: triangles are turned round, the
/// two surfaces of each layer change roles, so that the outermost one comes first, and the orders
/// of the diagonals are turned about. The tets stay the same sets of points, with the same signs,
/// and pins stay pins. The skin is the innermost surface afterwards.
/// Precondition: the skin of `reversed` is its surface 0.
ShellStack turn_back(const ShellStack& reversed);

/// Layers outside and layers inside of one surface, as one stack with the surface as its skin.
/// Precondition: the innermost surface of `outside` and the outermost of `inside` are the same
/// surface, bit for bit, with the same triangles.
ShellStack join_sides(ShellStack outside, ShellStack inside);

} // namespace vdb_shell
