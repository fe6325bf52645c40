// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/symmetric.h"
#include "pose/rest_parts.h"

#include <cstdint>
#include <vector>

namespace vdb_shell
{

/// A pose in the making: where points are, and where the skin would carry them.
struct PoseState {
    std::vector<openvdb::Vec3d> place, carried; ///< by point
};

/// How a plane that is tied to the tet turns, whose unit normal at rest is n: not of unit length.
openvdb::Vec3d carried_normal(const RestShell::Parts& parts, const PoseState& state,
                              std::size_t tet, const openvdb::Vec3d& n);

/// Distortion as PoseOptions::most_distortion measures it; infinite for a tet that is not positive.
double distortion(const RestShell::Parts& parts, const PoseState& state, std::size_t tet);

/// What a free point wants, as a function of its place: half its squared distance from where it is
/// carried, in units of its spacing, and the squares by which the tets around it are distorted
/// beyond a bound. Tets that are not positive count by a measure that stays finite there (Garanzha
/// et al. 2021, "Foldover-free maps in 50 lines of code"). With one corner moving, a tet's
/// distortion is a convex function of it (squared norm of the Jacobian over its determinant to 2/3,
/// the determinant being affine), so Newton's steps have a positive Hessian and descend.
class PointEnergy
{
public:
    PointEnergy(const RestShell::Parts& parts, const PoseState& state, std::uint32_t point,
                double bound, double weight_of_unsound = 1);

    /// Whether every tet is within the bound.
    bool sound() const;

    /// A half-space that the point should be in: where n.step >= least, n of unit length. What is
    /// missing counts by its square, in units of the spacing, times the weight.
    void add_half_space(const openvdb::Vec3d& n, double least, double weight);

    /// The largest share of a step, at most 1, that takes no positive tet near to being flat.
    double room_for(const openvdb::Vec3d& step) const;

    /// At a step from where the point is.
    double at(const openvdb::Vec3d& step) const;

    /// Newton's step; false where there is none.
    bool newton(openvdb::Vec3d& step) const;

private:
    /// A tet as a function of one of its corners: squared norm = |g|^2 |x|^2 + 2 x.b + c,
    /// determinant = d + n.x, both about the corner's place.
    struct CornerTet {
        double norm = 0, g2 = 0;
        openvdb::Vec3d b{0.0}; ///< half the gradient of the norm
        double determinant = 1;
        openvdb::Vec3d n{0.0};
        double smoothing = 0; ///< squared; 0 for a sound tet
    };
    static CornerTet corner_tet(const RestShell::Parts& parts,
                                const std::vector<openvdb::Vec3d>& place, std::size_t tet,
                                std::uint32_t point);
    void add(const CornerTet& tet, openvdb::Vec3d& down, Symmetric& hessian) const;
    double weight_of(const CornerTet& tet) const
    {
        return tet.smoothing > 0 ? weight_of_unsound_ : 1;
    }

    double bound_, weight_of_unsound_;
    openvdb::Vec3d to_carried_;
    double tether_;
    std::vector<CornerTet> tets_;
    struct HalfSpace {
        openvdb::Vec3d n;
        double least, weight;
    };
    std::vector<HalfSpace> half_spaces_;
};

} // namespace vdb_shell
