// SPDX-License-Identifier: Apache-2.0

// Refuses a surface of which no shell can be made, in one message: how many of each defect, the
// first of them by index, and which option helps. The order of the findings is fixed, so that
// messages can be compared. Two kinds of defect can be accepted or mended by the check's own
// options (components that are inside out, and crossings); all the others need a repair first, and
// then only that is advised, because the option alone would lead to the next refusal.

#include "vdb_shell/core/error.h"

#include "vdb_shell/mesh/check_mesh.h"
#include "vdb_shell/options/option.h"

#include <string>

namespace vdb_shell
{
namespace
{

std::string shown(std::uint32_t index)
{
    return std::to_string(index);
}
std::string shown(const std::array<std::uint32_t, 2>& pair)
{
    return "(" + std::to_string(pair[0]) + ", " + std::to_string(pair[1]) + ")";
}

template <typename Element>
void add_finding(std::string& findings, const Defect<Element>& defect, const char* one,
                 const char* many)
{
    if (defect.count == 0)
        return;
    findings += (findings.empty() ? "" : "; ") + std::string(defect.at_least ? "at least " : "") +
                std::to_string(defect.count) + " " + (defect.count == 1 ? one : many) + ": ";
    for (std::size_t i = 0; i < defect.first.size(); ++i)
        findings += (i == 0 ? "" : ", ") + shown(defect.first[i]);
    if (defect.count > defect.first.size())
        findings += ", ...";
}

/// In the form of the other defects, so that the message names them alike.
/// The inside-out components by index.
Defect<std::uint32_t> inside_out(const MeshCheck& check)
{
    Defect<std::uint32_t> defect;
    for (std::uint32_t c = 0; c < check.components.size(); ++c) {
        if (!check.components[c].inside_out)
            continue;
        if (defect.count++ < Defect<std::uint32_t>::kFirstShown)
            defect.first.push_back(c);
    }
    return defect;
}

} // namespace

OptionList describe(CheckOptions& o)
{
    return in_group(
        "Surface",
        {option("allow_self_intersections", o.allow_self_intersections,
                "--allow-self-intersections",
                "Accept a surface that crosses itself, copy vertices of several fans, and certify "
                "prism by prism"),
         option("turn_inside_out", o.turn_inside_out, "--turn-outward",
                "Turn closed components that are inside out instead of refusing them")});
}

void require_usable(const MeshCheck& check, const CheckOptions& options, const std::string& name)
{
    std::string findings;
    if (check.triangles == 0)
        findings = "it has no triangles";
    add_finding(findings, check.boundary_edges, "boundary edge (the surface is open)",
                "boundary edges (the surface is open)");
    add_finding(findings, check.non_manifold_edges, "edge of three or more triangles",
                "edges of three or more triangles");
    add_finding(findings, check.inconsistent_edges,
                "edge between triangles of opposite orientation",
                "edges between triangles of opposite orientation");
    add_finding(findings, check.non_manifold_vertices, "vertex whose triangles do not form one fan",
                "vertices whose triangles do not form one fan");
    add_finding(findings, check.degenerate_triangles, "triangle of zero area",
                "triangles of zero area");
    add_finding(findings, check.duplicate_triangles, "triangle that repeats an earlier one",
                "triangles that repeat an earlier one");
    // Everything up to here is accepted by no option.
    const bool beyond_help = !findings.empty();
    std::string help;
    if (!options.turn_inside_out) {
        add_finding(findings, inside_out(check), "component is inside out",
                    "components are inside out");
        if (check.inside_out_components() > 0)
            help = "--turn-outward turns what is inside out";
    }
    if (!options.allow_self_intersections) {
        add_finding(findings, check.self_intersections, "pair of triangles that cross or touch",
                    "pairs of triangles that cross or touch");
        if (check.self_intersections.count > 0)
            help += (help.empty() ? "" : "; ") +
                    std::string(
                        "--wrap makes a new surface, --allow-self-intersections accepts one that "
                        "crosses itself");
    }
    if (findings.empty())
        return;
    if (beyond_help)
        help = "inspect names all of it, --repair mends most of it, --wrap makes a new surface";
    throw GeometryError(name + ": no shell can be made of this surface: " + findings +
                        (help.empty() ? "" : " - " + help));
}

} // namespace vdb_shell
