// SPDX-License-Identifier: Apache-2.0

// Takes what an inspection measured and says it as findings: what it is, how many, the first of
// them, whether it is in the way, and what mends it. It measures nothing itself. The rule is that
// `blocks` is meant for what makes `build` refuse the surface without any option, so that the
// verdict here is that of a build; what only makes the shell worse is a note. The order is fixed,
// connectivity before triangles before looks, as a fault in the former often explains those in the
// latter. The kinds are keys that programs read in the JSON and have a row each in
// docs/stages/repair.md.

#include "core/text_stream.h"

#include "vdb_shell/inspect/inspect_mesh.h"

#include <algorithm>

namespace vdb_shell
{
namespace
{

constexpr std::size_t kShown = Defect<std::uint32_t>::kFirstShown;
// A share of 2^-18 of the longest side is a step of 4 micrometres on a metre. With fewer binary
// digits the surface itself is visibly snapped to a lattice.
constexpr int kFewDigits = 18;

std::string shown(std::uint32_t index)
{
    return std::to_string(index);
}
std::string shown(const std::array<std::uint32_t, 2>& pair)
{
    return "(" + std::to_string(pair[0]) + ", " + std::to_string(pair[1]) + ")";
}
std::string shown(const BoundaryLoop& loop)
{
    OutText out;
    out.imbue(std::locale::classic());
    out << "at point " << loop.first_point << ": " << loop.edges << " edges, length " << loop.length
        << (loop.closed ? "" : ", not closed");
    return out.str();
}
std::string shown(const FlippedPatch& patch)
{
    return "at triangle " + std::to_string(patch.first_triangle) + ": " +
           std::to_string(patch.triangles) + (patch.triangles == 1 ? " triangle" : " triangles");
}

/// What all findings of one kind have in common; the rest of a finding is counted.
struct Kind {
    const char *kind, *text;
    bool blocks;
    const char* mend;
};

class Findings
{
public:
    template <typename Element> void add(const Kind& kind, const Defect<Element>& defect)
    {
        add(kind, defect.count, defect.first);
    }
    /// What was not found is not listed: no finding has the count 0. Of elements only the first few
    /// are told, because a bad mesh may have as many as it has triangles; the count is exact
    /// nevertheless.
    template <typename Element>
    void add(const Kind& kind, std::size_t count, const std::vector<Element>& elements)
    {
        if (count == 0)
            return;
        Finding finding{kind.kind, kind.text, count, {}, kind.blocks, kind.mend};
        for (std::size_t i = 0; i < std::min(elements.size(), kShown); ++i)
            finding.first.push_back(shown(elements[i]));
        list.push_back(std::move(finding));
    }
    std::vector<Finding> list;
};

/// Holes are told twice, as boundaries and, in the way check_mesh() counts them, as edges.
void add_connectivity(Findings& findings, const MeshInspection& inspection)
{
    const MeshCheck& check = inspection.check;
    findings.add({"boundary_loops", "holes: boundaries of the open surface", true,
                  "--repair closes them; --wrap where that crosses the surface"},
                 inspection.boundary_loops.size(), inspection.boundary_loops);
    findings.add({"boundary_edges", "edges of one triangle", true, "see the holes"},
                 check.boundary_edges);
    findings.add({"non_manifold_edges", "edges of three or more triangles", true,
                  "--repair parts the sheets that meet there"},
                 check.non_manifold_edges);
    findings.add({"non_manifold_vertices", "points whose triangles do not form one fan", true,
                  "--repair parts the fans"},
                 check.non_manifold_vertices);
    findings.add({"flipped_patches", "patches oriented against their neighbours", true,
                  "--repair turns them"},
                 inspection.flipped_patches.size(), inspection.flipped_patches);
    findings.add(
        {"one_sided_pieces",
         "pieces with one side only, as a Moebius strip or a Klein bottle (first triangle)", true,
         "--wrap makes a solid around them"},
        inspection.one_sided_pieces);
}

/// A component at an odd depth is a cavity and one at an even depth a body within it. Neither is a
/// fault, but a file that was not meant to have cavities is told of them here.
std::vector<std::uint32_t> nested(const MeshCheck& check)
{
    std::vector<std::uint32_t> found;
    for (std::uint32_t c = 0; c < check.components.size(); ++c)
        if (check.components[c].nesting_depth > 0)
            found.push_back(c);
    return found;
}

void add_triangles_and_components(Findings& findings, const MeshInspection& inspection)
{
    const MeshCheck& check = inspection.check;
    findings.add({"degenerate_triangles", "triangles of zero area", true, "--repair removes them"},
                 check.degenerate_triangles);
    findings.add({"duplicate_triangles", "triangles that repeat an earlier one", true,
                  "--repair removes them"},
                 check.duplicate_triangles);
    findings.add({"self_intersections",
                  check.self_intersections.at_least
                      ? "or more pairs of triangles that cross or touch"
                      : "pairs of triangles that cross or touch",
                  true,
                  "--repair --cut-crossings where few cross, else --wrap; "
                  "--allow-self-intersections for a shell that overlaps"},
                 check.self_intersections);
    // Components are numbered by their first triangles.
    findings.add({"inside_out_components", "components that are inside out", true,
                  "--turn-outward or --repair turns them"},
                 check.components_that_are(&Component::inside_out));
    findings.add({"flat_components", "closed components that enclose no volume", true,
                  "--wrap makes plates of them"},
                 check.components_that_are(&Component::flat));
    const std::vector<std::uint32_t> inner = nested(check);
    findings.add({"nested_components",
                  "components inside other ones: cavities, and islands in them", false,
                  "nothing to mend: an odd depth is taken as a cavity"},
                 inner.size(), inner);
}

/// Both of these are measured in doubles and are hints. They never block, for growth pins what it
/// has to and the certificate decides.
void add_looks(Findings& findings, const MeshInspection& inspection)
{
    findings.add({"blind_vertices", "points from which no direction sees all their triangles",
                  false,
                  "they are pinned: the shell has no thickness there; --wrap rounds them off"},
                 inspection.blind_vertices);
    findings.add({"thin_triangles", "triangles whose opposite side is nearer than a voxel", false,
                  "a larger --resolution or a smaller --voxel-size"},
                 inspection.thin_triangles);
}

void add_float_limits(Findings& findings, const MeshInspection& inspection)
{
    const FloatLimits& floats = inspection.floats;
    const auto add = [&](const char* kind, const std::string& text, bool blocks, const char* mend) {
        findings.list.push_back({kind, text, 1, {}, blocks, mend});
    };
    // Rounding to float32 moves a coordinate by about one part in 2^25, which any file suffers.
    // Only where the loss is seen beside the object itself does the file have more digits than
    // reading kept, and only then can reading about another origin bring them back.
    const bool reading_lost = floats.largest_rounding > floats.longest_side / (1 << kFewDigits);
    const char* const centre =
        reading_lost ? "--recentre keeps the digits that the file has"
                     : "move the object to the origin in the program that it comes from: the file "
                       "has no more digits";
    OutText text;
    text.imbue(std::locale::classic());
    text << "coordinates up to " << floats.farthest << " are " << floats.spacing
         << " apart in float32, " << floats.spacing / floats.longest_side << " of the longest side";
    if (floats.shortest_edge > 0)
        text << " and " << floats.spacing / floats.shortest_edge << " of the shortest edge";
    if (reading_lost)
        text << "; reading moved them by up to " << floats.largest_rounding;
    text << ": ";
    const std::string apart = text.str();
    if (floats.digits < kFewDigits)
        add("coarse_coordinates",
            apart + std::to_string(floats.digits) + " binary digits within the object, of 24",
            false, centre);
    // No voxel size could be derived from the mesh, so nothing can be said of voxels.
    if (inspection.voxel_size <= 0)
        return;
    if (floats.farthest / inspection.voxel_size > kLargestVoxelIndex)
        add("far_coordinates", apart + "too far from the origin for voxels of this size", true,
            "--recentre, or a larger --voxel-size");
    // The level set then has no voxel inside, and lines have nothing to step through.
    if (inspection.voxel_size > floats.longest_side)
        add("large_voxels", "a voxel is larger than the object", true,
            "a smaller --voxel-size, or --resolution");
    if (inspection.voxel_size < kSmallestVoxelSize)
        add("tiny_voxels", "voxels are smaller than OpenVDB's transforms can hold", true,
            "--rescale, or a larger --voxel-size");
}

} // namespace

std::vector<Finding> findings_of(const MeshInspection& inspection)
{
    Findings findings;
    // An empty surface has no other faults, and there is nothing that could be measured on it.
    if (inspection.check.triangles == 0) {
        findings.list.push_back({"no_triangles", "the surface has no triangles", 1, {}, true, ""});
        return findings.list;
    }
    add_connectivity(findings, inspection);
    add_triangles_and_components(findings, inspection);
    add_looks(findings, inspection);
    add_float_limits(findings, inspection);
    return findings.list;
}

bool usable(const MeshInspection& inspection)
{
    const std::vector<Finding> findings = findings_of(inspection);
    return std::none_of(findings.begin(), findings.end(),
                        [](const Finding& finding) { return finding.blocks; });
}

} // namespace vdb_shell
