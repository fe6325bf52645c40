// SPDX-License-Identifier: Apache-2.0

// Takes a shell; leaves what a browser draws of it, in whole numbers of few bits. A shell of more
// prisms than turn smoothly is shown by some of its own pillars: its surface is coarsened to
// vertices that it has, and each keeps its whole pillar. That is for the eye alone; counts and
// histograms are those of all tets.

#include "write/page_shell.h"

#include "core/degrees.h"
#include "core/parallel.h"
#include "vdb_shell/resample/coarsen.h"
#include "vdb_shell/shell/quality.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace vdb_shell
{
namespace
{

using openvdb::Vec3d;
using openvdb::Vec3I;
using openvdb::Vec3s;

constexpr double kRegularDegrees = 70.528779365509308;

/// The pillars of some vertices, as a stack over other triangles of them.
ShellStack picked(const ShellStack& stack, const Coarsened& coarse)
{
    const auto of = [&](const std::vector<Vec3s>& all) {
        std::vector<Vec3s> some;
        some.reserve(coarse.from.size());
        for (const std::uint32_t v : coarse.from)
            some.push_back(all[v]);
        return some;
    };
    ShellStack result;
    result.skin = stack.skin;
    result.tapered = stack.tapered;
    // The diagonals are the page's own: those of the shell are of other prisms.
    SplitOptions split;
    split.rule = SplitRule::vertex_index;
    for (const PrismShell& layer : stack.layers) {
        PrismShell shell{of(layer.outer), of(layer.inner), coarse.mesh.triangles, {}};
        shell.stop.resize(coarse.from.size());
        result.splits.push_back(split_prisms(shell, split));
        result.layers.push_back(std::move(shell));
    }
    return result;
}

/// Every array but `from`, of a stack that is drawn as it is.
PageShell numbered(const ShellStack& stack, const TetMesh& tets, const CoreTets& core)
{
    const ShellPoints points = number_points(stack, tets);
    PageShell shown;
    shown.all_vertices = stack.surface(0).size();
    for (const Vec3I& triangle : stack.triangles())
        for (int corner = 0; corner < 3; ++corner)
            shown.triangles.push_back(triangle[corner]);
    for (const std::vector<std::uint32_t>& ids : points.id)
        shown.surfaces.insert(shown.surfaces.end(), ids.begin(), ids.end());
    const auto id_of = [&](std::uint32_t corner) {
        const std::size_t own = tets.points.size();
        return corner < own ? points.id_of_tet_point[corner]
                            : std::uint32_t(points.position.size() + corner - own);
    };
    for (const std::vector<openvdb::Vec4I>* list : {&tets.tets, &core.tets})
        for (const openvdb::Vec4I& tet : *list)
            for (int corner = 0; corner < 4; ++corner)
                shown.tets.push_back(id_of(tet[corner]));
    shown.prism = tets.prism;
    shown.layer = tets.prism_layer;
    shown.prism.resize(shown.prism.size() + core.tets.size(), kCorePrism);
    shown.layer.resize(shown.prism.size(), kCoreLayer);
    shown.vertex = points.vertex;
    shown.surface = points.layer;
    shown.core_points = core.points.size();
    return shown;
}

std::uint16_t share(double value, double low, double high)
{
    // A flat shell has a box without height in one direction.
    const double s = high > low ? (value - low) / (high - low) : 0;
    return std::uint16_t(std::lround(std::clamp(s, 0.0, 1.0) * 65535));
}

std::vector<double> least_degrees(const TetMesh& tets)
{
    std::vector<double> least(tets.tets.size());
    for_each_index(least.size(), [&](std::size_t t) {
        least[t] = degrees(shape_of(tets, t).min_dihedral_radians);
    });
    return least;
}

/// Per vertex of the surface, over all tets with a corner on its pillar.
std::vector<double> least_around(const TetMesh& tets, const std::vector<double>& degrees,
                                 std::size_t vertices)
{
    // A vertex without any tet has nothing bad around it.
    std::vector<double> least(vertices, kRegularDegrees);
    for (std::size_t t = 0; t < tets.tets.size(); ++t)
        for (int corner = 0; corner < 4; ++corner) {
            double& known = least[tets.source_vertex[tets.tets[t][corner]]];
            known = std::min(known, degrees[t]);
        }
    return least;
}

/// A tet of the coarser shell is none of the shell's; it has the angle of the worst tet around one
/// of its pillars.
std::vector<std::uint8_t> shown_angles(const PageShell& shown, const TetMesh& tets,
                                       const std::vector<double>& degrees)
{
    const auto byte_of = [](double angle) {
        return std::uint8_t(std::lround(std::clamp(angle / kRegularDegrees, 0.0, 1.0) * 255));
    };
    std::vector<std::uint8_t> angles;
    angles.reserve(shown.layer.size());
    if (!shown.coarser()) {
        for (const double angle : degrees)
            angles.push_back(byte_of(angle));
        return angles;
    }
    const std::vector<double> least = least_around(tets, degrees, shown.all_vertices);
    for (std::size_t t = 0; t < shown.layer.size(); ++t)
        angles.push_back(byte_of(least[shown.from[shown.vertex[shown.tets[4 * t]]]]));
    return angles;
}

std::vector<std::size_t> counts_of_bins(const std::vector<double>& values, double largest,
                                        std::size_t bins)
{
    std::vector<std::size_t> counts(bins, 0);
    for (const double value : values) {
        const double bin = largest > 0 ? value / largest * double(bins) : 0;
        // The largest value falls into the last bin, and not into one beyond.
        ++counts[std::min(std::size_t(std::max(bin, 0.0)), bins - 1)];
    }
    return counts;
}

void place_points(PageFrame& frame, const PageShell& shown, const ShellFile& file)
{
    // With all points of the outermost surface, also those that are not drawn, so that a coarser
    // drawing is no larger in its window.
    frame.box = bounds_of(file.stack.surface(0));
    const auto include = [&](const Vec3s& point) {
        const Vec3d p(point);
        frame.box.low = openvdb::math::minComponent(frame.box.low, p);
        frame.box.high = openvdb::math::maxComponent(frame.box.high, p);
    };
    const auto position = [&](std::size_t id) -> const Vec3s& {
        const std::size_t own = shown.vertex.size();
        const std::uint32_t v = id < own ? shown.vertex[id] : 0;
        return id < own ? file.stack.surface(shown.surface[id])[shown.coarser() ? shown.from[v] : v]
                        : file.core.points[id - own];
    };
    const std::size_t count = shown.vertex.size() + shown.core_points;
    for (std::size_t id = 0; id < count; ++id)
        include(position(id));
    frame.positions.reserve(3 * count);
    for (std::size_t id = 0; id < count; ++id)
        for (int axis = 0; axis < 3; ++axis)
            frame.positions.push_back(
                share(position(id)[axis], frame.box.low[axis], frame.box.high[axis]));
}

} // namespace

PageShell page_shell(const ShellFile& file, std::size_t most_prisms)
{
    const ShellStack& stack = file.stack;
    // Four triangles are the least that a closed surface has.
    const std::size_t wanted = std::max<std::size_t>(most_prisms / stack.layers.size(), 4);
    if (stack.triangles().size() <= wanted)
        return numbered(stack, file.tets, file.core);
    const Coarsened coarse = coarsen({stack.surface(0), stack.triangles()}, wanted);
    const ShellStack few = picked(stack, coarse);
    // Tets of a core have corners among all of the shell's points, most of which are gone.
    PageShell shown = numbered(few, make_tets(few), {});
    shown.from = coarse.from;
    shown.all_vertices = stack.surface(0).size();
    return shown;
}

PageFrame page_frame(const PageShell& shown, const ShellFile& file)
{
    PageFrame frame;
    place_points(frame, shown, file);
    std::vector<double> thickness(shown.all_vertices);
    for (std::size_t v = 0; v < thickness.size(); ++v)
        thickness[v] = thickness_of(file.stack, v);
    frame.thickest = *std::max_element(thickness.begin(), thickness.end());
    for (std::size_t v = 0; v < shown.vertices(); ++v)
        frame.thickness.push_back(
            share(thickness[shown.coarser() ? shown.from[v] : v], 0, frame.thickest));
    frame.thickness_counts = counts_of_bins(thickness, frame.thickest, PageFrame::kThicknessBins);
    // Without a core the shell's own tets are taken as they are: a copy of all of them is not
    // small.
    const TetMesh joined = file.core.empty() ? TetMesh{} : joined_tets(file.tets, file.core);
    const TetMesh& tets = file.core.empty() ? file.tets : joined;
    const std::vector<double> degrees = least_degrees(tets);
    frame.angles = shown_angles(shown, file.tets, degrees);
    frame.angle_counts = counts_of_bins(degrees, PageFrame::kLargestDegrees, PageFrame::kAngleBins);
    return frame;
}

} // namespace vdb_shell
