// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/core/interrupter.h"
#include "vdb_shell/mesh/triangle_mesh.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace vdb_shell
{

/// Fewer triangles of roughly the same shape.
struct Coarsened {
    TriangleMesh mesh;
    std::vector<std::uint32_t> from; ///< for each point, which of the input's it is, ascending
    /// By coarsen: no triangles touch but in what they share, and no component has turned inside
    /// out.
    bool embedded = false;
};

/// Edge collapses of least quadric error (Garland, Heckbert 1997, "Surface simplification using
/// quadric error metrics") onto one of the edge's own ends, in rounds of many that do not touch
/// each other, until `triangles` are left or no collapse is left that turns no normal far and makes
/// no sliver. Nothing bounds the distance. Closed and manifold like the input. Where it would cross
/// itself the vertices around are kept and all is done anew, three times at most. If more than
/// twice as many triangles as wanted are left then, as of a thin wall, the first result is given
/// back as it is. `embedded` says what became of it. For those who only want a hint, soon. Same
/// result for any number of threads. Precondition: closed, manifold. Throws Cancelled.
Coarsened coarsen(const TriangleMesh& mesh, std::size_t triangles,
                  Interrupter* interrupter = nullptr);

} // namespace vdb_shell
