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

/// "3 boundary edges: (0, 1), (1, 2), (2, 0); 1 triangle of zero area: 5", or without the indices.
class Findings
{
public:
    explicit Findings(bool with_indices) : with_indices_(with_indices) {}

    void add(const std::string& finding) { text_ += (text_.empty() ? "" : "; ") + finding; }
    template <typename Element>
    void add(const Defect<Element>& defect, const char* one, const char* many)
    {
        if (defect.count == 0)
            return;
        add(std::string(defect.at_least ? "at least " : "") + std::to_string(defect.count) + " " +
            (defect.count == 1 ? one : many));
        if (!with_indices_)
            return;
        for (std::size_t i = 0; i < defect.first.size(); ++i)
            text_ += (i == 0 ? ": " : ", ") + shown(defect.first[i]);
        if (defect.count > defect.first.size())
            text_ += ", ...";
    }
    const std::string& text() const { return text_; }

private:
    bool with_indices_;
    std::string text_;
};

std::string findings_of(const MeshCheck& check, const CheckOptions& options, bool with_indices)
{
    Findings findings(with_indices);
    if (check.triangles == 0)
        findings.add("it has no triangles");
    findings.add(check.boundary_edges, "boundary edge (the surface is open)",
                 "boundary edges (the surface is open)");
    findings.add(check.non_manifold_edges, "edge of three or more triangles",
                 "edges of three or more triangles");
    findings.add(check.inconsistent_edges, "edge between triangles of opposite orientation",
                 "edges between triangles of opposite orientation");
    findings.add(check.non_manifold_vertices, "vertex whose triangles do not form one fan",
                 "vertices whose triangles do not form one fan");
    findings.add(check.degenerate_triangles, "triangle of zero area", "triangles of zero area");
    findings.add(check.duplicate_triangles, "triangle that repeats an earlier one",
                 "triangles that repeat an earlier one");
    if (!options.turn_inside_out)
        findings.add(check.components_that_are(&Component::inside_out), "component is inside out",
                     "components are inside out");
    findings.add(check.components_that_are(&Component::flat), "component encloses no volume",
                 "components enclose no volume");
    if (!options.allow_self_intersections)
        findings.add(check.self_intersections, "pair of triangles that cross or touch",
                     "pairs of triangles that cross or touch");
    return findings.text();
}

/// Precondition: the surface is not usable.
std::string advice(const MeshCheck& check, const CheckOptions& options)
{
    const CheckOptions all_accepted{true, true};
    if (!why_not_usable(check, all_accepted).empty())
        return "inspect names all of it, --mend does what is needed (--repair or --wrap)";
    std::string help;
    if (!options.turn_inside_out && check.inside_out_components() > 0)
        help = "--turn-outward turns what is inside out";
    if (!options.allow_self_intersections && check.self_intersections.count > 0)
        help += (help.empty() ? "" : "; ") +
                std::string("--mend cuts a few crossings out or makes a new surface (--wrap), "
                            "--allow-self-intersections accepts one that crosses itself");
    return help;
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

std::string why_not_usable(const MeshCheck& check, const CheckOptions& options)
{
    return findings_of(check, options, false);
}

void require_usable(const MeshCheck& check, const CheckOptions& options, const std::string& name)
{
    const std::string findings = findings_of(check, options, true);
    if (findings.empty())
        return;
    throw GeometryError(name + ": no shell can be made of this surface: " + findings + " - " +
                        advice(check, options));
}

} // namespace vdb_shell
