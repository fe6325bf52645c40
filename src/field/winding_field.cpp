// SPDX-License-Identifier: Apache-2.0
// Points are put into an octree. A cube takes from its parent the field of what is far from the
// parent and the clusters that are not; of these it sums up what is far from itself, and hands the
// rest on. So a cluster is looked at by cubes of about its own distance only, and a cube has a
// bounded number of clusters to look at, however many triangles there are. In the smallest cubes
// what is left is near, and is summed up point by point.

#include "field/winding_field.h"

#include "core/parallel.h"
#include "core/stage_stop.h"
#include "field/eight_windings.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <utility>

namespace vdb_shell
{
namespace
{

using openvdb::Vec3d;

// Cubic interpolation in each direction. With places at the zeros of a Chebyshev polynomial the
// values of a dipole at kFarHalves are right to half a hundredth of its size (root of the mean
// square; a tenth at the worst place of 300 dipoles), and to a thousandth from 4 on.
constexpr std::size_t kPlaces = 4;
constexpr std::size_t kAllPlaces = kPlaces * kPlaces * kPlaces;
constexpr double kFarHalves = 3.0;
// Fewer points than a cube has places gain nothing from them.
constexpr std::size_t kFewPoints = 2 * kAllPlaces;
// Cubes with more points than this are taken one after the other, smaller ones by threads.
constexpr std::size_t kPointsOfTask = 32 * kFewPoints;
// A cube of kFewPoints voxels is five of them wide.
constexpr int kCurveHalvings = 3;
// Points in one place cannot be parted.
constexpr int kMostHalvings = 30;

using Weights = std::array<double, kPlaces>;

/// Where the places are along one direction of a cube from -1 to 1.
const Weights& places()
{
    static const Weights at = [] {
        Weights zeros{};
        for (std::size_t i = 0; i < kPlaces; ++i)
            zeros[i] = std::cos(M_PI * (2.0 * double(i) + 1) / (2.0 * kPlaces));
        return zeros;
    }();
    return at;
}

/// Lagrange's: how much the value at each place counts at `x`.
Weights weights_at(double x)
{
    const Weights& at = places();
    Weights weights{};
    for (std::size_t i = 0; i < kPlaces; ++i) {
        weights[i] = 1;
        for (std::size_t j = 0; j < kPlaces; ++j)
            if (j != i)
                weights[i] *= (x - at[j]) / (at[i] - at[j]);
    }
    return weights;
}

/// The field of what is far, known at the places of a cube.
struct FarField {
    Vec3d middle{0.0};
    double half = 1;
    std::array<float, kAllPlaces> values{};

    Vec3d place(std::size_t index) const
    {
        const Weights& at = places();
        return middle + half * Vec3d(at[index / (kPlaces * kPlaces)], at[index / kPlaces % kPlaces],
                                     at[index % kPlaces]);
    }
    float at(const Vec3d& point) const
    {
        const Vec3d x = (point - middle) / half;
        const Weights a = weights_at(x[0]), b = weights_at(x[1]), c = weights_at(x[2]);
        double sum = 0;
        for (std::size_t i = 0, k = 0; i < kPlaces; ++i)
            for (std::size_t j = 0; j < kPlaces; ++j, k += kPlaces)
                sum += a[i] * b[j] *
                       (c[0] * double(values[k]) + c[1] * double(values[k + 1]) +
                        c[2] * double(values[k + 2]) + c[3] * double(values[k + 3]));
        return float(sum);
    }
};

/// Which eighth of a cube a point is in: a bit for each axis, that of x the highest.
unsigned eighth_with(const Vec3d& point, const Vec3d& middle)
{
    return (point[0] < middle[0] ? 0U : 4U) + (point[1] < middle[1] ? 0U : 2U) +
           (point[2] < middle[2] ? 0U : 1U);
}

/// `middle`: of the cube; `half`: of the eighth.
Vec3d middle_of(unsigned eighth, const Vec3d& middle, double half)
{
    return middle + half * Vec3d(eighth & 4U ? 1 : -1, eighth & 2U ? 1 : -1, eighth & 1U ? 1 : -1);
}

/// A cube, its points, and what it was handed.
struct Cube {
    Vec3d middle;
    double half;
    std::size_t begin, end; ///< in the order of the points
    int halvings;
    FarField far;                        ///< its parent's
    std::vector<std::uint32_t> clusters; ///< those that are not far from its parent
};

class WindingField
{
public:
    WindingField(const WindingNumber& winding, const std::vector<Vec3d>& points)
        : winding_(winding), points_(points), order_(points.size()), turns_(points.size())
    {
        std::iota(order_.begin(), order_.end(), std::size_t(0));
    }

    std::vector<float> turns()
    {
        if (points_.empty() || winding_.nodes().empty())
            return std::move(turns_);
        std::vector<Cube> waiting{everything()}, tasks;
        while (!waiting.empty()) {
            Cube cube = std::move(waiting.back());
            waiting.pop_back();
            if (cube.end - cube.begin <= kPointsOfTask)
                tasks.push_back(std::move(cube));
            else
                part(cube, waiting);
        }
        for_each_index(
            tasks.size(), [&](std::size_t i) { finish(std::move(tasks[i])); }, 1);
        return std::move(turns_);
    }

private:
    Cube everything() const
    {
        Vec3d low = points_[0], high = low;
        for (const Vec3d& p : points_) {
            low = openvdb::math::minComponent(low, p);
            high = openvdb::math::maxComponent(high, p);
        }
        const Vec3d size = high - low;
        const double half = 0.5 * std::max({size[0], size[1], size[2]});
        Cube cube{0.5 * (low + high), half > 0 ? half : 1, 0, points_.size(), 0, {}, {0}};
        cube.far.middle = cube.middle;
        cube.far.half = cube.half;
        return cube;
    }

    void finish(Cube&& cube)
    {
        std::vector<Cube> waiting;
        waiting.push_back(std::move(cube));
        while (!waiting.empty()) {
            stop_if_stage_wants();
            const Cube next = std::move(waiting.back());
            waiting.pop_back();
            if (next.end - next.begin <= kFewPoints || next.halvings == kMostHalvings)
                add_up(next);
            else
                part(next, waiting);
        }
    }

    /// Where a point is along a curve through the cube that passes near points together (Morton
    /// 1966): each number of it is an eighth of the one before.
    static unsigned place_along_curve(const Cube& cube, const Vec3d& point)
    {
        Vec3d middle = cube.middle;
        double half = cube.half;
        unsigned place = 0;
        for (int halving = 0; halving < kCurveHalvings; ++halving) {
            const unsigned eighth = eighth_with(point, middle);
            half *= 0.5;
            middle = middle_of(eighth, middle, half);
            place = 8 * place + eighth;
        }
        return place;
    }

    /// In the order of the curve, those in one place of it by their own. Eight at a time are looked
    /// at together, and what is far from all eight costs less.
    void sort_along_curve(const Cube& cube)
    {
        std::vector<std::pair<unsigned, std::size_t>> places;
        places.reserve(cube.end - cube.begin);
        for (std::size_t i = cube.begin; i < cube.end; ++i)
            places.emplace_back(place_along_curve(cube, points_[order_[i]]), order_[i]);
        std::sort(places.begin(), places.end());
        for (std::size_t i = 0; i < places.size(); ++i)
            order_[cube.begin + i] = places[i].second;
    }

    /// The sums of a smallest cube.
    void add_up(const Cube& cube)
    {
        sort_along_curve(cube);
        std::vector<Vec3d> points(cube.end - cube.begin);
        std::vector<float> near(points.size());
        for (std::size_t i = 0; i < points.size(); ++i)
            points[i] = points_[order_[cube.begin + i]];
        winding_.around(cube.clusters, points.data(), points.size(), near.data());
        for (std::size_t i = 0; i < points.size(); ++i)
            turns_[order_[cube.begin + i]] = near[i] + cube.far.at(points[i]);
    }

    /// Adds the cube's eighths that have points.
    void part(const Cube& cube, std::vector<Cube>& eighths)
    {
        FarField far;
        far.middle = cube.middle;
        far.half = cube.half;
        const std::vector<std::uint32_t> rest = sum_up_far(cube, far);
        const auto first = order_.begin() + std::ptrdiff_t(cube.begin);
        const auto octant = [&](std::size_t index) {
            return eighth_with(points_[index], cube.middle);
        };
        std::array<std::size_t, 9> begins{};
        for (std::size_t i = cube.begin; i < cube.end; ++i)
            ++begins[octant(order_[i]) + 1];
        std::partial_sum(begins.begin(), begins.end(), begins.begin());
        std::vector<std::size_t> sorted(cube.end - cube.begin);
        std::array<std::size_t, 9> next = begins;
        for (std::size_t i = cube.begin; i < cube.end; ++i)
            sorted[next[octant(order_[i])]++] = order_[i];
        std::copy(sorted.begin(), sorted.end(), first);
        for (unsigned o = 0; o < 8; ++o) {
            if (begins[o] == begins[o + 1])
                continue;
            const double half = 0.5 * cube.half;
            eighths.push_back({middle_of(o, cube.middle, half), half, cube.begin + begins[o],
                               cube.begin + begins[o + 1], cube.halvings + 1, far, rest});
        }
    }

    /// The parent's far field with that of the cube's own far clusters; what is not far.
    std::vector<std::uint32_t> sum_up_far(const Cube& cube, FarField& far) const
    {
        std::vector<std::uint32_t> open = cube.clusters, rest;
        std::vector<FarCluster> clusters;
        while (!open.empty()) {
            const std::uint32_t index = open.back();
            open.pop_back();
            const WindingNumber::Node& node = winding_.nodes()[index];
            const Vec3d to = node.centre - cube.middle;
            const double distance = WindingNumber::kFar * node.radius + kFarHalves * cube.half;
            if (to.lengthSqr() > distance * distance) {
                const Vec3d& n = node.area_normal;
                clusters.push_back({{float(to[0]), float(to[1]), float(to[2])},
                                    {float(n[0]), float(n[1]), float(n[2])}});
            } else if (node.right == 0 || node.radius <= cube.half) {
                rest.push_back(index); // small beside the cube: left for its eighths
            } else {
                open.push_back(node.right);
                open.push_back(index + 1);
            }
        }
        for (std::size_t begin = 0; begin < kAllPlaces; begin += kLanes) {
            EightPoints eight;
            for (std::size_t i = 0; i < kLanes; ++i) {
                const Vec3d p = far.place(begin + i) - cube.middle;
                eight.x[i] = float(p[0]), eight.y[i] = float(p[1]), eight.z[i] = float(p[2]);
            }
            alignas(kLanesAlignment) std::array<float, kLanes> turns;
            turns_around(clusters.data(), clusters.size(), nullptr, 0, eight, turns);
            for (std::size_t i = 0; i < kLanes; ++i)
                far.values[begin + i] = turns[i] + cube.far.at(far.place(begin + i));
        }
        return rest;
    }

    const WindingNumber& winding_;
    const std::vector<Vec3d>& points_;
    std::vector<std::size_t> order_;
    std::vector<float> turns_;
};

} // namespace

std::vector<float> turns_at(const WindingNumber& winding, const std::vector<Vec3d>& points)
{
    return WindingField(winding, points).turns();
}

} // namespace vdb_shell
