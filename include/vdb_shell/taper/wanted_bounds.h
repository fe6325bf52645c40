// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/mesh/triangle_mesh.h"
#include "vdb_shell/options/describe.h"
#include "vdb_shell/options/name_table.h"
#include "vdb_shell/shell/shell_stack.h"
#include "vdb_shell/shell/sides.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace vdb_shell
{

/// What the user asks of the shell. Nothing is refused for them once a surface has been read, but
/// for a number of tets that no shell of it has: the report says what was met.
struct WantedBounds {
    std::optional<double> min_dihedral_radians; ///< no tet has a smaller dihedral angle
    std::optional<double> amips;                ///< no tet has a larger one; 3 for the regular tet
    std::optional<double> edge_ratio;           ///< longest edge / shortest edge of any tet
    std::optional<double> fill;
    std::optional<std::uint64_t> tets; ///< at most so many

    bool any() const { return min_dihedral_radians || amips || edge_ratio || fill || tets; }
};
OptionList describe(WantedBounds& wanted);

enum class BoundKind { dihedral, amips, edge_ratio, fill, tets };
const NameTable<BoundKind>& names(BoundKind);

/// Why a tet falls short; the first that holds.
enum class ShortCause {
    surface_triangle, ///< no tet on its outer triangle reaches the bound
    surface_edge,     ///< two tets share less than twice the angle at an edge of the surface
    thickness,        ///< a pillar of its prism is as long as it may be
    room,             ///< none of these: the room below the surface, and the other wishes
};
constexpr std::size_t kShortCauses = 4;
const NameTable<ShortCause>& names(ShortCause);

struct ShortTet {
    std::uint32_t tet, prism, layer;
    double value; ///< of the tet, as WantedBound::reached
    ShortCause cause;
};

/// One wish and what became of it.
struct WantedBound {
    static constexpr std::size_t kFirstShown = 10;

    BoundKind kind = BoundKind::dihedral;
    double asked = 0, reached = 0; ///< reached: of the worst tet; angles in radians
    bool met = false;
    std::size_t short_tets = 0;
    std::array<std::size_t, kShortCauses> causes{}; ///< tets that fall short, by ShortCause
    std::vector<ShortTet> first;                    ///< the first by index
    /// How much is missing, 0 where it is met and 1 at most: the share of the tets that fall short
    /// or are too many, or of the fill that was asked for.
    double shortfall = 0;
};

struct BoundsReport {
    std::vector<WantedBound> bounds;

    bool met() const;
    /// To tell the better of two runs for the same bounds: first the one that misses fewer of them,
    /// then the one that misses by less, all bounds alike. 0 where all are met.
    double shortfall() const;
};

/// What the shell of `surface` has of what is wanted. `cap`: by vertex, the most that its pillar
/// may be long, may be infinite. Deterministic.
BoundsReport judge_bounds(const ShellStack& stack, const TetMesh& tets, const TriangleMesh& surface,
                          Side side, const std::vector<double>& cap, const WantedBounds& wanted);

} // namespace vdb_shell
