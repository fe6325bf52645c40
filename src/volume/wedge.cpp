// SPDX-License-Identifier: Apache-2.0

#include "volume/wedge.h"

#include <algorithm>
#include <cmath>

// A prism with bilinear sides, as a polynomial of three coordinates, and its inverse by Newton's
// method. All is in doubles: the result is a place and proves nothing (docs/theory.md, "Coordinates
// of a shell").
namespace vdb_shell
{
namespace
{

using openvdb::Mat3d;
using openvdb::Vec3d;

/// By the two weights and by the share inwards.
struct Derivatives {
    Vec3d by_u, by_v, by_t;
};

/// X(u, v, t) = a + u b + v c + t (d + u e + v f), from corner 0 of the outer triangle.
class Polynomial
{
public:
    explicit Polynomial(const Wedge& w)
        : a_(w.outer[0]), b_(w.outer[1] - a_), c_(w.outer[2] - a_), d_(w.inner[0] - a_),
          e_(w.inner[1] - w.outer[1] - d_), f_(w.inner[2] - w.outer[2] - d_)
    {
    }

    Derivatives derivatives(const WedgePlace& at) const
    {
        return {b_ + at[2] * e_, c_ + at[2] * f_, d_ + at[0] * e_ + at[1] * f_};
    }
    /// `by` are the derivatives there.
    Vec3d point(const WedgePlace& at, const Derivatives& by) const
    {
        return a_ + at[0] * b_ + at[1] * c_ + at[2] * by.by_t;
    }
    /// Of two sides of the outer triangle and a pillar.
    double squared_size() const
    {
        return std::max(b_.lengthSqr(), d_.lengthSqr()) + c_.lengthSqr();
    }

private:
    Vec3d a_, b_, c_, d_, e_, f_;
};

} // namespace

bool has_positive_jacobian(const Wedge& w)
{
    bool positive = false;
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
        const Vec3d d = w.inner[i] - w.outer[i];
        // D_i of the theory, and what rounding may make of it.
        double size = 0;
        const auto six_volumes = [&](const Vec3d& p, const Vec3d& q) {
            const Vec3d a = p - w.outer[i], b = q - w.outer[i];
            size = std::max(size, std::sqrt(d.lengthSqr() * a.lengthSqr() * b.lengthSqr()));
            return -d.dot(a.cross(b));
        };
        // Nine numbers in all, three for each corner. The middle one is twice the Bernstein
        // coefficient; only its sign counts.
        const double first = six_volumes(w.outer[j], w.outer[k]);
        const double between =
            six_volumes(w.outer[j], w.inner[k]) + six_volumes(w.inner[j], w.outer[k]);
        const double last = six_volumes(w.inner[j], w.inner[k]);
        constexpr double kRounding = 1e-12;
        if (std::min({first, between, last}) < -kRounding * size)
            return false;
        positive = positive || std::max({first, between, last}) > kRounding * size;
    }
    return positive;
}

Vec3d point_of(const Wedge& w, const WedgePlace& at)
{
    const Vec3d weight(1.0 - at[0] - at[1], at[0], at[1]);
    Vec3d point(0.0);
    for (std::size_t i = 0; i < 3; ++i)
        point += weight[int(i)] * (w.outer[i] + at[2] * (w.inner[i] - w.outer[i]));
    return point;
}

Mat3d jacobian_of(const Wedge& wedge, const WedgePlace& at)
{
    const Derivatives d = Polynomial(wedge).derivatives(at);
    return {d.by_u, d.by_v, d.by_t, false};
}

std::optional<WedgePlace> place_of(const Wedge& wedge, const Vec3d& point, const WedgePlace& guess)
{
    // Doubles give twelve digits beside the prism's size. Newton's steps double the digits, so
    // there are three to five, and after one that changes places by a ten-millionth there is
    // nothing left to look at.
    constexpr int kMostSteps = 16;
    constexpr double kExact = 1e-12, kLastStep = 1e-7, kFarOutside = 1.0;
    const Polynomial x(wedge);
    const double size = x.squared_size();
    WedgePlace at = guess;
    for (int step = 0; step < kMostSteps; ++step) {
        const Derivatives d = x.derivatives(at);
        const Vec3d missing = point - x.point(at, d);
        const double squared = missing.lengthSqr();
        if (squared <= kExact * kExact * size)
            return at;
        const Vec3d vt = d.by_v.cross(d.by_t);
        const double det = d.by_u.dot(vt);
        if (det == 0.0)
            return {};
        const Vec3d change = Vec3d(missing.dot(vt), missing.dot(d.by_t.cross(d.by_u)),
                                   missing.dot(d.by_u.cross(d.by_v))) /
                             det;
        at += change;
        // Far outside the map may fold over, and Newton's method would find a place that is none.
        // The comparison is turned round so that it also ends at what is no number.
        if (!(outside_of(at) < kFarOutside))
            return {};
        // What is left of the second order is a product of two changes and a side.
        if (change.lengthSqr() <= kLastStep * kLastStep)
            return at;
    }
    return {};
}

double outside_of(const WedgePlace& at)
{
    return std::max({-at[0], -at[1], at[0] + at[1] - 1.0, -at[2], at[2] - 1.0});
}

} // namespace vdb_shell
