// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/certify/certificate.h"
#include "vdb_shell/certify/complex_certificate.h"
#include "vdb_shell/shell/shell_stack.h"

#include <optional>
#include <string>
#include <vector>

namespace vdb_shell
{

/// The certificate of a stack of layers: that of each layer, and of the whole against other
/// components. Layers of one component cannot overlap when each of them is certified: their numbers
/// of tets over a point, w_k - w_k+1 in the winding numbers of the surfaces, add up to w_0 - w_n,
/// which is at most 1 (docs/theory.md, "Layers, and shells scaled down"). A tapered stack is
/// certified as one complex of tets instead.
struct StackCertificate {
    /// From the outermost to the innermost; empty for a tapered stack.
    std::vector<Certificate> layers;
    std::optional<ComplexCertificate> complex; ///< of a tapered stack, and of no other
    /// Only asked where there are several layers and several components: triangles of the outermost
    /// surface, or of the innermost, of one component that touch either of another.
    Defect<TrianglePair> hull_contacts;
    /// As Certificate::nested_wrongly, of the outermost and the innermost surface.
    Defect<TrianglePair> hull_nested_wrongly;

    /// No failure at all: the tets of all layers together are a geometric simplicial complex.
    bool certified() const;
    /// Every layer is locally valid: see Certificate.
    bool locally_valid() const;
    /// The failures of each layer, then those of the whole. With several layers a layer's lines
    /// begin with "layer K: ", K from 0, the outermost.
    std::vector<std::string> failures() const;
};

/// As certify_shell; a stack of one layer gives that layer's certificate. `test` says nothing of a
/// tapered stack: its tets have to be positive, and no others.
/// Precondition: as certify_shell for each layer, and the layers fit together as ShellStack says.
StackCertificate certify_stack(const ShellStack& stack, PrismTest test,
                               Interrupter* interrupter = nullptr);

} // namespace vdb_shell
