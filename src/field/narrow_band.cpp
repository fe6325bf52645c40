// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/field/narrow_band.h"

#include "core/parallel.h"
#include "core/stage_progress.h"
#include "field/eight_distances.h"
#include "field/level_set_checks.h"
#include "field/signed_distance.h"

#include <openvdb/tools/SignedFloodFill.h>

#include <tbb/parallel_sort.h>

#include <array>
#include <limits>
#include <memory>
#include <numeric>
#include <vector>

namespace vdb_shell
{
namespace
{

using openvdb::Coord;
using openvdb::Vec3d;
using Leaf = openvdb::FloatTree::LeafNodeType;

constexpr double kHalfLeaf = 3.5; // from a leaf's middle to its outermost voxel centres
// Floats relative to a leaf's middle are good to far less than this.
constexpr double kSlackVoxels = 1e-3;

/// A triangle that comes near a leaf.
struct LeafTriangle {
    std::array<std::int32_t, 3> leaf;
    std::uint32_t triangle;
    bool operator<(const LeafTriangle& o) const
    {
        return leaf != o.leaf ? leaf < o.leaf : triangle < o.triangle;
    }
};

/// False only where the triangle is farther than `reach` from all of a leaf's voxel centres: by
/// the planes of the triangle and through its sides.
class LeafFilter
{
public:
    LeafFilter(const std::array<Vec3d, 3>& corner, double reach)
    {
        Vec3d n = (corner[1] - corner[0]).cross(corner[2] - corner[0]);
        if (!(n.normalize()))
            return;
        add(n, corner[0], reach);
        add(-n, corner[0], reach);
        for (std::size_t k = 0; k < 3; ++k) {
            Vec3d m = (corner[(k + 1) % 3] - corner[k]).cross(n);
            if (m.normalize())
                add(m, corner[k], reach);
        }
    }
    bool meets(const Vec3d& middle) const
    {
        for (int i = 0; i < count_; ++i)
            if (planes_[static_cast<std::size_t>(i)].first.dot(middle) >
                planes_[static_cast<std::size_t>(i)].second)
                return false;
        return true;
    }

private:
    void add(const Vec3d& n, const Vec3d& on, double reach)
    {
        const double box = kHalfLeaf * (std::abs(n[0]) + std::abs(n[1]) + std::abs(n[2]));
        planes_[static_cast<std::size_t>(count_++)] = {n, n.dot(on) + reach + box};
    }
    std::array<std::pair<Vec3d, double>, 5> planes_;
    int count_ = 0;
};

template <typename Visit>
void for_each_leaf_near(const std::array<Vec3d, 3>& corner, double reach, const Visit& visit)
{
    Coord low, high;
    for (int axis = 0; axis < 3; ++axis) {
        const auto [least, most] = std::minmax({corner[0][axis], corner[1][axis], corner[2][axis]});
        low[axis] = static_cast<int>(std::ceil(least - reach)) >> 3;
        high[axis] = static_cast<int>(std::floor(most + reach)) >> 3;
    }
    const LeafFilter filter(corner, reach);
    for (int x = low[0]; x <= high[0]; ++x)
        for (int y = low[1]; y <= high[1]; ++y)
            for (int z = low[2]; z <= high[2]; ++z)
                if (filter.meets(8.0 * Vec3d(x, y, z) + Vec3d(kHalfLeaf)))
                    visit(std::array<std::int32_t, 3>{x, y, z});
}

std::array<Vec3d, 3> index_corners(const SignedDistance& surface, std::uint32_t t, double voxel)
{
    std::array<Vec3d, 3> corner = surface.corners(t);
    for (Vec3d& c : corner)
        c /= voxel;
    return corner;
}

std::vector<LeafTriangle> leaf_triangles(const SignedDistance& surface, std::size_t count,
                                         double voxel, double reach)
{
    std::vector<std::size_t> start(count + 1, 0);
    for_each_index(count, [&](std::size_t t) {
        for_each_leaf_near(index_corners(surface, std::uint32_t(t), voxel), reach,
                           [&](const auto&) { ++start[t + 1]; });
    });
    std::partial_sum(start.begin(), start.end(), start.begin());
    std::vector<LeafTriangle> pairs(start.back());
    for_each_index(count, [&](std::size_t t) {
        std::size_t next = start[t];
        for_each_leaf_near(index_corners(surface, std::uint32_t(t), voxel), reach,
                           [&](const auto& leaf) {
                               pairs[next++] = {leaf, std::uint32_t(t)};
                           });
    });
    tbb::parallel_sort(pairs.begin(), pairs.end());
    return pairs;
}

/// The eight points at +-half around a middle.
void eight_around(const std::array<float, 3>& middle, float half, EightPoints& p)
{
    for (std::size_t i = 0; i < kLanes; ++i) {
        p.x[i / 4][i % 4] = middle[0] + (i & 4 ? half : -half);
        p.y[i / 4][i % 4] = middle[1] + (i & 2 ? half : -half);
        p.z[i / 4][i % 4] = middle[2] + (i & 1 ? half : -half);
    }
}

/// The triangles that matter to a block of voxels, thinned out from leaf to half to quarter.
class LeafFill
{
public:
    LeafFill(const SignedDistance& surface, double voxel, double reach)
        : surface_(surface), voxel_(voxel), reach_(static_cast<float>(reach))
    {
    }

    /// Null when no voxel lies within reach.
    std::unique_ptr<Leaf> operator()(const LeafTriangle* first, const LeafTriangle* last)
    {
        origin_ = {8 * first->leaf[0], 8 * first->leaf[1], 8 * first->leaf[2]};
        const Vec3d middle = origin_.asVec3d() + Vec3d(kHalfLeaf);
        prepared_.clear();
        for (const LeafTriangle* pair = first; pair != last; ++pair) {
            std::array<Vec3d, 3> corner = index_corners(surface_, pair->triangle, voxel_);
            for (Vec3d& c : corner)
                c -= middle;
            prepared_.push_back(prepare_triangle(corner));
        }
        lists_[0].resize(prepared_.size());
        std::iota(lists_[0].begin(), lists_[0].end(), 0U);
        leaf_.reset();
        pairs_ = first;
        descend(0, {0, 0, 0}, 2.0F);
        return std::move(leaf_);
    }

private:
    /// Blocks of 8, 4 and 2 voxels a side; `half` is from the block's middle to that of its
    /// eighths.
    void descend(std::size_t level, const std::array<float, 3>& middle, float half)
    {
        EightPoints points;
        eight_around(middle, half, points);
        const std::vector<std::uint32_t>& list = lists_[level];
        distances_[level].resize(list.size());
        Pair<Four> least;
        least.fill(Four{} + std::numeric_limits<float>::max());
        Pair<FourIndices> nearest{};
        for (std::size_t n = 0; n < list.size(); ++n) {
            const Pair<Four> d = eight_distances(prepared_[list[n]], points);
            distances_[level][n] = d;
            const FourIndices here = FourIndices{} + static_cast<std::int32_t>(list[n]);
            for (std::size_t h = 0; h < 2; ++h) {
                nearest[h] = d[h] < least[h] ? here : nearest[h];
                least[h] = d[h] < least[h] ? d[h] : least[h];
            }
        }
        if (level == 2) {
            store(points, least, nearest);
            return;
        }
        // From an eighth's middle to its farthest voxel centre.
        const float radius = std::sqrt(3.0F) * (half - 0.5F);
        for (std::size_t i = 0; i < kLanes; ++i) {
            const float closest = std::sqrt(least[i / 4][i % 4]);
            if (closest > reach_ + radius)
                continue;
            const float limit =
                std::min(closest + 2 * radius, reach_ + radius) + static_cast<float>(kSlackVoxels);
            lists_[level + 1].clear();
            for (std::size_t n = 0; n < list.size(); ++n)
                if (distances_[level][n][i / 4][i % 4] <= limit * limit)
                    lists_[level + 1].push_back(list[n]);
            descend(level + 1,
                    {points.x[i / 4][i % 4], points.y[i / 4][i % 4], points.z[i / 4][i % 4]},
                    half / 2);
        }
    }

    void store(const EightPoints& points, const Pair<Four>& least, const Pair<FourIndices>& nearest)
    {
        for (std::size_t i = 0; i < kLanes; ++i) {
            if (least[i / 4][i % 4] > reach_ * reach_)
                continue;
            const auto in_leaf = [](float x) { return static_cast<int>(std::lround(x + 3.5F)); };
            const Coord at =
                origin_.offsetBy(in_leaf(points.x[i / 4][i % 4]), in_leaf(points.y[i / 4][i % 4]),
                                 in_leaf(points.z[i / 4][i % 4]));
            const double d =
                surface_.at(voxel_ * at.asVec3d(), pairs_[nearest[i / 4][i % 4]].triangle);
            if (!(std::abs(d) < (reach_ - kSlackVoxels) * voxel_))
                continue;
            if (!leaf_)
                leaf_ = std::make_unique<Leaf>(origin_, 0.0F, false);
            leaf_->setValueOn(Leaf::coordToOffset(at), static_cast<float>(d));
        }
    }

    const SignedDistance& surface_;
    double voxel_;
    float reach_; ///< voxels: the band and some slack
    Coord origin_;
    const LeafTriangle* pairs_ = nullptr;
    std::unique_ptr<Leaf> leaf_;
    std::vector<PreparedTriangle> prepared_;
    std::array<std::vector<std::uint32_t>, 3> lists_;
    std::array<std::vector<Pair<Four>>, 3> distances_;
};

void fill_leaves(openvdb::FloatTree& tree, const SignedDistance& surface, double voxel,
                 const std::vector<LeafTriangle>& pairs, double reach)
{
    std::vector<std::size_t> starts;
    for (std::size_t i = 0; i < pairs.size(); ++i)
        if (i == 0 || pairs[i].leaf != pairs[i - 1].leaf)
            starts.push_back(i);
    std::vector<std::unique_ptr<Leaf>> leaves(starts.size());
    starts.push_back(pairs.size());
    for_each_range(
        leaves.size(),
        [&](std::size_t begin, std::size_t end) {
            LeafFill fill(surface, voxel, reach);
            for (std::size_t n = begin; n < end; ++n)
                leaves[n] = fill(pairs.data() + starts[n], pairs.data() + starts[n + 1]);
        },
        16);
    for (std::unique_ptr<Leaf>& leaf : leaves)
        if (leaf)
            tree.addLeaf(leaf.release());
    openvdb::tools::signedFloodFill(tree);
}

} // namespace

openvdb::FloatGrid::Ptr mesh_to_narrow_band(const TriangleMesh& mesh,
                                            const LevelSetOptions& options,
                                            Interrupter* interrupter)
{
    const StageProgress progress(interrupter, "level set");
    LevelSetOptions narrow = options;
    narrow.exterior_depth.reset();
    if (!mesh.points.empty())
        narrow.interior_depth = narrow.exterior_voxels * resolve_voxel_size(mesh, narrow);
    const double voxel = checked_voxel_size(mesh, narrow);
    const double reach = narrow.exterior_voxels + kSlackVoxels;
    auto grid = openvdb::FloatGrid::create(static_cast<float>(narrow.exterior_voxels * voxel));
    const SignedDistance surface(mesh);
    const auto pairs = leaf_triangles(surface, mesh.triangles.size(), voxel, reach);
    progress.stop_if_interrupted(20);
    fill_leaves(grid->tree(), surface, voxel, pairs, reach);
    progress.stop_if_interrupted(100);
    grid->setTransform(openvdb::math::Transform::createLinearTransform(voxel));
    finish_level_set(*grid, mesh);
    return grid;
}

} // namespace vdb_shell
