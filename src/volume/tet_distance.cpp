// SPDX-License-Identifier: Apache-2.0

// Based on: K. Erleben and H. Dohlmann, "Signed Distance Fields Using Single-Pass GPU Scan
// Conversion of Tetrahedra", GPU Gems 3, chapter 34, 2008 ([7] of the paper). There, tets around
// each triangle are scanned and the least distance stays; here the tets are those of a shell, so
// each voxel lies in one, which gives the sign without pseudo-normals. The nearest point can belong
// to another prism, for prisms are slanted and as deep as there is room. So the triangle of the
// prism is a bound, and what is nearer is looked for within it, leaf by leaf
// (nearest_in_leaf.cpp). Each leaf is filled by itself, so the bits are the same for any number of
// threads.

#include "vdb_shell/volume/tet_distance.h"

#include "core/grid_instances.h"
#include "core/parallel.h"
#include "core/sort_unique.h"
#include "vdb_shell/core/error.h"
#include "vdb_shell/shell/core_tets.h"
#include "volume/nearest_in_leaf.h"
#include "volume/tet_index_grid.h"

#include <cassert>
#include <memory>
#include <string>
#include <vector>

namespace vdb_shell
{
namespace
{

using openvdb::Coord;
using openvdb::Vec3d;
using IndexLeaf = openvdb::Int32Tree::LeafNodeType;
using FloatLeaf = openvdb::FloatTree::LeafNodeType;

/// Where tets were in the last pose, and what was nearest there.
struct Previous {
    const TetMesh& tets;
    const openvdb::Int32Grid& nearest;
};

std::array<Vec3d, 4> corners_of(const TetMesh& mesh, std::size_t tet)
{
    std::array<Vec3d, 4> corner;
    for (int i = 0; i < 4; ++i)
        corner[std::size_t(i)] = Vec3d(mesh.points[mesh.tets[tet][i]]);
    return corner;
}

/// The place in the first tet, carried into the second.
Vec3d carried(const std::array<Vec3d, 4>& from, const std::array<Vec3d, 4>& to, const Vec3d& place)
{
    const Vec3d b = from[1] - from[0], c = from[2] - from[0], d = from[3] - from[0];
    const Vec3d p = place - from[0];
    // Cramer's rule. Tets without volume hold no voxel.
    const double whole = b.dot(c.cross(d));
    return to[0] + (p.dot(c.cross(d)) * (to[1] - to[0]) + p.dot(d.cross(b)) * (to[2] - to[0]) +
                    p.dot(b.cross(c)) * (to[3] - to[0])) /
                       whole;
}

/// Scans leaves; one for each thread.
class LeafScan
{
public:
    LeafScan(const ShellStack& stack, const TetMesh& tets, const DistanceSurface& surface,
             TetDistanceMethod method, const Previous* previous)
        : stack_(stack), tets_(tets), surface_(surface), method_(method), search_(surface)
    {
        if (previous) {
            previous_ = previous;
            accessor_ = std::make_unique<openvdb::Int32Grid::ConstAccessor>(
                previous->nearest.getConstAccessor());
        }
    }

    /// `index` holds tets and gets triangles; `distance` has the same active voxels.
    void fill(IndexLeaf& index, FloatLeaf& distance)
    {
        const Coord origin = index.origin();
        find_candidates(index);
        if (method_ == TetDistanceMethod::own_prism)
            take_candidates(index);
        // A leaf that only tets of a core meet has no candidate, so there near_prisms has to look
        // like exact.
        else if (list_.empty() || method_ == TetDistanceMethod::exact) {
            search_.list_nearest(origin, mask_, list_, near_);
            search_.nearest_of_list(origin, mask_, near_, found_);
        } else {
            search_.nearest_of_list(origin, mask_, list_, found_);
        }
        for (auto voxel = index.beginValueOn(); voxel; ++voxel) {
            const openvdb::Index at = voxel.pos();
            const auto tet = static_cast<std::uint32_t>(*voxel);
            const auto d = float(found_.distance[at]);
            // Cores have the largest number, so they are below any skin.
            distance.setValueOnly(at, d == 0 || tets_.prism_layer[tet] < stack_.skin ? d : -d);
            index.setValueOnly(at, std::int32_t(found_.triangle[at]));
        }
    }

private:
    static constexpr std::uint32_t kNone = ~0U;

    void find_candidates(const IndexLeaf& index)
    {
        list_.clear();
        mask_.fill(0);
        for (auto voxel = index.cbeginValueOn(); voxel; ++voxel) {
            const openvdb::Index at = voxel.pos();
            // OpenVDB numbers the voxels of a leaf with x slowest: 64 to one x, a word of the mask.
            mask_[at >> 6] |= std::uint64_t(1) << (at & 63U);
            const std::uint32_t triangle = candidate_of(voxel.getCoord(), std::size_t(*voxel));
            found_.triangle[at] = triangle;
            // Neighbours mostly have the same.
            if (triangle != kNone && (list_.empty() || list_.back() != triangle))
                list_.push_back(triangle);
        }
        sort_unique(list_);
    }

    std::uint32_t candidate_of(const Coord& voxel, std::size_t tet)
    {
        if (previous_) {
            const Vec3d place = carried(corners_of(tets_, tet), corners_of(previous_->tets, tet),
                                        surface_.voxel_size() * voxel.asVec3d());
            const Vec3d before = previous_->nearest.worldToIndex(place);
            std::int32_t triangle = 0;
            // Next to a face the nearest voxel centre may lie in no tet. Only the numbers of active
            // voxels have been looked at (next_tet_distances).
            if (accessor_->probeValue(Coord::round(before), triangle))
                return std::uint32_t(triangle);
        }
        return tets_.prism[tet] == kCorePrism ? kNone : tets_.prism[tet];
    }

    void take_candidates(const IndexLeaf& index)
    {
        for (auto voxel = index.cbeginValueOn(); voxel; ++voxel) {
            std::uint32_t& triangle = found_.triangle[voxel.pos()];
            // A tet of a core has no prism: any triangle bounds the distance, one near the leaf
            // bounds it well.
            if (triangle == kNone)
                triangle = nearest_to_leaf(index.origin());
            found_.distance[voxel.pos()] = surface_.distance(voxel.getCoord(), triangle);
        }
    }

    /// The triangle nearest to the leaf's middle. Found anew from the root, for which of equally
    /// near ones is found depends on where the search begins.
    std::uint32_t nearest_to_leaf(const Coord& origin) const
    {
        TriangleTree::Seed seed = TriangleTree::kNoSeed;
        return surface_.tree()
            .nearest(surface_.voxel_size() * (origin.asVec3d() + Vec3d(3.5)), 0.0F, seed)
            .triangle;
    }

    const ShellStack& stack_;
    const TetMesh& tets_;
    const DistanceSurface& surface_;
    TetDistanceMethod method_;
    NearestInLeaf search_;
    const Previous* previous_ = nullptr;
    std::unique_ptr<openvdb::Int32Grid::ConstAccessor> accessor_;
    NearestInLeaf::Mask mask_{};
    NearestInLeaf::List list_, near_;
    NearestInLeaf::Voxels found_{};
};

TetDistances scan(const ShellStack& stack, const TetMesh& tets, const TetDistanceOptions& options,
                  const Previous* previous, Interrupter* interrupter)
{
    assert(tets.prism.size() == tets.tets.size() && tets.prism_layer.size() == tets.tets.size());
    const StageProgress progress(interrupter, "distance by tets");
    const auto nearest = tet_index_grid(tets, options.voxel_size, "distance by tets", progress);
    nearest->setName("nearest_triangle");
    // The topology is copied once and values are written into it, so both grids have the same
    // leaves in the same order, and `from` and `to` go together.
    auto distance = openvdb::FloatGrid::create(
        std::make_shared<openvdb::FloatTree>(nearest->tree(), 0.0f, 0.0f, openvdb::TopologyCopy()));
    distance->setTransform(nearest->transform().copy());
    distance->setName("distance");
    std::vector<IndexLeaf*> from;
    std::vector<FloatLeaf*> to;
    nearest->tree().getNodes(from);
    distance->tree().getNodes(to);
    if (from.empty())
        return {distance, nearest};
    const TriangleMesh mesh = skin_surface(stack);
    const DistanceSurface surface(mesh, options.voxel_size);
    // Batches, so that the user can stop in between.
    constexpr std::size_t kBatches = 20;
    for (std::size_t batch = 0; batch < kBatches; ++batch) {
        progress.stop_if_interrupted(int(100 * batch / kBatches));
        const std::size_t begin = from.size() * batch / kBatches;
        const std::size_t end = from.size() * (batch + 1) / kBatches;
        for_each_range(
            end - begin,
            [&](std::size_t first, std::size_t last) {
                const auto leaves =
                    std::make_unique<LeafScan>(stack, tets, surface, options.method, previous);
                for (std::size_t i = begin + first; i < begin + last; ++i)
                    leaves->fill(*from[i], *to[i]);
            },
            16);
    }
    return {distance, nearest};
}

} // namespace

const NameTable<TetDistanceMethod>& names(TetDistanceMethod)
{
    static const NameTable<TetDistanceMethod> table{{"own-prism", TetDistanceMethod::own_prism},
                                                    {"near-prisms", TetDistanceMethod::near_prisms},
                                                    {"exact", TetDistanceMethod::exact}};
    return table;
}

TetDistances tet_distances(const ShellStack& stack, const TetMesh& tets,
                           const TetDistanceOptions& options, Interrupter* interrupter)
{
    return scan(stack, tets, options, nullptr, interrupter);
}

TetDistances next_tet_distances(const ShellStack& stack, const TetMesh& tets,
                                const TetMesh& previous_tets,
                                const openvdb::GridBase& previous_nearest,
                                const TetDistanceOptions& options, Interrupter* interrupter)
{
    // A place is carried by the number of its tet, which has to mean the same tet in both poses.
    if (previous_tets.points.size() != tets.points.size())
        throw InvalidOption("distance by tets: the last pose has " +
                            std::to_string(previous_tets.points.size()) +
                            " points of tets, this one " + std::to_string(tets.points.size()));
    if (previous_tets.tets != tets.tets)
        throw InvalidOption("distance by tets: the last pose has " +
                            std::to_string(previous_tets.tets.size()) + " tets that are not the " +
                            std::to_string(tets.tets.size()) + " of this one");
    const auto* grid = dynamic_cast<const openvdb::Int32Grid*>(&previous_nearest);
    if (!grid)
        throw InvalidOption("distance by tets: the nearest triangles of the last pose are a grid "
                            "of " +
                            previous_nearest.valueType() + ", not of int32");
    const auto count = std::int64_t(stack.triangles().size());
    // The grid may come from a file; its numbers are used as indices.
    for (auto voxel = grid->cbeginValueOn(); voxel; ++voxel)
        if (*voxel < 0 || *voxel >= count)
            throw InvalidOption("distance by tets: the last pose names triangle " +
                                std::to_string(*voxel) + " of " + std::to_string(count));
    const Previous previous{previous_tets, *grid};
    return scan(stack, tets, options, &previous, interrupter);
}

} // namespace vdb_shell
