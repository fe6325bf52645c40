// SPDX-License-Identifier: Apache-2.0

// Takes: a valid stack and the wanted number of layers. Leaves: a valid stack, in which every layer
// has been cut into so many, and a count of what had to give way. Surfaces of the given stack keep
// their bits, triangles and diagonals are those of the layer that was cut; so tets meet face to
// face across the new surfaces without any search. Each given layer is cut by itself, in terms of
// the skin: shares are counted from there, on both sides of it (docs/theory.md, "Layers, and shells
// scaled down").

#include "vdb_shell/layers/cut_layers.h"

#include "vdb_shell/core/error.h"
#include "vdb_shell/options/option.h"

#include "core/stage_progress.h"
#include "layers/auto_shares.h"
#include "layers/columns.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>
#include <string>
#include <utility>

namespace vdb_shell
{
namespace
{

/// Shares of the pillar that lie between the skin and each of the n - 1 cuts, ascending. Shares may
/// coincide where a grading is so steep that a layer is lost in the rounding; that layer is then
/// pinned and has no tets, which is valid.
std::vector<double> shares_of(const LayerOptions& options)
{
    const bool growing = options.grading > 1.0;
    // Thickest first, so that only underflow can happen, which gives layers of no thickness;
    // overflow would give an infinite sum and shares that are not numbers.
    const double ratio = growing ? 1.0 / options.grading : options.grading;
    std::vector<double> thickness(1, 1.0);
    for (int i = 1; i < options.layers; ++i)
        thickness.push_back(thickness.back() * ratio);
    if (growing)
        std::reverse(thickness.begin(), thickness.end());
    std::vector<double> sums(thickness.size());
    std::partial_sum(thickness.begin(), thickness.end(), sums.begin());
    const double whole = sums.back();
    sums.pop_back();
    for (double& share : sums)
        share /= whole;
    return sums;
}

/// By cut and vertex.
std::vector<std::vector<double>> shares_of(const PrismShell& whole, bool above_skin,
                                           const LayerOptions& options)
{
    if (options.layers == 0)
        return auto_shares(whole, above_skin,
                           options.grading == 1 ? kAutoGrading : options.grading);
    std::vector<std::vector<double>> shares;
    for (const double share : shares_of(options))
        shares.emplace_back(whole.outer.size(), share);
    return shares;
}

/// Appends the layers that one layer of the input was cut into. Stacks run from the outermost to
/// the innermost layer, columns from the skin: above the skin the order is turned round.
void append_layers(const PrismShell& whole, const PrismSplit& split, bool above_skin,
                   Columns columns, ShellStack& result)
{
    auto& surface = columns.surface;
    if (above_skin)
        std::reverse(surface.begin(), surface.end());
    for (std::size_t k = 0; k + 1 < surface.size(); ++k) {
        PrismShell layer{surface[k], surface[k + 1], whole.triangles, whole.stop};
        result.layers.push_back(std::move(layer));
        result.splits.push_back(split);
    }
}

std::size_t count_empty(const ShellStack& stack)
{
    return std::size_t(
        std::count_if(stack.layers.begin(), stack.layers.end(),
                      [](const PrismShell& layer) { return layer.outer == layer.inner; }));
}

} // namespace

OptionList describe(LayerOptions& o)
{
    return in_group("Layers",
                    {option("layers", o.layers, "--layers",
                            "Layers that each pillar is cut into; 0, or auto: as many as shape "
                            "asks for, from place to place")
                         .in(Unit::count)
                         .within(at_least(0).at_most(double(ShellStack::kMostLayers)))
                         .with_shorthand("--layers-auto", "0"),
                     option("grading", o.grading, "--layer-grading",
                            "Thickness of each layer over that of the one nearer to the surface")
                         .needing("--layers")
                         .within(above(0))});
}

int most_layers(const LayerOptions& options)
{
    return options.layers == 0 ? kMostAutoLayers : options.layers;
}

void require_sensible(const LayerOptions& options)
{
    require_in_range(options, "layers");
}

LayerResult cut_layers(const ShellStack& stack, const LayerOptions& options, PrismTest test,
                       Interrupter* interrupter)
{
    require_sensible(options);
    const std::size_t total = std::size_t(most_layers(options)) * stack.layers.size();
    if (total > ShellStack::kMostLayers)
        throw InvalidOption("layers: " + std::to_string(total) + " in all, must be at most " +
                            std::to_string(ShellStack::kMostLayers));
    assert(!stack.layers.empty() && stack.splits.size() == stack.layers.size());
    const StageProgress progress(interrupter, "layers");
    LayerResult result;
    if (options.layers == 1) {
        // Not through the code below: it would give the same points, but count the pillars of
        // prisms that were bad before as uncut.
        result.stack = stack;
        return result;
    }
    for (std::size_t k = 0; k < stack.layers.size(); ++k) {
        progress.stop_if_interrupted(int(100 * k / stack.layers.size()));
        const PrismShell& whole = stack.layers[k];
        const bool above_skin = k < stack.skin;
        Columns columns = cut_pillars(whole, stack.splits[k], shares_of(whole, above_skin, options),
                                      above_skin, test);
        const std::vector<std::vector<openvdb::Vec3s>> nominal = columns.surface;
        mend_columns(columns, progress);
        result.report.uncut += keep_whole_where_bad(columns);
        result.report.moved += points_that_differ(columns.surface, nominal);
        append_layers(whole, stack.splits[k], above_skin, std::move(columns), result.stack);
        if (k + 1 == stack.skin)
            result.stack.skin = result.stack.layers.size();
    }
    result.report.empty = count_empty(result.stack);
    return result;
}

} // namespace vdb_shell
