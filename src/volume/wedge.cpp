// SPDX-License-Identifier: Apache-2.0

#include "volume/wedge.h"

#include <algorithm>
#include <cmath>

namespace vdb_shell
{
namespace
{

using openvdb::Mat3d;
using openvdb::Vec3d;

struct Derivatives {
    Vec3d by_u, by_v, by_t;
};

Derivatives derivatives(const Wedge& w, const WedgePlace& at)
{
    const double t = at[2];
    const Vec3d corner = w.outer[0] + t * (w.inner[0] - w.outer[0]);
    const Vec3d d = w.inner[0] - w.outer[0];
    return {w.outer[1] + t * (w.inner[1] - w.outer[1]) - corner,
            w.outer[2] + t * (w.inner[2] - w.outer[2]) - corner,
            d + at[0] * (w.inner[1] - w.outer[1] - d) + at[1] * (w.inner[2] - w.outer[2] - d)};
}

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
    const Derivatives d = derivatives(wedge, at);
    return {d.by_u, d.by_v, d.by_t, false};
}

std::optional<WedgePlace> place_of(const Wedge& w, const Vec3d& point, const WedgePlace& guess)
{
    // Doubles give twelve digits beside the prism's size; Newton's steps double them, so there are
    // four to six.
    constexpr int kMostSteps = 16;
    constexpr double kExact = 1e-12, kFarOutside = 1.0;
    const double size =
        std::max((w.outer[1] - w.outer[0]).lengthSqr(), (w.inner[0] - w.outer[0]).lengthSqr()) +
        (w.outer[2] - w.outer[0]).lengthSqr();
    WedgePlace at = guess;
    for (int step = 0; step < kMostSteps; ++step) {
        const Vec3d missing = point - point_of(w, at);
        if (missing.lengthSqr() <= kExact * kExact * size)
            return at;
        const Derivatives d = derivatives(w, at);
        const Vec3d vt = d.by_v.cross(d.by_t);
        const double det = d.by_u.dot(vt);
        if (det == 0.0)
            return {};
        at += Vec3d(missing.dot(vt), missing.dot(d.by_t.cross(d.by_u)),
                    missing.dot(d.by_u.cross(d.by_v))) /
              det;
        if (!(outside_of(at) < kFarOutside))
            return {};
    }
    return {};
}

double outside_of(const WedgePlace& at)
{
    return std::max({-at[0], -at[1], at[0] + at[1] - 1.0, -at[2], at[2] - 1.0});
}

} // namespace vdb_shell
