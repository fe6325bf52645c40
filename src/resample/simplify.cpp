// SPDX-License-Identifier: Apache-2.0
#include "resample/simplify.h"

#include "core/box_pairs.h"
#include "core/parallel.h"
#include "core/stage_progress.h"
#include "resample/spoiled_triangles.h"
#include "vdb_shell/mesh/check_mesh.h"

#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <OpenMesh/Tools/Decimater/DecimaterT.hh>
#include <OpenMesh/Tools/Decimater/ModAspectRatioT.hh>
#include <OpenMesh/Tools/Decimater/ModEdgeLengthT.hh>
#include <OpenMesh/Tools/Decimater/ModHausdorffT.hh>
#include <OpenMesh/Tools/Decimater/ModNormalFlippingT.hh>
#include <OpenMesh/Tools/Decimater/ModQuadricT.hh>

#include <algorithm>

namespace vdb_shell
{
namespace
{

using openvdb::Vec3d;
using openvdb::Vec3s;

struct DoubleTraits : OpenMesh::DefaultTraits {
    using Point = OpenMesh::Vec3d;
    using Normal = OpenMesh::Vec3d;
};
using HalfedgeMesh = OpenMesh::TriMesh_ArrayKernelT<DoubleTraits>;
using Decimater = OpenMesh::Decimater::DecimaterT<HalfedgeMesh>;

constexpr int kMaxRepeats = 12;
// A face may turn by this much in one collapse; more is a fold in the making.
constexpr double kLargestTurnDegrees = 40.0;
// No collapse may make a triangle narrower than that, unless it was narrower before.
constexpr float kWorstAspect = 8.0F;

HalfedgeMesh to_halfedges(const TriangleMesh& mesh, const std::vector<char>& held, double scale)
{
    HalfedgeMesh out;
    out.request_vertex_status();
    out.request_edge_status();
    out.request_halfedge_status();
    out.request_face_status();
    out.request_face_normals();
    const Vec3d centre = mesh.points.empty() ? Vec3d(0.0) : Vec3d(mesh.points.front());
    std::vector<HalfedgeMesh::VertexHandle> handles;
    handles.reserve(mesh.points.size());
    for (std::size_t v = 0; v < mesh.points.size(); ++v) {
        const Vec3d p = (Vec3d(mesh.points[v]) - centre) / scale;
        handles.push_back(out.add_vertex({p[0], p[1], p[2]}));
        out.status(handles.back()).set_locked(held[v] != 0);
    }
    for (const openvdb::Vec3I& t : mesh.triangles)
        out.add_face(handles[t[0]], handles[t[1]], handles[t[2]]);
    out.update_face_normals();
    return out;
}

/// Of a mesh in units of the tolerance.
void collapse_edges(HalfedgeMesh& mesh, const SimplifyLimits& limits)
{
    Decimater decimater(mesh);
    OpenMesh::Decimater::ModQuadricT<HalfedgeMesh>::Handle quadric;
    OpenMesh::Decimater::ModHausdorffT<HalfedgeMesh>::Handle distance;
    OpenMesh::Decimater::ModNormalFlippingT<HalfedgeMesh>::Handle turn;
    OpenMesh::Decimater::ModAspectRatioT<HalfedgeMesh>::Handle aspect;
    decimater.add(quadric);
    decimater.add(distance);
    decimater.add(turn);
    decimater.add(aspect);
    OpenMesh::Decimater::ModEdgeLengthT<HalfedgeMesh>::Handle length;
    decimater.add(length);
    decimater.module(length).set_edge_length(limits.longest_edge / limits.tolerance);
    decimater.module(length).set_binary(true);
    // A sum over all planes that a vertex stands for: far stricter than the distance.
    if (limits.bound_quadric)
        decimater.module(quadric).set_max_err(1.0, false);
    else
        decimater.module(quadric).unset_max_err();
    decimater.module(quadric).set_binary(false);
    decimater.module(distance).set_tolerance(1.0);
    decimater.module(turn).set_max_normal_deviation(kLargestTurnDegrees);
    decimater.module(aspect).set_aspect_ratio(kWorstAspect);
    decimater.module(aspect).set_binary(true);
    decimater.initialize();
    decimater.decimate_to_faces(0, limits.fewest_triangles);
}

/// The faces and points that are left, with the points' own float32 coordinates.
TriangleMesh what_is_left(const HalfedgeMesh& mesh, const TriangleMesh& original)
{
    TriangleMesh out;
    std::vector<std::uint32_t> place(original.points.size());
    for (std::size_t v = 0; v < place.size(); ++v) {
        const auto handle = HalfedgeMesh::VertexHandle(static_cast<int>(v));
        if (mesh.status(handle).deleted() || mesh.is_isolated(handle))
            continue;
        place[v] = static_cast<std::uint32_t>(out.points.size());
        out.points.push_back(original.points[v]);
    }
    for (const auto face : mesh.faces()) {
        openvdb::Vec3I corners;
        int k = 0;
        for (const auto vertex : mesh.fv_range(face))
            corners[k++] = place[static_cast<std::size_t>(vertex.idx())];
        out.triangles.push_back(corners);
    }
    return out;
}

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
    std::vector<char> held(mesh.points.size());
    const double tolerance = limits.tolerance;
    if (!(tolerance > 0.0))
        return {mesh, 0};
    for (int repeat = 0; repeat <= kMaxRepeats; ++repeat) {
        progress.stop_if_interrupted(100 * repeat / (kMaxRepeats + 1));
        // In units of the tolerance the decimater's own small constants are small.
        HalfedgeMesh halfedges = to_halfedges(mesh, held, tolerance);
        collapse_edges(halfedges, limits);
        TriangleMesh left = what_is_left(halfedges, mesh);
        const std::vector<FloatBox> places = spoiled_places(left);
        if (places.empty())
            return is_sound(left) ? Simplified{std::move(left), repeat} : Simplified{mesh, repeat};
        // Wider each time, so that holding cannot stall.
        hold_points_near(places, static_cast<float>(2.0 * repeat * tolerance), mesh, held);
    }
    return {mesh, kMaxRepeats};
}

} // namespace vdb_shell
