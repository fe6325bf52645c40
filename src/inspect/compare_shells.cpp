// SPDX-License-Identifier: Apache-2.0

// Takes two shells, gives what each is and where they differ. Everything is measured on the shells
// themselves, so that a report from another version or machine cannot deceive. Points are compared
// by their numbers: two surfaces of other triangles have figures only.

#include "vdb_shell/inspect/compare_shells.h"

#include "vdb_shell/core/error.h"
#include "vdb_shell/shell/quality.h"

#include "options/parse_json.h"

#include <nlohmann/json.hpp>

#include <algorithm>

namespace vdb_shell
{
namespace
{

using nlohmann::json;
using openvdb::Vec3s;

/// World units of the files, in doubles: the two may have been read about different origins, and
/// their own coordinates cannot be compared then. Precondition: as many points.
PointChange change_of(const std::vector<Vec3s>& first, const Placement& first_placement,
                      const std::vector<Vec3s>& second, const Placement& second_placement)
{
    PointChange change;
    double sum = 0;
    for (std::size_t v = 0; v < first.size(); ++v) {
        const double distance =
            (second_placement.in_file(second[v]) - first_placement.in_file(first[v])).length();
        sum += distance;
        // The first of equal ones, so that the vertex that is named is the same each time.
        if (distance > change.largest) {
            change.largest = distance;
            change.at = v;
        }
    }
    change.mean = first.empty() ? 0.0 : sum / double(first.size());
    return change;
}

/// One entry for each option, by its path. An empty object is not flattened, for it would become a
/// null.
json flat_options(const std::string& text)
{
    const json options(parse_json(text, "parameters", "not JSON"));
    return options.empty() ? json::object() : options.flatten();
}

std::string text_of(const json& options, const std::string& key)
{
    return options.contains(key) ? options[key].dump(-1, ' ', false, json::error_handler_t::replace)
                                 : std::string();
}

std::vector<std::array<std::string, 3>> different_options(const std::string& first,
                                                          const std::string& second)
{
    const json a = flat_options(first), b = flat_options(second);
    // The keys of both, for an option may be missing in the file of another version.
    json all = a;
    all.update(b);
    std::vector<std::array<std::string, 3>> different;
    for (const auto& entry : all.items())
        if (text_of(a, entry.key()) != text_of(b, entry.key()))
            different.push_back({entry.key(), text_of(a, entry.key()), text_of(b, entry.key())});
    return different;
}

/// Bits of a shell are its coordinates about its origin: equal ones elsewhere are another shell.
bool same_placement(const Placement& a, const Placement& b)
{
    return a.origin == b.origin && a.unit == b.unit;
}

} // namespace

ShellFigures shell_figures(const ShellFile& file)
{
    const ShellStack& stack = file.stack;
    // Lengths and volumes are told in the file's unit, while points are in that of the mesh.
    const double unit = file.placement.unit, cubed = unit * unit * unit;
    ShellFigures figures;
    figures.vertices = stack.surface(0).size();
    figures.triangles = stack.triangles().size();
    figures.layers = stack.layers.size();
    figures.tets = file.tets.tets.size();
    figures.core_tets = file.core.tets.size();
    figures.tapered = stack.tapered;
    figures.posed = file.rest.posed();
    figures.checksum = checksum_of(stack, file.tets, file.core);
    figures.tets_per_triangle =
        double(figures.tets) / double(std::max<std::size_t>(1, figures.triangles));
    figures.solid_volume = cubed * signed_volume(stack.surface(stack.skin), stack.triangles());
    figures.shell_volume = cubed * tet_volume(file.tets);
    figures.fill = figures.solid_volume > 0 ? figures.shell_volume / figures.solid_volume : 0.0;
    double sum = 0;
    for (std::size_t v = 0; v < figures.vertices; ++v) {
        const double length = unit * double(thickness_of(stack, v));
        sum += length;
        figures.largest_thickness = std::max(figures.largest_thickness, length);
        figures.pinned += pinned_throughout(stack, v);
    }
    figures.mean_thickness = figures.vertices == 0 ? 0.0 : sum / double(figures.vertices);
    const QualityReport quality = measure_quality(file.tets);
    figures.least_dihedral_radians = quality.min_dihedral_radians.min;
    figures.sliver_share = double(quality.slivers) / double(std::max<std::size_t>(1, figures.tets));
    figures.median_amips = quality.amips.median;
    return figures;
}

ShellComparison compare_shells(const ShellFile& first, const ShellFile& second)
{
    ShellComparison comparison;
    comparison.first = shell_figures(first);
    comparison.second = shell_figures(second);
    comparison.options = different_options(first.parameters_json, second.parameters_json);
    comparison.same_bits = comparison.first.checksum == comparison.second.checksum &&
                           same_placement(first.placement, second.placement);
    const ShellStack &a = first.stack, &b = second.stack;
    comparison.same_triangles =
        a.triangles() == b.triangles() && a.surface(0).size() == b.surface(0).size();
    // By the numbers of their points: tets of other points are compared too, as poses have the same
    // ones.
    comparison.same_tets = first.tets.tets == second.tets.tets;
    if (!comparison.same_triangles)
        return comparison;
    comparison.outer = change_of(a.surface(0), first.placement, b.surface(0), second.placement);
    comparison.inner = change_of(a.surface(a.layers.size()), first.placement,
                                 b.surface(b.layers.size()), second.placement);
    return comparison;
}

} // namespace vdb_shell
