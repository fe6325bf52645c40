// SPDX-License-Identifier: Apache-2.0

// Takes: any shell with a split of its prisms. Gives: everything that stands against its being free
// of inverted and overlapping tets; an empty list is a proof, by docs/theory.md, "The whole shell".
// This file calls the tests of the single conditions in turn and does no geometry itself. It
// includes nothing of growth, so that a mistake there cannot hide here; and no test relies on
// another's having passed, because shells that fail are common input too and are to be described as
// fully as possible. Findings are listed in index order, whatever the number of threads. The idea
// of deciding by the degree of the map is that of Lipman, "Bijective Mappings of Meshes with
// Boundary and the Degree in Mesh Processing", 2014.

#include "vdb_shell/certify/certificate.h"

#include "certify/certificate_findings.h"
#include "certify/prism_checks.h"
#include "certify/regions.h"
#include "certify/surface_contacts.h"
#include "core/stage_progress.h"
#include "mesh/components.h"

#include <cassert>

namespace vdb_shell
{
bool Certificate::certified() const
{
    std::size_t failures = 0;
    for_each_kind(*this, [&](const char*, const auto& defect) { failures += defect.count; });
    return failures == 0;
}

bool Certificate::locally_valid() const
{
    // Contacts are left out on purpose: these five kinds speak of tets and their common faces, so
    // they can be empty on a surface that crosses itself. Orders that are no permutation count, for
    // nothing is known of the tets of such a prism.
    return bad_prisms.count + non_conforming_edges.count + cyclic_prisms.count + open_edges.count +
               split_vertices.count ==
           0;
}

std::vector<std::string> Certificate::failures() const
{
    std::vector<std::string> lines;
    for_each_kind(*this, [&](const char* name, const auto& defect) {
        if (defect.count > 0)
            lines.push_back(failure_line(name, defect));
    });
    return lines;
}

Certificate certify_shell(const PrismShell& shell, const PrismSplit& split, PrismTest test,
                          Interrupter* interrupter)
{
    assert(shell.inner.size() == shell.outer.size());
    assert(split.order.size() == shell.triangles.size());
    const StageProgress progress(interrupter, "certificate");
    Certificate certificate;
    certificate.test = test;
    const std::vector<char> pinned = pinned_flags(shell);
    check_prisms(shell, split, pinned, certificate);
    progress.stop_if_interrupted(20);

    // Sorted once for three tests: edges, fans of vertices and components all read the uses of an
    // edge one after the other.
    const EdgeUses uses = sorted_edge_uses(shell.triangles);
    std::vector<char> open_triangle(shell.triangles.size());
    check_edges(split, pinned, uses, certificate, open_triangle);
    check_vertices(shell, uses, certificate);
    progress.stop_if_interrupted(40);

    const auto contacts = check_surfaces(shell, pinned, certificate);
    progress.stop_if_interrupted(90);

    // Last, because it needs what the others found: a component with an open edge encloses nothing,
    // and components that touch are not on any side of each other.
    check_regions(shell, component_of_triangles(uses, shell.triangles.size()), open_triangle,
                  contacts, certificate);
    return certificate;
}

} // namespace vdb_shell
