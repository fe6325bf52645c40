// SPDX-License-Identifier: Apache-2.0
#include "shapes/motions.h"

#include "shapes/polygon_mesh.h"

#include <openvdb/math/Mat3.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace vdb_shell::samples
{
namespace
{

using openvdb::Vec3d;
using openvdb::Vec3s;
using Matrix = openvdb::math::Mat3<double>;

/// At rest from one joint to the next; a child turns about its `from`, carried by its parent.
struct Bone {
    int parent;
    Vec3d from, to;
    double radius; ///< of the flesh around it: how far its influence reaches
};

/// The joints are those of the creature's parts (creature_field.cpp). Legs are three bones each,
/// left and right, front and hind.
std::vector<Bone> skeleton()
{
    std::vector<Bone> bones{{-1, {0, 0.64, -0.30}, {0, 0.58, -0.58}, 0.30},      // 0 rump
                            {0, {0, 0.64, -0.30}, {0, 0.68, 0.10}, 0.34},        // 1 back
                            {1, {0, 0.68, 0.10}, {0, 0.80, 0.46}, 0.32},         // 2 chest
                            {2, {0, 0.80, 0.46}, {0, 1.04, 0.66}, 0.22},         // 3 neck
                            {3, {0, 1.06, 0.68}, {0.1, 1.16, 1.05}, 0.36},       // 4 head
                            {4, {0.10, 1.40, 0.66}, {0.52, 1.66, 0.55}, 0.15},   // 5 left ear
                            {4, {-0.33, 1.40, 0.79}, {-0.80, 1.56, 0.80}, 0.15}, // 6 right ear
                            {0, {0.00, 0.56, -0.62}, {0.03, 0.47, -0.86}, 0.16}, // 7 to 11 tail
                            {7, {0.03, 0.47, -0.86}, {0.10, 0.46, -1.10}, 0.12},
                            {8, {0.10, 0.46, -1.10}, {0.19, 0.55, -1.30}, 0.09},
                            {9, {0.19, 0.55, -1.30}, {0.28, 0.80, -1.42}, 0.07},
                            {10, {0.28, 0.80, -1.42}, {0.26, 1.22, -1.33}, 0.07}};
    for (const bool front : {true, false})
        for (const double side : {1.0, -1.0}) {
            const double z = front ? 0.40 + 0.07 * side : -0.46 - 0.06 * side;
            const int body = front ? 2 : 0, first = static_cast<int>(bones.size());
            const Vec3d hip(0.25 * side, front ? 0.52 : 0.50, front ? 0.34 : -0.44);
            const Vec3d knee(0.33 * side, 0.30, z + (front ? -0.05 : 0.07));
            const Vec3d ankle(0.32 * side, 0.13, z);
            bones.push_back({body, hip, knee, 0.17});
            bones.push_back({first, knee, ankle, 0.11});
            bones.push_back({first + 1, ankle, {0.33 * side, 0.07, z + 0.22}, 0.11});
        }
    return bones;
}

struct Turn {
    Vec3d axis;
    double degrees;
};

/// How far each bone turns against its parent. A knee bends while its foot is in the air.
std::vector<Turn> turns_at(double phase)
{
    const double angle = 2 * kPi * phase;
    const Vec3d x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
    std::vector<Turn> turns{{y, 4 * std::sin(angle)},      {y, -6 * std::sin(angle)},
                            {y, 5 * std::sin(angle)},      {x, 6 * std::sin(2 * angle)},
                            {x, -9 * std::sin(2 * angle)}, {z, 20 * std::sin(2 * angle + 1)},
                            {z, -20 * std::sin(2 * angle)}};
    for (int i = 0; i < 5; ++i)
        turns.push_back({y, 14 * std::sin(angle - 0.7 * i)});
    // Diagonal legs go together: left front, right front, left hind, right hind.
    for (const double begin : {0.0, 0.5, 0.5, 0.0}) {
        const double step = angle + 2 * kPi * begin;
        const double lifted = std::max(0.0, std::cos(step));
        turns.push_back({x, -28 * std::sin(step) - 25 * lifted});
        turns.push_back({x, 10 + 120 * std::pow(lifted, 4)});
        turns.push_back({x, -35 * std::pow(lifted, 4)});
    }
    return turns;
}

struct Motion {
    Matrix turn = Matrix::identity();
    Vec3d shift{0.0};
    Vec3d operator()(const Vec3d& p) const { return turn * p + shift; }
};

/// In space, of each bone: about its joint, where its parent has carried that.
std::vector<Motion> motions_of(const std::vector<Bone>& bones, const std::vector<Turn>& turns)
{
    std::vector<Motion> motions;
    for (std::size_t b = 0; b < bones.size(); ++b) {
        const Motion parent =
            bones[b].parent < 0 ? Motion() : motions[static_cast<std::size_t>(bones[b].parent)];
        // OpenVDB's rotation matrices act on rows.
        const Matrix own =
            openvdb::math::rotation<Matrix>(turns[b].axis, turns[b].degrees * kPi / 180)
                .transpose();
        Motion motion;
        motion.turn = parent.turn * own;
        motion.shift = parent(bones[b].from) - motion.turn * bones[b].from;
        motions.push_back(motion);
    }
    return motions;
}

/// Falls off with the distance to the bone in units of its radius, so that seams are as wide as the
/// flesh is thick.
double weight(const Bone& bone, const Vec3d& p)
{
    const Vec3d along = bone.to - bone.from;
    const double t = std::clamp((p - bone.from).dot(along) / along.lengthSqr(), 0.0, 1.0);
    const double distance = (p - bone.from - t * along).length() / bone.radius;
    return std::pow(distance + 0.1, -6);
}

int longest_axis(const Vec3d& size)
{
    return size[0] >= size[1] ? (size[0] >= size[2] ? 0 : 2) : (size[1] >= size[2] ? 1 : 2);
}

/// Calls move(point from the middle, share of the length from the middle, axis) for each.
template <typename Move>
std::vector<Vec3s> along_axis(const std::vector<Vec3s>& rest, const Move& move)
{
    Vec3d low(1e30), high(-1e30);
    for (const Vec3s& p : rest) {
        low = openvdb::math::minComponent(low, Vec3d(p));
        high = openvdb::math::maxComponent(high, Vec3d(p));
    }
    const Vec3d middle = 0.5 * (low + high);
    const int axis = longest_axis(high - low);
    std::vector<Vec3s> posed;
    for (const Vec3s& p : rest) {
        const Vec3d q = Vec3d(p) - middle;
        posed.push_back(Vec3s(middle + move(q, q[axis] / (high - low)[axis], axis)));
    }
    return posed;
}

} // namespace

std::vector<Vec3s> walk(const std::vector<Vec3s>& rest, double phase)
{
    const std::vector<Bone> bones = skeleton();
    const std::vector<Motion> motions = motions_of(bones, turns_at(phase));
    std::vector<Vec3s> posed;
    for (const Vec3s& point : rest) {
        const Vec3d p(point);
        Vec3d sum(0.0);
        double weights = 0;
        for (std::size_t b = 0; b < bones.size(); ++b) {
            const double w = weight(bones[b], p);
            sum += w * motions[b](p);
            weights += w;
        }
        posed.push_back(Vec3s(sum / weights));
    }
    return posed;
}

std::vector<Vec3s> twist(const std::vector<Vec3s>& rest, double degrees, double phase)
{
    return along_axis(rest, [&](const Vec3d& q, double share, int axis) {
        const double angle = degrees * kPi / 180 * phase * share;
        const int u = (axis + 1) % 3, v = (axis + 2) % 3;
        Vec3d turned = q;
        turned[u] = std::cos(angle) * q[u] - std::sin(angle) * q[v];
        turned[v] = std::sin(angle) * q[u] + std::cos(angle) * q[v];
        return turned;
    });
}

std::vector<Vec3s> squash(const std::vector<Vec3s>& rest, double share, double phase)
{
    const double length = 1 + phase * (share - 1);
    return along_axis(rest, [&](const Vec3d& q, double, int axis) {
        Vec3d squashed = q / std::sqrt(length);
        squashed[axis] = q[axis] * length;
        return squashed;
    });
}

std::vector<Vec3s> bend(const std::vector<Vec3s>& rest, double degrees, double phase)
{
    const double whole = degrees * kPi / 180 * phase;
    if (whole == 0)
        return rest;
    return along_axis(rest, [&](const Vec3d& q, double share, int axis) {
        if (share == 0)
            return q;
        const double angle = whole * share, radius = q[axis] / angle; // length over whole angle
        Vec3d bent = q;
        bent[axis] = (radius - q[1]) * std::sin(angle);
        bent[1] = radius - (radius - q[1]) * std::cos(angle);
        return bent;
    });
}

} // namespace vdb_shell::samples
