// SPDX-License-Identifier: Apache-2.0
// The signed distance to a closed mesh in a band to both sides of it, by leaves of 8 x 8 x 8
// voxels. The list of triangles near a leaf is thinned for smaller and smaller blocks;
// docs/stages/level_set.md, "How the narrow band is made", has the idea. Signs come from
// pseudo-normals ([15] of the paper), so cavities need nothing special, but the mesh must be
// closed, oriented and free of crossings, else signs are wrong. The nearest triangle is chosen in
// float32 relative to the middle of the leaf; ties go to the triangle with the lower number. Each
// leaf is filled by itself, so the bits are the same for any number of threads. Lengths are in
// voxels until values are stored.

#include "vdb_shell/field/narrow_band.h"

#include "core/bucket_sort.h"
#include "core/parallel.h"
#include "core/stage_progress.h"
#include "field/level_set_checks.h"
#include "field/signed_distance.h"
#include "mesh/eight_distances.h"

#include <openvdb/tools/SignedFloodFill.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
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
// By how much float32 may be wrong in coordinates relative to a leaf's middle. Triangles may reach
// far out of their leaf; for those of up to a thousand voxels the rounding is below this.
constexpr double kSlackVoxels = 1e-3;

/// A triangle that comes near a leaf. Voxel indices are limited to 2^22 (kLargestVoxelIndex), hence
/// those of leaves to 2^19, so 21 bits and an offset hold any leaf of the band as a number that
/// sorts by x, y, z.
struct LeafTriangle {
    std::uint64_t place; ///< of the leaf, 21 bits for each axis
    std::uint32_t triangle;

    static constexpr int kBits = 21, kOffset = 1 << (kBits - 1);
    LeafTriangle() = default;
    LeafTriangle(const Coord& leaf, std::uint32_t of) : place(0), triangle(of)
    {
        for (int axis = 0; axis < 3; ++axis)
            place = place << kBits | static_cast<std::uint64_t>(leaf[axis] + kOffset);
    }
    /// The leaf's first voxel.
    Coord leaf() const
    {
        Coord first;
        for (int axis = 0; axis < 3; ++axis)
            first[axis] =
                8 * (static_cast<int>(place >> (2 - axis) * kBits & (2 * kOffset - 1)) - kOffset);
        return first;
    }
    /// The leaf's x and y, counted from the first there can be.
    std::array<std::int64_t, 2> column() const
    {
        return {std::int64_t(place >> 2 * kBits), std::int64_t(place >> kBits & (2 * kOffset - 1))};
    }
    bool operator<(const LeafTriangle& o) const
    {
        return place != o.place ? place < o.place : triangle < o.triangle;
    }
};

/// False only where the triangle is farther than `reach` from all of a leaf's voxel centres. Tested
/// are the two sides of its plane, and the planes square to it through its sides. It may be true
/// for a leaf that is out of reach: that costs time and changes nothing.
class LeafFilter
{
public:
    LeafFilter(const std::array<Vec3d, 3>& corner, double reach)
    {
        // A triangle without area has no planes. Without planes the filter holds nothing back, and
        // the bounding box alone decides.
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
        // How far the cube of a leaf's voxel centres reaches from its middle against the plane's
        // normal. If even its nearest point is more than `reach` beyond a plane that has the
        // triangle behind it, so is every voxel.
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
        // The shift is a division by 8 that rounds down for negative numbers too, as the numbers of
        // leaves need it.
        low[axis] = static_cast<int>(std::ceil(least - reach)) >> 3;
        high[axis] = static_cast<int>(std::floor(most + reach)) >> 3;
    }
    const LeafFilter filter(corner, reach);
    for (int x = low[0]; x <= high[0]; ++x)
        for (int y = low[1]; y <= high[1]; ++y)
            for (int z = low[2]; z <= high[2]; ++z)
                if (filter.meets(8.0 * Vec3d(x, y, z) + Vec3d(kHalfLeaf)))
                    visit(Coord(x, y, z));
}

std::array<Vec3d, 3> index_corners(const SignedDistance& surface, std::uint32_t t, double voxel)
{
    std::array<Vec3d, 3> corner = surface.corners(t);
    for (Vec3d& c : corner)
        c /= voxel;
    return corner;
}

/// Sorted by leaf, then by triangle.
std::vector<LeafTriangle> leaf_triangles(const SignedDistance& surface, std::size_t count,
                                         double voxel, double reach)
{
    // Parts have a fixed size, whatever the number of threads. The sort has a total order, so the
    // list would be the same for any parts.
    constexpr std::size_t kTrianglesInPart = 256;
    std::vector<std::vector<LeafTriangle>> parts((count + kTrianglesInPart - 1) / kTrianglesInPart);
    for_each_index(
        parts.size(),
        [&](std::size_t i) {
            const std::size_t end = std::min((i + 1) * kTrianglesInPart, count);
            for (std::size_t n = i * kTrianglesInPart; n < end; ++n) {
                const auto t = static_cast<std::uint32_t>(n);
                for_each_leaf_near(index_corners(surface, t, voxel), reach,
                                   [&](const Coord& leaf) { parts[i].emplace_back(leaf, t); });
            }
        },
        1);
    return bucket_sort_by_column<LeafTriangle>(
        parts, [](const LeafTriangle& pair) { return pair.column(); }, std::less<>());
}

using List = std::vector<std::uint32_t>;

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
        origin_ = first->leaf();
        const Vec3d middle = origin_.asVec3d() + Vec3d(kHalfLeaf);
        prepared_.clear();
        for (const LeafTriangle* pair = first; pair != last; ++pair) {
            std::array<Vec3d, 3> corner = index_corners(surface_, pair->triangle, voxel_);
            for (Vec3d& c : corner)
                c -= middle;
            prepared_.push_back(prepare_triangle(corner));
        }
        all_.resize(prepared_.size());
        std::iota(all_.begin(), all_.end(), 0U);
        leaf_.reset();
        pairs_ = first;
        descend(0, Coord(0), all_);
        return std::move(leaf_);
    }

private:
    /// Blocks of 8, 4 and 2 voxels a side, from their least corner in the leaf.
    void descend(std::size_t level, const Coord& corner, const List& list)
    {
        const int side = 4 >> level; // voxels a side
        EightPoints points;
        for (std::size_t i = 0; i < kLanes; ++i) {
            const Coord least = corner_of_block(corner, side, i);
            const float to_middle = 0.5F * static_cast<float>(side - 1) - float(kHalfLeaf);
            points.x[i] = static_cast<float>(least[0]) + to_middle;
            points.y[i] = static_cast<float>(least[1]) + to_middle;
            points.z[i] = static_cast<float>(least[2]) + to_middle;
        }
        EightNearest nearest;
        // At this level the blocks are single voxels, and their middles are the voxel centres.
        if (level == 2) {
            nearest_of(prepared_.data(), list.data(), list.size(), points, nullptr, nearest);
            store(corner, nearest);
            return;
        }
        squared_.resize(list.size() * kLanes);
        nearest_of(prepared_.data(), list.data(), list.size(), points, squared_.data(), nearest);
        // From the middle of a block to its farthest voxel centre.
        const float radius = std::sqrt(3.0F) * 0.5F * static_cast<float>(side - 1);
        std::array<float, kLanes> limit;
        for (std::size_t i = 0; i < kLanes; ++i) {
            const float closest = std::sqrt(nearest.squared[i]);
            // A voxel of the block is at most `radius` from its middle, so its nearest triangle is
            // at most closest + 2 radius from the middle. Triangles beyond reach + radius are out
            // of reach of all its voxels.
            const float most =
                std::min(closest + 2 * radius, reach_ + radius) + static_cast<float>(kSlackVoxels);
            // No squared distance is below -1, so a block that is out of reach gets an empty list.
            limit[i] = closest > reach_ + radius ? -1.0F : most * most;
        }
        std::array<List, kLanes>& of_block = lists_[level];
        list_within_limits(list, limit, of_block);
        for (std::size_t i = 0; i < kLanes; ++i)
            if (!of_block[i].empty())
                descend(level + 1, corner_of_block(corner, side, i), of_block[i]);
    }

    /// Gives each of eight points those of the list that are no farther from it than its limit, by
    /// the distances in squared_.
    void list_within_limits(const List& list, const std::array<float, kLanes>& limit,
                            std::array<List, kLanes>& of_point)
    {
        for (List& near : of_point)
            near.clear();
        within_.resize(list.size());
        list_within(squared_.data(), list.size(), limit, within_.data());
        for (std::size_t n = 0; n < list.size(); ++n)
            for (unsigned bits = within_[n]; bits != 0; bits &= bits - 1)
                of_point[std::size_t(__builtin_ctz(bits))].push_back(list[n]);
    }

    void store(const Coord& corner, const EightNearest& nearest)
    {
        for (std::size_t i = 0; i < kLanes; ++i) {
            if (nearest.squared[i] > reach_ * reach_)
                continue;
            const Coord in_leaf = corner_of_block(corner, 1, i);
            double d = nearest.height[i] * voxel_;
            // The height is 0 at sides and corners, where the sign needs a pseudo-normal. Near the
            // plane floats cannot tell its two sides apart. In both cases distance and sign are
            // computed in doubles.
            if (std::abs(nearest.height[i]) < kSlackVoxels) {
                const auto pair = static_cast<std::size_t>(nearest.triangle[i]);
                d = surface_.at(voxel_ * (origin_ + in_leaf).asVec3d(), pairs_[pair].triangle);
            }
            // The slack in `reach_` was for floats only. A voxel is active when its distance is
            // less than the background.
            if (!(std::abs(d) < (reach_ - kSlackVoxels) * voxel_))
                continue;
            if (!leaf_)
                // Inactive voxels get their sign and the background's magnitude from the flood
                // fill.
                leaf_ = std::make_unique<Leaf>(origin_, 0.0F, false);
            leaf_->setValueOn(Leaf::coordToOffset(in_leaf), static_cast<float>(d));
        }
    }

    const SignedDistance& surface_;
    double voxel_;
    float reach_; ///< voxels: the band and some slack
    Coord origin_;
    const LeafTriangle* pairs_ = nullptr;
    std::unique_ptr<Leaf> leaf_;
    std::vector<PreparedTriangle> prepared_;
    List all_;
    std::array<std::array<List, kLanes>, 2> lists_; ///< by level, of each of the eight blocks
    std::vector<float> squared_;
    std::vector<std::uint8_t> within_;
};

void fill_leaves(openvdb::FloatTree& tree, const SignedDistance& surface, double voxel,
                 const std::vector<LeafTriangle>& pairs, double reach)
{
    std::vector<std::size_t> starts;
    for (std::size_t i = 0; i < pairs.size(); ++i)
        if (i == 0 || pairs[i].place != pairs[i - 1].place)
            starts.push_back(i);
    // Leaves are made by many threads and put into the tree by one, since the tree is not made for
    // several writers.
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

const NameTable<FieldRoute>& names(FieldRoute)
{
    static const NameTable<FieldRoute> table{{"auto", FieldRoute::automatic},
                                             {"sparse", FieldRoute::sparse},
                                             {"dense", FieldRoute::dense}};
    return table;
}

openvdb::FloatGrid::Ptr mesh_to_narrow_band(const TriangleMesh& mesh,
                                            const LevelSetOptions& options,
                                            Interrupter* interrupter)
{
    const StageProgress progress(interrupter, "level set");
    LevelSetOptions narrow = options;
    // The tests of size and memory are those of the dense route. They get the depth of the band
    // that is really made, so that they do not refuse a grid that fits.
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
    finish_level_set(*grid);
    return grid;
}

} // namespace vdb_shell
