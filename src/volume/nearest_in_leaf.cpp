// SPDX-License-Identifier: Apache-2.0

// Takes a list of triangles, thins it out for smaller and smaller blocks of a leaf, as
// field/narrow_band.cpp does, and compares what is left in doubles. Invariant: a triangle is
// dropped only if another one is nearer to every voxel of the block, by more than floats can be
// wrong. So the answer for a voxel is that of all triangles of the list, whatever else the list
// has. Lengths are in voxels until distances are stored.

#include "volume/nearest_in_leaf.h"

#include "core/parallel.h"
#include "mesh/nearest_on_triangle.h"
#include "mesh/triangle_corners.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace vdb_shell
{

using openvdb::Coord;
using openvdb::Vec3d;

namespace
{

// How wrong the difference of two distances of floats may be, as a share of the mesh's diagonal M.
// Coordinates are at most M in size about the middle, hence rounded by 6e-8 M; a foot on a side is
// off by a handful of roundings along each axis, 4e-7 M, which makes 7e-7 M in space; and two
// distances are compared. This is more than twice that.
constexpr double kDistanceSlack = 4e-6;
constexpr double kHalfLeaf = 3.5; // from a leaf's first voxel to its middle

/// From the middle of a block to its farthest voxel centre.
double radius_of(int side)
{
    return std::sqrt(3.0) * 0.5 * (side - 1);
}

} // namespace

DistanceSurface::DistanceSurface(const TriangleMesh& mesh, double voxel_size)
    : mesh_(mesh), voxel_(voxel_size), tree_(mesh, voxel_size), prepared_(mesh.triangles.size())
{
    const Bounds bounds = bounds_of(mesh.points);
    middle_ = 0.5 / voxel_ * (bounds.low + bounds.high);
    slack_ = kDistanceSlack * diagonal_of(bounds) / voxel_;
    for_each_index(prepared_.size(), [&](std::size_t t) {
        // About the middle of the mesh before rounding to floats: far from the origin there would
        // be no digits left for the shape.
        std::array<Vec3d, 3> corner = triangle_corners(mesh, t);
        for (Vec3d& c : corner)
            c = c / voxel_ - middle_;
        prepared_[t] = prepare_triangle(corner);
    });
}

double DistanceSurface::distance(const Coord& voxel, std::uint32_t triangle) const
{
    const Vec3d place = voxel_ * voxel.asVec3d();
    return (nearest_on_triangle(triangle_corners(mesh_, triangle), place).point - place).length();
}

EightPoints NearestInLeaf::points_at(const Coord& corner, int side) const
{
    EightPoints points;
    for (std::size_t i = 0; i < kLanes; ++i) {
        const Coord least = origin_ + corner_of_block(corner, side, i);
        const openvdb::Vec3f p = surface_.about_middle(least.asVec3d() + Vec3d(0.5 * (side - 1)));
        points.x[i] = p[0], points.y[i] = p[1], points.z[i] = p[2];
    }
    return points;
}

bool NearestInLeaf::wanted(const Coord& corner, int side) const
{
    // The bits of a word are eight rows along y of eight voxels along z.
    const std::uint64_t row = ((std::uint64_t(1) << side) - 1) << corner[2];
    std::uint64_t rows = 0;
    for (int y = 0; y < side; ++y)
        rows |= row << 8 * (corner[1] + y);
    for (int x = 0; x < side; ++x)
        if (mask_[std::size_t(corner[0] + x)] & rows)
            return true;
    return false;
}

void NearestInLeaf::thin_out(const List& list, const std::array<float, kLanes>& limit)
{
    within_.resize(list.size());
    list_within(squared_.data(), list.size(), limit, within_.data());
}

void NearestInLeaf::take_nearest(const Coord& corner, const List& list, Voxels& found)
{
    EightNearest nearest;
    squared_.resize(list.size() * kLanes);
    nearest_of(surface_.prepared(), list.data(), list.size(), points_at(corner, 1), squared_.data(),
               nearest);
    std::array<float, kLanes> limit{};
    std::array<Coord, kLanes> voxel;
    std::array<std::size_t, kLanes> place{};
    for (std::size_t i = 0; i < kLanes; ++i) {
        const float most = std::sqrt(nearest.squared[i]) + float(surface_.slack_voxels());
        voxel[i] = corner_of_block(corner, 1, i);
        place[i] = std::size_t(voxel[i][0] << 6 | voxel[i][1] << 3 | voxel[i][2]);
        found.distance[place[i]] = std::numeric_limits<double>::infinity();
        // No square is below nothing, so a voxel that nobody asks for keeps no triangle.
        limit[i] = wanted(voxel[i], 1) ? most * most : -1.0F;
    }
    thin_out(list, limit);
    for (std::size_t n = 0; n < list.size(); ++n)
        for (unsigned bits = within_[n]; bits != 0; bits &= bits - 1) {
            const auto i = std::size_t(__builtin_ctz(bits));
            const double d = surface_.distance(origin_ + voxel[i], list[n]);
            double& least = found.distance[place[i]];
            std::uint32_t& triangle = found.triangle[place[i]];
            // The smallest index of equally near ones, so that the answer does not depend on the
            // order of the list.
            if (d < least || (d == least && list[n] < triangle))
                least = d, triangle = list[n];
        }
}

void NearestInLeaf::descend(std::size_t level, const Coord& corner, const List& list, Voxels& found)
{
    const int side = 4 >> level; // voxels a side
    if (side == 1) {
        take_nearest(corner, list, found);
        return;
    }
    EightNearest nearest;
    squared_.resize(list.size() * kLanes);
    nearest_of(surface_.prepared(), list.data(), list.size(), points_at(corner, side),
               squared_.data(), nearest);
    std::array<float, kLanes> limit;
    for (std::size_t i = 0; i < kLanes; ++i) {
        // A voxel of the block is at most the radius from its middle, so its nearest triangle is at
        // most twice that farther from the middle than the middle's own.
        const float most =
            std::sqrt(nearest.squared[i]) + float(2 * radius_of(side) + surface_.slack_voxels());
        limit[i] = wanted(corner_of_block(corner, side, i), side) ? most * most : -1.0F;
    }
    thin_out(list, limit);
    std::array<List, kLanes>& of_block = lists_[level];
    for (List& near : of_block)
        near.clear();
    for (std::size_t n = 0; n < list.size(); ++n)
        for (unsigned bits = within_[n]; bits != 0; bits &= bits - 1)
            // In the order of the list it came from. The lists of a level serve one block after the
            // other: what descends from here uses those of the next level.
            of_block[std::size_t(__builtin_ctz(bits))].push_back(list[n]);
    for (std::size_t i = 0; i < kLanes; ++i)
        if (!of_block[i].empty())
            descend(level + 1, corner_of_block(corner, side, i), of_block[i], found);
}

void NearestInLeaf::nearest_of_list(const Coord& origin, const Mask& mask, const List& list,
                                    Voxels& found)
{
    assert(!list.empty());
    origin_ = origin;
    mask_ = mask;
    descend(0, Coord(0), list, found);
}

void NearestInLeaf::list_nearest(const Coord& origin, const Mask& mask, const List& known,
                                 List& list)
{
    origin_ = origin;
    mask_ = mask;
    const Vec3d middle = origin.asVec3d() + Vec3d(kHalfLeaf);
    // The tree's answer for the middle bounds them all; half a leaf has a smaller radius and its
    // own bound by what is known, which is nearly always better where voxels are near their
    // triangles.
    const double to_middle =
        std::sqrt(surface_.tree().nearest(surface_.voxel_size() * middle, 0.0F, seed_).squared);
    double reach = to_middle + 2 * radius_of(8);
    if (!known.empty()) {
        EightNearest nearest;
        nearest_of(surface_.prepared(), known.data(), known.size(), points_at(Coord(0), 4), nullptr,
                   nearest);
        const double to_block = 2 * std::sqrt(3.0);
        double of_blocks = 0;
        for (std::size_t i = 0; i < kLanes; ++i)
            if (wanted(corner_of_block(Coord(0), 4, i), 4))
                of_blocks = std::max(of_blocks, std::sqrt(double(nearest.squared[i])) +
                                                    2 * radius_of(4) + to_block);
        reach = std::min(reach, of_blocks);
    }
    surface_.tree().list_within(surface_.voxel_size() * middle,
                                surface_.voxel_size() * (reach + surface_.slack_voxels()), list);
}

} // namespace vdb_shell
