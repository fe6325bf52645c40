// SPDX-License-Identifier: Apache-2.0

// Takes points in a shell at rest, and the maps of the shell at rest and in a pose. Gives the
// points in the pose. First the place of each is found and its vectors are carried, leaf by leaf;
// then OpenVDB moves the points with all that they have.

#include "vdb_shell/volume/deform_points.h"

#include "core/parallel.h"
#include "core/point_grid_instances.h"
#include "core/stage_progress.h"
#include "vdb_shell/core/error.h"
#include "vdb_shell/options/option.h"
#include "vdb_shell/volume/motion_volume.h"
#include "vdb_shell/volume/shell_sampler.h"
#include "volume/pull_back.h"

#include <openvdb/points/PointAttribute.h>
#include <openvdb/points/PointMove.h>

#include <algorithm>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

namespace vdb_shell
{
namespace
{

using openvdb::Coord;
using openvdb::Vec3d;
using openvdb::Vec3f;
using openvdb::points::AttributeArray;
using openvdb::points::AttributeSet;
using openvdb::points::AttributeWriteHandle;
using openvdb::points::PointDataGrid;
using openvdb::points::PointDataTree;
using Leaf = PointDataTree::LeafNodeType;

constexpr const char* kNormal = "N";

/// Where the points of a leaf go.
struct MovedLeaf {
    std::vector<Vec3d> to; ///< world space of the grid
    std::vector<std::uint8_t> found;
};
using MovedLeaves = std::unordered_map<Coord, MovedLeaf>;

/// What movePoints asks.
class Mover
{
public:
    explicit Mover(const MovedLeaves& moved) : moved_(moved) {}
    void reset(const Leaf& leaf, std::size_t /*index*/) { leaf_ = &moved_.at(leaf.origin()); }
    template <typename Iterator> void apply(Vec3d& position, const Iterator& point) const
    {
        position = leaf_->to[*point];
    }

private:
    const MovedLeaves& moved_;
    const MovedLeaf* leaf_ = nullptr;
};

/// An index filter of OpenVDB: the points that are in the shell.
class InShell
{
public:
    explicit InShell(const MovedLeaves& moved) : moved_(moved) {}
    // OpenVDB asks these of every filter. Which points of a leaf are inside is only known point by
    // point, hence partial.
    static bool initialized() { return true; }
    static openvdb::points::index::State state() { return openvdb::points::index::PARTIAL; }
    template <typename LeafNode> static openvdb::points::index::State state(const LeafNode&)
    {
        return openvdb::points::index::PARTIAL;
    }
    template <typename LeafNode> void reset(const LeafNode& leaf)
    {
        leaf_ = &moved_.at(leaf.origin());
    }
    template <typename Iterator> bool valid(const Iterator& point) const
    {
        return leaf_->found[*point] != 0;
    }

private:
    const MovedLeaves& moved_;
    const MovedLeaf* leaf_ = nullptr;
};

/// Files are not trusted: movePoints copies from array to array by the first leaf's attributes.
void require_alike(const PointDataGrid& grid)
{
    const AttributeSet* first = nullptr;
    for (auto leaf = grid.tree().cbeginLeaf(); leaf; ++leaf) {
        const AttributeSet& set = leaf->attributeSet();
        const AttributeArray* position = set.getConst("P");
        if (!position || !position->hasValueType<Vec3f>() || position->stride() != 1 ||
            !position->hasConstantStride())
            throw InvalidOption("grid \"" + grid.getName() +
                                "\": its points have no attribute \"P\" of three floats");
        bool alike = true;
        if (first) {
            alike = set.descriptor() == first->descriptor();
            for (std::size_t i = 0; alike && i < set.size(); ++i)
                alike =
                    set.getConst(i)->stride() == first->getConst(i)->stride() &&
                    set.getConst(i)->hasConstantStride() == first->getConst(i)->hasConstantStride();
        } else {
            first = &set;
        }
        if (!alike)
            throw InvalidOption("grid \"" + grid.getName() +
                                "\": its leaves have different attributes");
    }
}

/// The array of that name if it holds a vector of three floats for each point.
AttributeArray* vectors_of(Leaf& leaf, const char* name)
{
    if (leaf.attributeSet().find(name) == AttributeSet::INVALID_POS)
        return nullptr;
    AttributeArray& array = leaf.attributeArray(name);
    const bool one_vector =
        array.hasValueType<Vec3f>() && array.stride() == 1 && array.hasConstantStride();
    return one_vector ? &array : nullptr;
}

/// An attribute has no vector type as a grid has; `by_type` is what its name stands for.
VectorMap vector_map(VectorRule rule, VectorMap by_type)
{
    switch (rule) {
    case VectorRule::by_type:
        return by_type;
    case VectorRule::transform:
        return VectorMap::forward;
    case VectorRule::rotate:
        return VectorMap::rotate;
    case VectorRule::keep:
        break;
    }
    return VectorMap::keep;
}

/// Says where points go. What it holds is read only, so all threads share one; each has a leaf of
/// its own.
class Carrier
{
public:
    Carrier(const ShellMap& rest, const ShellMap& posed, const ShellMap* velocity,
            const Vec3d& shift, VectorRule rule)
        : sampler_(rest), rest_(rest), posed_(posed), velocity_(velocity), shift_(shift),
          velocity_rule_(vector_map(rule, VectorMap::forward)),
          normal_rule_(vector_map(rule, VectorMap::unit_normal))
    {
    }

    /// Changes the leaf's vectors; the points move later.
    void carry(Leaf& leaf, const openvdb::math::Transform& transform, MovedLeaf& moved) const
    {
        const AttributeArray& positions = leaf.constAttributeArray("P");
        const openvdb::points::AttributeHandle<Vec3f> position(positions);
        moved.to.assign(positions.size(), Vec3d(0.0));
        moved.found.assign(positions.size(), 0);
        const Vectors velocities(vectors_of(leaf, kVelocityName)),
            normals(vectors_of(leaf, kNormal));
        for (auto point = leaf.beginIndexOn(); point; ++point) {
            // OpenVDB stores a position in voxels from the centre of the point's own voxel.
            const Vec3d at = Vec3d(position.get(*point)) + point.getCoord().asVec3d();
            const ShellPlace place = sampler_.find(transform.indexToWorld(at) - shift_);
            if (!place.found())
                continue;
            moved.found[*point] = 1;
            moved.to[*point] = posed_.point_of(place) + shift_;
            // Vectors are changed now, while the place is known: when movePoints has run, the point
            // may be in another leaf, under another number.
            const openvdb::Mat3d by_pose = pull_back(rest_, posed_, place).by_pose;
            const Vec3d added = velocity_ ? velocity_->point_of(place) : Vec3d(0.0);
            velocities.change(*point, [&](const Vec3d& v) {
                return carried_vector(v, velocity_rule_, by_pose) + added;
            });
            normals.change(
                *point, [&](const Vec3d& n) { return carried_vector(n, normal_rule_, by_pose); });
        }
    }

private:
    class Vectors
    {
    public:
        explicit Vectors(AttributeArray* array)
            : handle_(array ? AttributeWriteHandle<Vec3f>::create(*array) : nullptr)
        {
        }
        template <typename Change> void change(openvdb::Index point, const Change& to) const
        {
            if (handle_)
                handle_->set(point, Vec3f(to(Vec3d(handle_->get(point)))));
        }

    private:
        AttributeWriteHandle<Vec3f>::Ptr handle_;
    };

    ShellSampler sampler_;
    const ShellMap &rest_, &posed_;
    const ShellMap* velocity_;
    Vec3d shift_;
    VectorMap velocity_rule_, normal_rule_;
};

/// By origin of the leaf, whose place among the leaves movePoints does not tell the filter.
MovedLeaves carry_all(PointDataGrid& grid, const Carrier& carrier, const StageProgress& progress)
{
    std::vector<Leaf*> leaves;
    grid.tree().getNodes(leaves);
    MovedLeaves moved;
    // All keys are made before the threads begin, which then only look them up; inserting at the
    // same time would not be safe.
    for (const Leaf* leaf : leaves)
        moved[leaf->origin()];
    // Some tens of milliseconds of work a block: soon enough for who waits for an answer.
    constexpr std::size_t kBlock = 256;
    for (std::size_t begin = 0; begin < leaves.size(); begin += kBlock) {
        progress.stop_if_interrupted(int(100 * begin / leaves.size()));
        for_each_index(
            std::min(kBlock, leaves.size() - begin),
            [&](std::size_t i) {
                Leaf& leaf = *leaves[begin + i];
                carrier.carry(leaf, grid.transform(), moved.at(leaf.origin()));
            },
            1);
    }
    return moved;
}

std::size_t number_found(const MovedLeaves& moved)
{
    std::size_t found = 0;
    for (const auto& leaf : moved)
        found += std::size_t(std::count(leaf.second.found.begin(), leaf.second.found.end(), 1));
    return found;
}

} // namespace

bool is_point_grid(const openvdb::GridBase& grid)
{
    return grid.isType<PointDataGrid>();
}

GridBasePtr deform_points(const openvdb::GridBase& source, const ShellMap& rest,
                          const ShellMap& posed, const Vec3d& shift, const DeformOptions& options,
                          DeformFigures& figures, const ShellMap* velocity,
                          Interrupter* interrupter)
{
    require_in_range(options, "deform");
    const StageProgress progress(interrupter, "deform points");
    figures = {};
    figures.grid = source.getName();
    if (!is_point_grid(source))
        throw InvalidOption("grid \"" + source.getName() + "\" has no points");
    if (!source.transform().isLinear())
        throw InvalidOption("grid \"" + source.getName() + "\": its transform is a " +
                            source.transform().mapType() + ", which points cannot be carried with");
    const auto points = openvdb::gridPtrCast<PointDataGrid>(source.deepCopyGrid());
    require_alike(*points);
    for (auto leaf = points->tree().cbeginLeaf(); leaf; ++leaf)
        figures.active_before += std::size_t(leaf->constAttributeArray("P").size());
    if (figures.active_before == 0)
        throw InvalidOption("grid \"" + source.getName() + "\" has no points");
    // One leaf stands for all: require_alike has compared them.
    const AttributeSet& attributes = points->tree().cbeginLeaf()->attributeSet();
    if (velocity && attributes.find(kVelocityName) == AttributeSet::INVALID_POS)
        openvdb::points::appendAttribute<Vec3f>(points->tree(), kVelocityName);

    const Carrier carrier(rest, posed, velocity, shift, options.vectors);
    const MovedLeaves moved = carry_all(*points, carrier, progress);
    figures.active_after = number_found(moved);
    figures.outside = 1.0 - double(figures.active_after) / double(figures.active_before);
    require_inside(source.getName(), figures.outside, options.most_outside);
    Mover mover(moved);
    openvdb::points::movePoints(*points, mover, InShell(moved));
    return points;
}

} // namespace vdb_shell
