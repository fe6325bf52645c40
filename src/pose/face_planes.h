// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pose/face_contacts.h"
#include "pose/point_energy.h"

#include <map>
#include <vector>

namespace vdb_shell
{

/// Planes between pairs of free faces, and on which side of them points have to be. All points may
/// move at the same time: each has its part of what is missing, or to spare.
class FacePlanes
{
public:
    /// Keeps references. Precondition: a tapered shell.
    FacePlanes(const RestShell::Parts& parts, const PoseState& state,
               const std::vector<openvdb::Vec3s>& skin);

    /// Adds pairs to those that are kept apart.
    void keep_apart(const std::vector<FacePair>& pairs);

    /// Puts the planes of all pairs where they belong with the points where they are now.
    void put();

    /// The point is on its side where n.x >= least.
    struct Side {
        openvdb::Vec3d n;
        double least;
    };
    const std::vector<Side>& of(std::uint32_t point) const { return sides_[point]; }

private:
    struct Plane {
        openvdb::Vec3d across{0.0}; ///< of unit length, from the first face to the second
        double room = 0;            ///< between them, or on either side of what they share
    };
    struct Common;
    Common common_of(const FacePair& pair) const;
    Plane plane_at_rest(const FacePair& pair, const Common& common) const;
    openvdb::Vec3d turned(const FacePair& pair, const Plane& at_rest) const;
    double room_for(const FacePair& pair, const Plane& at_rest) const;
    double share_of(double room, double spacing) const;
    void put_wedge(const FacePair& pair, const Common& common);
    void put_at_corner(const FacePair& pair, const Common& common, const openvdb::Vec3d& n,
                       double room);
    void put_between(const FacePair& pair, const openvdb::Vec3d& n, double room);
    void push(std::uint32_t point, const openvdb::Vec3d& towards, double by);

    openvdb::Vec3d rest(std::uint32_t point) const
    {
        return openvdb::Vec3d(parts_.free.points[point]);
    }
    openvdb::Vec3d now(std::uint32_t point) const
    {
        return point < state_.place.size() ? state_.place[point]
                                           : lone_[point - state_.place.size()];
    }
    bool moves(std::uint32_t point) const
    {
        return point < parts_.skin_vertex.size() &&
               parts_.skin_vertex[point] == RestShell::Parts::kFree;
    }

    const RestShell::Parts& parts_;
    const PoseState& state_;
    std::vector<openvdb::Vec3d> lone_; ///< outer vertices that no tet has
    double rounding_ = 0;              ///< of a coordinate to float32, at most
    std::map<FacePair, Plane> at_rest_;
    std::vector<std::vector<Side>> sides_; ///< by point
};

} // namespace vdb_shell
