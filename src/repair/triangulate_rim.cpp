// SPDX-License-Identifier: Apache-2.0

// Takes a rim and leaves its best triangulation without new points, by dynamic programming over the
// stretches from i to k: the best one of a stretch is a triangle (i, m, k) with the best of its two
// parts (Barequet and Sharir 1995, "Filling gaps in the boundary of a polyhedron"; with the largest
// dihedral angle before the area, Liepa 2003, "Filling holes in meshes"). Time grows with the cube
// of the rim, memory with its square. The trap is that by angles this is not strictly the optimum:
// a part is chosen before the triangle beyond its chord is known. All in doubles, for the fill is
// tested afterwards.

#include "core/unit_vector.h"
#include "repair/fill_patch.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vdb_shell::repair
{
namespace
{

using openvdb::Vec3d;
using openvdb::Vec3I;

struct Weight {
    double bend = 0; ///< 1 - cosine of the largest angle between neighbouring normals
    double area = 0;
};
constexpr double kNever = std::numeric_limits<double>::infinity();

/// The table of best triangulations of the rim from i to k. Short stretches come before long ones,
/// so that the parts of a stretch are always there.
class Table
{
public:
    Table(const Rim& rim, bool by_dihedral)
        : rim_(rim), n_(static_cast<std::uint32_t>(rim.points.size())), by_dihedral_(by_dihedral),
          weight_(std::size_t(n_) * n_), middle_(std::size_t(n_) * n_, 0)
    {
        for (std::uint32_t i = 0; i < n_; ++i)
            outside_.push_back(normal(rim.points[(i + 1) % n_], rim.points[i], rim.beyond[i]));
        for (std::uint32_t span = 2; span < n_; ++span)
            for (std::uint32_t i = 0; i + span < n_; ++i)
                find_best(i, i + span);
    }

    bool possible() const { return weight_[at(0, n_ - 1)].area < kNever; }

    void collect(std::vector<Vec3I>& triangles) const
    {
        // A list in the place of recursion, whose depth can be the length of the rim.
        std::vector<std::pair<std::uint32_t, std::uint32_t>> open{{0, n_ - 1}};
        while (!open.empty()) {
            const auto [i, k] = open.back();
            open.pop_back();
            if (k - i < 2)
                continue;
            const std::uint32_t m = middle_[at(i, k)];
            triangles.emplace_back(i, m, k);
            open.emplace_back(i, m);
            open.emplace_back(m, k);
        }
    }

private:
    std::size_t at(std::uint32_t i, std::uint32_t k) const { return std::size_t(i) * n_ + k; }

    static Vec3d normal(const Vec3d& a, const Vec3d& b, const Vec3d& c)
    {
        return unit_vector((b - a).cross(c - a));
    }

    /// The normal of what lies beyond the chord from i to k, seen from the inner side.
    Vec3d normal_beyond(std::uint32_t i, std::uint32_t k) const
    {
        if (k == i + 1)
            return outside_[i];
        return normal(rim_.points[i], rim_.points[middle_[at(i, k)]], rim_.points[k]);
    }

    /// A chord that is an edge of the surface already would get more than two triangles. Stretches
    /// of one edge are the rim itself, and so is the chord that closes it.
    bool exists_already(std::uint32_t i, std::uint32_t k) const
    {
        return k > i + 1 && !(i == 0 && k == n_ - 1) && rim_.edges.count({i, k}) > 0;
    }

    bool less(const Weight& a, const Weight& b) const
    {
        if (by_dihedral_ && a.bend != b.bend)
            return a.bend < b.bend;
        return a.area < b.area;
    }

    void find_best(std::uint32_t i, std::uint32_t k)
    {
        Weight best{kNever, kNever};
        if (!exists_already(i, k)) {
            for (std::uint32_t m = i + 1; m < k; ++m) {
                const Weight weight = weight_through(i, m, k);
                if (less(weight, best)) {
                    best = weight;
                    middle_[at(i, k)] = m;
                }
            }
        }
        weight_[at(i, k)] = best;
    }

    Weight weight_through(std::uint32_t i, std::uint32_t m, std::uint32_t k) const
    {
        const Weight &left = weight_[at(i, m)], &right = weight_[at(m, k)];
        if (left.area == kNever || right.area == kNever)
            return {kNever, kNever};
        const Vec3d cross =
            (rim_.points[m] - rim_.points[i]).cross(rim_.points[k] - rim_.points[i]);
        const double twice = cross.length();
        // A triangle without area has no normal, and the test of a fill counts it as a crossing.
        if (!(twice > 0))
            return {kNever, kNever};
        Weight weight{std::max(left.bend, right.bend), left.area + right.area + 0.5 * twice};
        if (!by_dihedral_)
            return weight;
        const Vec3d n = cross / twice;
        weight.bend =
            std::max({weight.bend, 1 - n.dot(normal_beyond(i, m)), 1 - n.dot(normal_beyond(m, k))});
        // The last triangle is at the rim's closing edge and has a triangle outside there as well.
        if (i == 0 && k == n_ - 1)
            weight.bend = std::max(weight.bend, 1 - n.dot(outside_[k]));
        return weight;
    }

    const Rim& rim_;
    std::uint32_t n_;
    bool by_dihedral_;
    std::vector<Weight> weight_;
    std::vector<std::uint32_t> middle_;
    std::vector<Vec3d> outside_;
};

} // namespace

Patch triangulate_rim(const Rim& rim, bool by_dihedral)
{
    Patch patch{rim.points, {}};
    const Table table(rim, by_dihedral);
    if (table.possible())
        table.collect(patch.triangles);
    return patch;
}

bool is_planar(const Rim& rim)
{
    constexpr double kFlat = 1e-3;
    Vec3d normal(0.0), centre(0.0);
    double length = 0;
    const std::size_t n = rim.points.size();
    for (std::size_t i = 0; i < n; ++i) {
        const Vec3d a = rim.points[i] - rim.points[0], b = rim.points[(i + 1) % n] - rim.points[0];
        normal += a.cross(b);
        centre += rim.points[i] / double(n);
        length += (b - a).length();
    }
    if (!(normal.length() > 0))
        return false;
    normal = unit_vector(normal);
    return std::all_of(rim.points.begin(), rim.points.end(), [&](const Vec3d& p) {
        return std::abs(normal.dot(p - centre)) <= kFlat * length;
    });
}

} // namespace vdb_shell::repair
