// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/core/interrupter.h"
#include "vdb_shell/options/describe.h"
#include "vdb_shell/shell/prism_test.h"
#include "vdb_shell/shell/shell_stack.h"

#include <cstddef>

namespace vdb_shell
{

struct LayerOptions {
    /// Layers that each pillar is cut into. 0: as many as shape asks for, from place to place: the
    /// first is as high as its triangles are long, the others are graded, and a pillar that is too
    /// short for a layer has none of it.
    int layers = 1;
    /// Thickness of each layer over that of the one nearer to the surface: 1 gives equal layers, 2
    /// layers of 1/3 and 2/3. Where the number follows the shape, 1 stands for kAutoGrading.
    double grading = 1.0;
};
/// Of layers = 0: a fifth layer would begin 12 edges below the skin, which pillars seldom reach.
inline constexpr int kMostAutoLayers = 4;
/// Tapering about halves the number of edges along a line, so triangles below are twice as long.
inline constexpr double kAutoGrading = 2;
/// The most layers that a pillar may be cut into.
int most_layers(const LayerOptions& options);
OptionList describe(LayerOptions& options);

/// Throws InvalidOption for a negative number of layers, more than ShellStack::kMostLayers, or a
/// grading that is not positive and finite.
void require_sensible(const LayerOptions& options);

struct LayerReport {
    std::size_t moved = 0; ///< points between the layers that are not where the grading puts them
    std::size_t uncut = 0; ///< pillars that stayed whole: pinned in all layers but the farthest
    std::size_t empty = 0; ///< layers in which every pillar is pinned, so that they have no tets
};

struct LayerResult {
    ShellStack stack;
    LayerReport report;
};

/// Cuts each layer of the stack into `options.layers`, every pillar at the same shares of its
/// length, counted from the skin; points between the layers are rounded to the nearest float32.
/// Surfaces of the given stack stay as they are. All layers keep the diagonals of the one they were
/// cut from.
///
/// With twelve positive tets in a prism any cut gives positive tets (docs/theory.md, "Layers, and
/// shells scaled down"), but rounding may spoil them, and with the chosen three alone there is no
/// such promise. A point whose tets are not positive is moved: along its pillar, to next floats,
/// towards its neighbours. Where that does not help the pillars of the prism stay whole. So a
/// certified shell is cut into certified layers, always: at worst with no cut at all, and the
/// report tells how many pillars that concerns. A prism that failed `test` before cutting keeps its
/// failure. Same bits for any number of threads. Precondition: as certify_stack. Throws
/// InvalidOption for a negative number of layers, more than ShellStack::kMostLayers in all, or a
/// grading that is not positive and finite; Cancelled.
LayerResult cut_layers(const ShellStack& stack, const LayerOptions& options, PrismTest test,
                       Interrupter* interrupter = nullptr);

} // namespace vdb_shell
