// SPDX-License-Identifier: Apache-2.0

// Takes points, gives their places in a shell. The voxel around a point names a tet that holds the
// voxel's centre, which mostly holds the point too; where it does not, a tree of boxes tells.

#include "vdb_shell/volume/shell_sampler.h"

#include "core/box_tree.h"
#include "core/voxel_numbers.h"
#include "volume/tet_index_grid.h"

#include <cmath>
#include <limits>

namespace vdb_shell
{
namespace
{

using openvdb::Vec3d;
using openvdb::Vec3s;

BoxTree tree_of(const TetMesh& tets)
{
    std::vector<FloatBox> boxes;
    boxes.reserve(tets.tets.size());
    for (const openvdb::Vec4I& tet : tets.tets) {
        FloatBox box = FloatBox::around(tets.points[tet[0]]);
        for (int i = 1; i < 4; ++i)
            box.add(tets.points[tet[i]]);
        boxes.push_back(box);
    }
    BoxTree tree;
    tree.build(boxes);
    return tree;
}

/// Tets without volume have no size to go by. No voxel gets one of them then, so any size will do.
double sensible_voxel_size(const TetMesh& tets)
{
    const double volume = std::abs(tet_volume(tets));
    return tets.tets.empty() || volume == 0 ? 1.0
                                            : std::cbrt(volume / double(tets.tets.size())) / 3.0;
}

/// The box of floats around a point of doubles.
FloatBox box_around(const Vec3d& point)
{
    // One float farther on either side, for the point itself was rounded to a float: a tet that
    // holds the double must not be missed.
    const auto toward = [&](double end) {
        Vec3s p(point);
        for (int axis = 0; axis < 3; ++axis)
            p[axis] = std::nextafter(p[axis], float(end));
        return p;
    };
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    FloatBox box = FloatBox::around(toward(-kInfinity));
    box.add(toward(kInfinity));
    return box;
}

} // namespace

struct ShellSampler::Parts {
    BoxTree tree;
    openvdb::Int32Grid::Ptr near;
    double voxel_size;
};

ShellSampler::ShellSampler(const ShellMap& map, double voxel_size) : map_(map)
{
    const double size = voxel_size > 0 ? voxel_size : sensible_voxel_size(map.tets());
    const StageProgress progress(nullptr, "shell sampler");
    parts_ = std::make_unique<const Parts>(
        Parts{tree_of(map.tets()), tet_index_grid(map.tets(), size, "sampler", progress), size});
}

ShellSampler::~ShellSampler() = default;
ShellSampler::ShellSampler(ShellSampler&&) noexcept = default;

ShellPlace ShellSampler::find(const Vec3d& point) const
{
    const Vec3d voxel = point / parts_->voxel_size;
    if (!has_voxel_numbers(voxel))
        return {};
    const int near = parts_->near->tree().getValue(openvdb::Coord::round(voxel));
    if (near >= 0) {
        const ShellPlace place = map_.find_in(std::uint32_t(near), point);
        if (place.found())
            return place;
    }
    std::uint32_t tet = ShellPlace::kNone;
    parts_->tree.for_each_overlap(box_around(point), [&](int t) {
        // The smallest index, whatever order the tree gives: on a face both tets hold the point.
        if (std::uint32_t(t) < tet && map_.holds(std::uint32_t(t), point))
            tet = std::uint32_t(t);
    });
    return tet == ShellPlace::kNone ? ShellPlace() : map_.place_in(tet, point);
}

} // namespace vdb_shell
