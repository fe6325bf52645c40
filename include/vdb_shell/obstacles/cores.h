// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/core/interrupter.h"
#include "vdb_shell/mesh/triangle_mesh.h"
#include "vdb_shell/options/describe.h"

#include <cstddef>
#include <string>
#include <vector>

namespace vdb_shell
{

/// A closed surface inside the one that gets a shell, as the bones inside a skin. The shell ends on
/// or before it.
struct CoreMesh {
    std::string name; ///< of its file, for messages and the report
    TriangleMesh mesh;
};

struct CoreOptions {
    /// The shell stays at least so far from all cores, in world units.
    double distance = 0;
    /// A pillar ended at a core if what is left of its way to it, or to the surface at `distance`
    /// around it, is at most this share of the pillar's length.
    double reach = 0.2;
};
OptionList describe(CoreOptions& options);

/// The cores of one run.
struct Cores {
    std::vector<CoreMesh> given;
    /// What the shell must not meet, oriented outward: the triangles of all cores, or with a
    /// distance the surface around them.
    TriangleMesh kept_out;
};

/// Looks at the cores and makes what the shell is kept out of. Every point outside of `kept_out` is
/// at least `distance` from all cores (docs/theory.md, "Cores").
/// Throws GeometryError that names core and triangles, by their indices, for a core that is open,
/// not manifold, crosses itself, is inside out or has a part inside another part; that crosses or
/// touches the surface or another core; that is not inside the surface, or inside another core; and
/// where the surface comes nearer to a core than `distance`. Throws InvalidOption for options out
/// of their range and a distance that rounding would lose; Cancelled. Same result for any number of
/// threads. Precondition: the surface is closed, manifold and embedded, and oriented outward; there
/// is a core. `name` is that of the surface.
Cores prepare_cores(const TriangleMesh& surface, const std::string& name,
                    std::vector<CoreMesh> cores, const CoreOptions& options,
                    Interrupter* interrupter = nullptr);

/// The triangles of all cores as one mesh, in the order of the cores.
TriangleMesh joined_cores(const std::vector<CoreMesh>& cores);

} // namespace vdb_shell
