// SPDX-License-Identifier: Apache-2.0
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

    const std::vector<EdgeUse> uses = sorted_edge_uses(shell.triangles);
    std::vector<char> open_triangle(shell.triangles.size());
    check_edges(split, pinned, uses, certificate, open_triangle);
    check_vertices(shell, uses, certificate);
    progress.stop_if_interrupted(40);

    const auto contacts = check_surfaces(shell, pinned, certificate);
    progress.stop_if_interrupted(90);

    check_regions(shell, component_of_triangles(uses, shell.triangles.size()), open_triangle,
                  contacts, certificate);
    return certificate;
}

} // namespace vdb_shell
