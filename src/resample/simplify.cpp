// SPDX-License-Identifier: Apache-2.0
#include "resample/simplify.h"

#include "core/box_pairs.h"
#include "core/parallel.h"
#include "core/stage_progress.h"
#include "resample/edge_collapse.h"
#include "resample/spoiled_triangles.h"
#include "vdb_shell/mesh/check_mesh.h"

#include <cmath>

namespace vdb_shell
{
namespace
{

using openvdb::Vec3s;

constexpr int kMaxRepeats = 12;

/// Boxes around all triangles that spoil the surface; empty when it is sound.
std::vector<FloatBox> spoiled_places(const TriangleMesh& mesh)
{
    const std::vector<FloatBox> boxes = triangle_boxes(mesh.points, mesh.triangles);
    const std::vector<char> bad = spoiled_triangles(mesh);
    std::vector<FloatBox> places;
    for (std::size_t t = 0; t < bad.size(); ++t)
        if (bad[t])
            places.push_back(boxes[t]);
    return places;
}

void hold_points_near(const std::vector<FloatBox>& places, float margin, const TriangleMesh& mesh,
                      std::vector<char>& held)
{
    for_each_index(mesh.points.size(), [&](std::size_t v) {
        const Vec3s& p = mesh.points[v];
        for (const FloatBox& box : places) {
            bool in = true;
            for (int axis = 0; axis < 3; ++axis)
                in &= p[axis] >= box.lo[axis] - margin && p[axis] <= box.hi[axis] + margin;
            if (in) {
                held[v] = 1;
                return;
            }
        }
    });
}

bool is_sound(const TriangleMesh& mesh)
{
    const MeshCheck check = check_mesh(mesh);
    return check.closed() && check.manifold() && check.embedded() &&
           check.inconsistent_edges.count == 0 && check.degenerate_triangles.count == 0 &&
           check.duplicate_triangles.count == 0;
}

} // namespace

Simplified simplify(const TriangleMesh& mesh, const SimplifyLimits& limits,
                    Interrupter* interrupter)
{
    const StageProgress progress(interrupter, "simplify");
    const double tolerance = limits.tolerance;
    if (!(tolerance > 0.0))
        return {mesh, 0};
    CollapseLimits collapse{limits.fewest_triangles, tolerance, limits.longest_edge,
                            limits.bound_quadric ? std::pow(tolerance, 4) : CollapseLimits::kNone,
                            std::vector<char>(mesh.points.size())};
    for (int repeat = 0; repeat <= kMaxRepeats; ++repeat) {
        progress.stop_if_interrupted(100 * repeat / (kMaxRepeats + 1));
        TriangleMesh left = collapse_edges(mesh, collapse).mesh;
        const std::vector<FloatBox> places = spoiled_places(left);
        if (places.empty())
            return is_sound(left) ? Simplified{std::move(left), repeat} : Simplified{mesh, repeat};
        // Wider each time, so that holding cannot stall.
        hold_points_near(places, static_cast<float>(2.0 * repeat * tolerance), mesh,
                         collapse.fixed);
    }
    return {mesh, kMaxRepeats};
}

} // namespace vdb_shell
