// SPDX-License-Identifier: Apache-2.0
#include "write/hand_made.h"

#include "support/grids.h"

#include <algorithm>
#include <cstring>

namespace vdb_shell::test
{
namespace
{

using openvdb::Vec3d;
using openvdb::Vec3s;

void add_prism(TetMesh& tets, const std::vector<std::uint32_t>& below, const PrismShell& shell,
               const PrismSplit& split, std::uint32_t prism)
{
    std::array<std::uint32_t, 3> a{}, b{};
    for (std::size_t i = 0; i < 3; ++i) {
        a[i] = shell.triangles[prism][split.order[prism][i]];
        b[i] = below[a[i]];
    }
    const std::array<openvdb::Vec4I, 3> cut{openvdb::Vec4I(a[0], a[1], a[2], b[2]),
                                            openvdb::Vec4I(a[0], a[1], b[1], b[2]),
                                            openvdb::Vec4I(a[0], b[0], b[1], b[2])};
    for (openvdb::Vec4I tet : cut) {
        bool collapsed = false;
        for (int i = 0; i < 4; ++i)
            for (int j = 0; j < i; ++j)
                collapsed = collapsed || tet[i] == tet[j];
        if (collapsed)
            continue;
        const Vec3d p(tets.points[tet[0]]), q(tets.points[tet[1]]), r(tets.points[tet[2]]),
            s(tets.points[tet[3]]);
        if ((q - p).cross(r - p).dot(s - p) < 0)
            std::swap(tet[2], tet[3]);
        tets.tets.push_back(tet);
        tets.prism.push_back(prism);
        tets.prism_layer.push_back(0);
    }
}

} // namespace

HandMade hand_made_shell(const TriangleMesh& surface, double scale,
                         const std::set<std::uint32_t>& pinned)
{
    HandMade made;
    made.shell.outer = surface.points;
    made.shell.triangles = surface.triangles;
    const Bounds bounds = bounds_of(surface.points);
    const Vec3d centre = 0.5 * (bounds.low + bounds.high);
    std::vector<std::uint32_t> below;
    TetMesh& tets = made.tets;
    tets.points = surface.points;
    for (std::uint32_t v = 0; v < surface.points.size(); ++v) {
        tets.source_vertex.push_back(v);
        tets.layer.push_back(0);
        made.shell.stop.push_back(StopReason(v % kStopReasonCount));
        made.shell.inner.push_back(
            pinned.count(v) ? surface.points[v]
                            : Vec3s(centre + scale * (Vec3d(surface.points[v]) - centre)));
    }
    for (std::uint32_t v = 0; v < surface.points.size(); ++v) {
        below.push_back(made.shell.pinned(v) ? v : std::uint32_t(tets.points.size()));
        if (made.shell.pinned(v))
            continue;
        tets.points.push_back(made.shell.inner[v]);
        tets.source_vertex.push_back(v);
        tets.layer.push_back(1);
    }
    for (std::uint32_t p = 0; p < surface.triangles.size(); ++p) {
        std::array<std::uint8_t, 3> order{0, 1, 2};
        std::sort(order.begin(), order.end(), [&](std::uint8_t i, std::uint8_t j) {
            return surface.triangles[p][i] < surface.triangles[p][j];
        });
        made.split.order.push_back(order);
        add_prism(tets, below, made.shell, made.split, p);
    }
    return made;
}

ShellFile hand_made_file(const HandMade& made, double voxel_size)
{
    openvdb::initialize();
    ShellFile file;
    file.surface = test::sphere_level_set(1.0f, float(voxel_size));
    file.depth = shell_depth_grid(made.tets, voxel_size);
    file.stack = one_layer(made.shell, made.split);
    file.tets = made.tets;
    file.parameters_json = "{\"rho\": 0.9}";
    file.report_json = "{\n  \"fill\": 0.5\n}";
    return file;
}

bool same_grid(const openvdb::FloatGrid& a, const openvdb::FloatGrid& b)
{
    if (a.tree().leafCount() != b.tree().leafCount() ||
        a.activeVoxelCount() != b.activeVoxelCount() || a.background() != b.background() ||
        a.transform() != b.transform() || !a.tree().hasSameTopology(b.tree()))
        return false;
    for (auto leaf = a.tree().cbeginLeaf(); leaf; ++leaf) {
        const auto* other = b.tree().probeConstLeaf(leaf->origin());
        if (!other || leaf->valueMask() != other->valueMask() ||
            std::memcmp(leaf->buffer().data(), other->buffer().data(),
                        leaf->size() * sizeof(float)) != 0)
            return false;
    }
    return true;
}

} // namespace vdb_shell::test
