// SPDX-License-Identifier: Apache-2.0

// Takes a valid state in which some vertices are pinned that must not be. Leaves fewer of them.
// Attempts reach farther around each, and the last one asks for the twelve tets of each prism: then
// pillars along directions that see their triangles are valid if only they are short enough.

#include "pose/release_lost.h"

#include "growth/initialise.h"
#include "growth/mend_prolonged.h"
#include "growth/move_tests.h"
#include "growth/pins.h"
#include "growth/trust_radius.h"
#include "vdb_shell/growth/grow.h"
#include "vdb_shell/mesh/normals.h"

#include <algorithm>
#include <array>
#include <optional>

namespace vdb_shell
{
namespace
{

using growth::Connectivity;
using growth::GrowState;

/// So far around lost pillars others begin again, in edges, from attempt to attempt; and how long,
/// in edges of the skin.
constexpr std::array<int, 3> kRings{1, 4, 16};
constexpr double kRestartShare = 0.2;

/// Vertices that are pinned and must not be: their cap allows a pillar.
std::vector<std::uint8_t> lost_vertices(const GrowState& s)
{
    std::vector<std::uint8_t> lost(s.b.size());
    for (std::size_t v = 0; v < lost.size(); ++v)
        lost[v] = s.pinned[v] && s.cap[v] > 0;
    return lost;
}

void add_neighbours(const Connectivity& mesh, int rings, std::vector<std::uint8_t>& marked)
{
    for (int ring = 0; ring < rings; ++ring) {
        const std::vector<std::uint8_t> before = marked;
        for (int v = 0; v < mesh.vertices; ++v)
            for (const int u : growth::neighbours(mesh, v))
                marked[v] |= before[u];
    }
}

} // namespace

void release_lost(GrowState& s, const TriangleMesh& mesh, const StageProgress& progress)
{
    std::optional<Directions> seeing;
    for (const int rings : kRings) {
        // Whether a direction sees its triangles is for the tests to find out.
        growth::release_pins(s, std::vector<double>(s.b.size(), 1.0),
                             growth::PillarsBesidePin::shortened);
        std::vector<std::uint8_t> around = lost_vertices(s);
        if (std::find(around.begin(), around.end(), 1) == around.end())
            return;
        if (!seeing)
            seeing = growth::prepare_directions(mesh, directions_along(mesh, pseudo_normals(mesh)),
                                                {}, false);
        add_neighbours(*s.mesh, rings, around);
        for (int v = 0; v < s.mesh->vertices; ++v) {
            if (!around[v] || !(s.cap[v] > 0) || !(seeing->visibility[std::size_t(v)] > 0))
                continue;
            const double length = kRestartShare * growth::mean_edge(*s.mesh, s.a, v);
            s.b[v] = growth::end_within_cap(s, v, seeing->inward[std::size_t(v)], length);
            s.pinned[v] = s.b[v] == s.a[v];
        }
        s.twelve = s.twelve || rings == kRings.back();
        growth::mend_placed(s, progress);
    }
    growth::release_pins(s, std::vector<double>(s.b.size(), 1.0),
                         growth::PillarsBesidePin::shortened);
}

} // namespace vdb_shell
