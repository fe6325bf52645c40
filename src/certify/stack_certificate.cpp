// SPDX-License-Identifier: Apache-2.0

// Takes: a stack of layers. Gives: the certificate of each layer, and whether different components
// as wholes keep clear of each other; of a tapered stack, the certificate of its tets as a whole.
// Nothing more is needed for one component: its layers cannot
// overlap when each of them is certified (docs/theory.md, "Layers do not overlap one another"). Two
// components do need more, because a layer of one is held against the same layer of the other only
// (docs/theory.md, "Several components").

#include "vdb_shell/certify/stack_certificate.h"

#include "certify/certificate_findings.h"
#include "certify/prism_checks.h"
#include "certify/regions.h"
#include "certify/surface_contacts.h"
#include "mesh/components.h"

#include <algorithm>
#include <cassert>

namespace vdb_shell
{
namespace
{

bool of_one_component(const std::vector<std::uint32_t>& component_of)
{
    return std::all_of(component_of.begin(), component_of.end(),
                       [&](std::uint32_t c) { return c == component_of.front(); });
}

/// Whether different components keep clear of each other as wholes. Contacts within one component
/// are not taken over: the certificates of its layers speak of those.
void check_hull(const ShellStack& stack, StackCertificate& certificate)
{
    const PrismShell hull = hull_of(stack);
    const EdgeUses uses = sorted_edge_uses(hull.triangles);
    const auto component_of = component_of_triangles(uses, hull.triangles.size());
    if (of_one_component(component_of))
        return;
    const std::vector<char> pinned = pinned_flags(hull);
    Certificate found;
    std::vector<char> open_triangle(hull.triangles.size());
    // Called for the open triangles. What it says of diagonals means nothing here, as no tet runs
    // through all layers; it goes into `found` and is dropped.
    check_edges(stack.splits.front(), pinned, uses, found, open_triangle);
    const auto contacts = check_surfaces(hull, pinned, found);
    for (const TrianglePair& pair : contacts)
        if (component_of[pair[0]] != component_of[pair[1]])
            add_to(certificate.hull_contacts, pair);
    check_regions(hull, component_of, open_triangle, contacts, found);
    certificate.hull_nested_wrongly = found.nested_wrongly;
}

void append_failures(std::vector<std::string>& lines, const char* name,
                     const Defect<TrianglePair>& defect)
{
    if (defect.count > 0)
        lines.push_back(failure_line(name, defect));
}

} // namespace

bool StackCertificate::certified() const
{
    return hull_contacts.count + hull_nested_wrongly.count == 0 &&
           (!complex || complex->certified()) &&
           std::all_of(layers.begin(), layers.end(),
                       [](const Certificate& layer) { return layer.certified(); });
}

bool StackCertificate::locally_valid() const
{
    return (!complex || complex->locally_valid()) &&
           std::all_of(layers.begin(), layers.end(),
                       [](const Certificate& layer) { return layer.locally_valid(); });
}

std::vector<std::string> StackCertificate::failures() const
{
    std::vector<std::string> lines;
    if (complex)
        lines = complex->failures();
    for (std::size_t k = 0; k < layers.size(); ++k) {
        const std::string where =
            layers.size() > 1 ? "layer " + std::to_string(k) + ": " : std::string();
        for (const std::string& failure : layers[k].failures())
            lines.push_back(where + failure);
    }
    append_failures(lines, "hull_contacts", hull_contacts);
    append_failures(lines, "hull_nested_wrongly", hull_nested_wrongly);
    return lines;
}

StackCertificate certify_stack(const ShellStack& stack, PrismTest test, Interrupter* interrupter)
{
    assert(!stack.layers.empty() && stack.splits.size() == stack.layers.size());
    StackCertificate certificate;
    if (stack.tapered) {
        certificate.complex = certify_complex(stack, interrupter);
        return certificate;
    }
    for (std::size_t k = 0; k < stack.layers.size(); ++k)
        certificate.layers.push_back(
            certify_shell(stack.layers[k], stack.splits[k], test, interrupter));
    if (stack.layers.size() > 1)
        check_hull(stack, certificate);
    return certificate;
}

} // namespace vdb_shell
