// SPDX-License-Identifier: Apache-2.0

// Takes a shell at rest, a pose in the making and one of its points. Gives what that point wants
// and its best step. Second derivatives of the smoothed determinant are left out: they alone could
// make the Hessian negative.

#include "pose/point_energy.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vdb_shell
{
namespace
{

using openvdb::Vec3d;
using Parts = RestShell::Parts;

/// Determinants are relative to rest, where they are 1. Below the first a tet counts by the measure
/// that is finite for inverted ones, which is smoothed over the second.
constexpr double kSound = 0.02, kSmoothing = 0.01;
/// Smoothing grows with how far a tet is inverted, by a fifth of it, so that the slope back does
/// not fade the farther it has turned. Of the squares.
constexpr double kSmoothingOfInverted = 0.04;

struct Jacobian {
    Vec3d row[3];
    double determinant() const { return row[0].dot(row[1].cross(row[2])); }
    double squared() const { return row[0].lengthSqr() + row[1].lengthSqr() + row[2].lengthSqr(); }
};

Jacobian jacobian(const Parts& parts, const std::vector<Vec3d>& place, std::size_t tet)
{
    Jacobian j;
    for (Vec3d& row : j.row)
        row = Vec3d(0.0);
    for (int i = 0; i < 4; ++i) {
        const Vec3d& p = place[parts.all[tet][i]];
        const Vec3d& g = parts.rest_tet[tet].gradient[static_cast<std::size_t>(i)];
        for (int k = 0; k < 3; ++k)
            j.row[k] += p[k] * g;
    }
    return j;
}

/// What stands for the determinant: itself, or a positive number where the tet is not sound.
struct Positive {
    double value, slope;
};
Positive positive(double determinant, double smoothing)
{
    if (!(smoothing > 0))
        return {determinant, 1};
    const double root = std::sqrt(determinant * determinant + smoothing);
    // The second form has no difference of near numbers where the determinant is negative.
    const double value =
        determinant >= 0 ? 0.5 * (determinant + root) : 0.5 * smoothing / (root - determinant);
    return {value, value / root};
}

} // namespace

PointEnergy::CornerTet PointEnergy::corner_tet(const Parts& parts, const std::vector<Vec3d>& place,
                                               std::size_t tet, std::uint32_t point)
{
    const Jacobian j = jacobian(parts, place, tet);
    int corner = 0;
    while (parts.all[tet][corner] != point)
        ++corner;
    const Vec3d& g = parts.rest_tet[tet].gradient[static_cast<std::size_t>(corner)];
    CornerTet made;
    made.norm = j.squared();
    made.g2 = g.lengthSqr();
    for (int k = 0; k < 3; ++k)
        made.b[k] = j.row[k].dot(g);
    made.determinant = j.determinant();
    // The determinant's gradient: its cofactors times g.
    made.n = Vec3d(j.row[1].cross(j.row[2]).dot(g), j.row[2].cross(j.row[0]).dot(g),
                   j.row[0].cross(j.row[1]).dot(g));
    if (!(made.determinant > kSound)) {
        const double below = std::min(made.determinant, 0.0);
        made.smoothing = kSmoothing * kSmoothing + kSmoothingOfInverted * below * below;
    }
    return made;
}

PointEnergy::PointEnergy(const Parts& parts, const PoseState& state, std::uint32_t point,
                         double bound, double weight_of_unsound)
    : bound_(bound), weight_of_unsound_(weight_of_unsound),
      to_carried_(state.carried[point] - state.place[point]),
      tether_(1 / (parts.spacing[point] * parts.spacing[point]))
{
    for (std::uint32_t k = parts.first[point]; k < parts.first[point + 1]; ++k)
        if (parts.rest_tet[parts.incident[k]].measurable())
            tets_.push_back(corner_tet(parts, state.place, parts.incident[k], point));
}

bool PointEnergy::sound() const
{
    return std::all_of(tets_.begin(), tets_.end(), [&](const CornerTet& tet) {
        return !(tet.smoothing > 0) &&
               tet.norm <= 3 * bound_ * std::cbrt(tet.determinant * tet.determinant);
    });
}

void PointEnergy::add_half_space(const Vec3d& n, double least, double weight)
{
    half_spaces_.push_back({n, least, weight * tether_});
}

double PointEnergy::room_for(const Vec3d& step) const
{
    constexpr double kShareOfWay = 0.9;
    double share = 1;
    for (const CornerTet& tet : tets_) {
        const double along = tet.n.dot(step);
        if (tet.determinant > 0 && along < 0)
            share = std::min(share, -kShareOfWay * tet.determinant / along);
    }
    return share;
}

double PointEnergy::at(const Vec3d& x) const
{
    double sum = 0.5 * tether_ * (x - to_carried_).lengthSqr();
    for (const HalfSpace& half : half_spaces_) {
        const double missing = std::max(0.0, half.least - half.n.dot(x));
        sum += 0.5 * half.weight * missing * missing;
    }
    for (const CornerTet& tet : tets_) {
        const Positive d = positive(tet.determinant + tet.n.dot(x), tet.smoothing);
        if (!(d.value > 0))
            return std::numeric_limits<double>::infinity();
        const double norm = tet.norm + 2 * tet.b.dot(x) + tet.g2 * x.lengthSqr();
        const double over = norm / (3 * std::cbrt(d.value * d.value)) - bound_;
        if (over > 0)
            sum += weight_of(tet) * over * over;
    }
    return sum;
}

bool PointEnergy::newton(Vec3d& x) const
{
    Vec3d down = tether_ * to_carried_;
    Symmetric hessian;
    hessian.add_identity(tether_);
    for (const HalfSpace& half : half_spaces_)
        if (half.least > 0) {
            down += half.weight * half.least * half.n;
            hessian.add(half.weight, half.n);
        }
    for (const CornerTet& tet : tets_)
        add(tet, down, hessian);
    return solve_positive(hessian, down, x);
}

void PointEnergy::add(const CornerTet& tet, Vec3d& down, Symmetric& hessian) const
{
    const Positive d = positive(tet.determinant, tet.smoothing);
    const double power = 1 / (3 * std::cbrt(d.value * d.value));
    const double over = tet.norm * power - bound_;
    if (!(over > 0))
        return;
    const Vec3d of_norm = 2.0 * tet.b;
    const double by_value = -2.0 / 3.0 * power / d.value * d.slope;
    const Vec3d gradient = power * of_norm + tet.norm * by_value * tet.n;
    const double twice = 2 * weight_of(tet);
    down -= twice * over * gradient;
    hessian.add(twice, gradient);
    hessian.add_identity(twice * over * 2 * tet.g2 * power);
    hessian.add(twice * over * by_value, of_norm, tet.n);
    hessian.add(twice * over * tet.norm * 10.0 / 9.0 * power / (d.value * d.value) * d.slope *
                    d.slope,
                tet.n);
}

Vec3d carried_normal(const Parts& parts, const PoseState& state, std::size_t tet, const Vec3d& n)
{
    // Times the cofactors of the map.
    const Jacobian j = jacobian(parts, state.place, tet);
    return {j.row[1].cross(j.row[2]).dot(n), j.row[2].cross(j.row[0]).dot(n),
            j.row[0].cross(j.row[1]).dot(n)};
}

double distortion(const Parts& parts, const PoseState& state, std::size_t tet)
{
    const Jacobian j = jacobian(parts, state.place, tet);
    const double determinant = j.determinant();
    if (!parts.rest_tet[tet].measurable())
        return 1;
    return determinant > 0 ? j.squared() / (3 * std::cbrt(determinant * determinant))
                           : std::numeric_limits<double>::infinity();
}

} // namespace vdb_shell
