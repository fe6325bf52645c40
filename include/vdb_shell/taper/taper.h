// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/core/interrupter.h"
#include "vdb_shell/obstacles/join_cores.h"
#include "vdb_shell/options/describe.h"
#include "vdb_shell/options/name_table.h"
#include "vdb_shell/shell/shell_stack.h"

#include <array>
#include <cstddef>
#include <vector>

namespace vdb_shell
{

/// What becomes of the innermost surface where two parts of it come close to each other.
enum class CoreSurface {
    free,     ///< they stay apart, as far as they are no neighbours: a surface to attach things to
    stitched, ///< they may become one: the void closes, and the solid is whole there
};
const NameTable<CoreSurface>& names(CoreSurface);

/// How a shell is tapered. Everything is weighed against the distortion of tets, which is 1 for a
/// regular tet and (AMIPS / 3)^1.5 for any other.
struct TaperOptions {
    bool wanted = false;
    /// What a tet costs besides its distortion: the larger, the fewer tets.
    double tet_cost = 4;
    /// The distortion counts to this power: the larger, the more the worst tets count.
    double shape_power = 1;
    /// What a tet costs besides that SOFA's mesh checks warn of (TetShape::sofa_bad).
    double poor_cost = 0;
    /// What an empty solid would cost for each triangle of the surface, or for each prism as high
    /// as edges are long that it would hold, if those are more: the larger, the fuller.
    double void_cost = 80;
    /// No change makes a tet of a larger AMIPS (3 for a regular tet), unless the tets that it
    /// replaces have one as bad.
    double worst_amips = 30;
    int rounds = 6;
    CoreSurface core = CoreSurface::free;
};
OptionList describe(TaperOptions& options);

struct TaperReport {
    std::size_t runs = 1;   ///< with other costs each, where bounds are wanted (build_shell)
    std::size_t rounds = 0; ///< of the run that was kept
    std::size_t merges = 0, moves = 0, handed_over = 0, turned = 0; ///< changes made
    std::size_t inner_points = 0;                                   ///< points below the surface
    /// Prisms of 0 (three pins), 1, 2 and 3 tets, over all layers.
    std::array<std::size_t, 4> prisms_by_tets{};
    /// Set by build_shell: the result was not certified, so the stack is the one before tapering.
    bool undone = false;
};

/// Lets vertices share inner points, moves those points, and turns diagonals, as long as what the
/// tets cost falls; a triangle then has one, two or three tets in each layer. Every single change
/// is made under the exact tests of growth: all tets stay positive, no pillar gets longer than its
/// cap, and the innermost surface touches neither itself nor the outer one but in points that are
/// shared. So a valid stack stays valid (docs/theory.md, "Tapered shells"); the certificate decides
/// afresh. Between layers points may move as well, and a layer may end where its pillars have lost
/// their length. Sets `stack.tapered`. Same bits for any number of threads.
/// `cap`: by vertex, the upper bound of the length of its pillar, may be infinite.
/// `obstacles`: vertices that are pinned throughout, of components of their own, with which no
/// point becomes one.
/// Precondition: the stack is certified and lies inward of its skin, surface 0, which touches
/// itself nowhere. Throws InvalidOption for options out of their range; Cancelled.
TaperReport taper_shell(ShellStack& stack, const std::vector<double>& cap,
                        const TaperOptions& options, Interrupter* interrupter = nullptr,
                        const VertexRange& obstacles = {});

} // namespace vdb_shell
