// SPDX-License-Identifier: Apache-2.0
#include "shapes/bones.h"

#include <cmath>
#include <cstdint>
#include <vector>

namespace vdb_shell::samples
{

namespace
{

using openvdb::Vec3d;

constexpr int kAround = 12;    // corners of a ring
constexpr int kCapRings = 4;   // of each half ball at an end, its pole counted
constexpr int kShaftRings = 5; // between the ends

/// From one end to the other; the shaft is thinner than the ends by `waist`.
struct BoneShape {
    Vec3d from, to;
    double radius_from, radius_to, waist;
};

/// Rings along a bone: how far along its axis, and how wide.
struct Ring {
    double along, radius;
};

std::vector<Ring> rings_of(const BoneShape& bone)
{
    const double length = (bone.to - bone.from).length();
    std::vector<Ring> rings;
    for (int i = 1; i < kCapRings; ++i) {
        const double angle = 0.5 * kPi * i / kCapRings;
        rings.push_back({-bone.radius_from * std::cos(angle), bone.radius_from * std::sin(angle)});
    }
    for (int i = 0; i <= kShaftRings; ++i) {
        const double t = double(i) / kShaftRings;
        const double straight = bone.radius_from + t * (bone.radius_to - bone.radius_from);
        rings.push_back({t * length, straight * (1 - bone.waist * 4 * t * (1 - t))});
    }
    for (int i = kCapRings - 1; i > 0; --i) {
        const double angle = 0.5 * kPi * i / kCapRings;
        rings.push_back(
            {length + bone.radius_to * std::cos(angle), bone.radius_to * std::sin(angle)});
    }
    return rings;
}

void add_bone(const BoneShape& bone, PolygonMesh& mesh)
{
    const Vec3d along = (bone.to - bone.from).unit();
    const Vec3d side = (std::abs(along[0]) < 0.7 ? Vec3d(1, 0, 0) : Vec3d(0, 1, 0)).cross(along);
    const Vec3d u = side.unit(), v = along.cross(u);
    const std::vector<Ring> rings = rings_of(bone);
    const auto first = static_cast<std::uint32_t>(mesh.points.size());
    mesh.points.push_back(bone.from - bone.radius_from * along);
    for (const Ring& ring : rings)
        for (int i = 0; i < kAround; ++i) {
            const double angle = 2 * kPi * i / kAround;
            mesh.points.push_back(bone.from + ring.along * along +
                                  ring.radius * (std::cos(angle) * u + std::sin(angle) * v));
        }
    const auto last = static_cast<std::uint32_t>(mesh.points.size());
    mesh.points.push_back(bone.to + bone.radius_to * along);
    const auto corner = [&](std::size_t ring, int i) {
        return first + 1 + static_cast<std::uint32_t>(ring * kAround) +
               static_cast<std::uint32_t>(i % kAround);
    };
    for (int i = 0; i < kAround; ++i) {
        mesh.faces.push_back({first, corner(0, i + 1), corner(0, i)});
        for (std::size_t r = 0; r + 1 < rings.size(); ++r)
            mesh.faces.push_back(
                {corner(r, i), corner(r, i + 1), corner(r + 1, i + 1), corner(r + 1, i)});
        mesh.faces.push_back({last, corner(rings.size() - 1, i), corner(rings.size() - 1, i + 1)});
    }
}

/// The joints are those of the creature's legs (creature_field.cpp), a little apart.
void add_leg(double side, bool front, PolygonMesh& mesh)
{
    const double z = (front ? 0.40 : -0.46) + (front ? 0.07 : -0.06) * side;
    const Vec3d hip(0.25 * side, front ? 0.52 : 0.50, front ? 0.34 : -0.44);
    const Vec3d knee(0.33 * side, 0.30, z + (front ? -0.05 : 0.07));
    const Vec3d ankle(0.32 * side, 0.11, z);
    constexpr double kGap = 0.055;
    const Vec3d thigh = (knee - hip).unit(), shin = (ankle - knee).unit();
    add_bone({hip, knee - kGap * thigh, 0.07, 0.045, 0.3}, mesh);
    add_bone({knee + kGap * shin, ankle, 0.04, 0.035, 0.25}, mesh);
}

} // namespace

PolygonMesh creature_bones()
{
    PolygonMesh mesh;
    add_bone({{0.05, 1.20, 0.76}, {0.08, 1.22, 0.90}, 0.15, 0.1, 0.0}, mesh);  // skull
    add_bone({{0.01, 0.97, 0.52}, {0.0, 0.78, 0.30}, 0.07, 0.07, 0.3}, mesh);  // neck
    add_bone({{0.0, 0.72, 0.14}, {0.0, 0.68, -0.18}, 0.09, 0.09, 0.3}, mesh);  // back
    add_bone({{0.0, 0.66, -0.38}, {0.0, 0.57, -0.62}, 0.09, 0.06, 0.2}, mesh); // rump
    add_bone({{0.035, 0.48, -0.84}, {0.10, 0.46, -1.08}, 0.045, 0.035, 0.2}, mesh);
    add_bone({{0.18, 0.54, -1.26}, {0.24, 0.66, -1.36}, 0.028, 0.022, 0.2}, mesh);
    for (const double side : {-1.0, 1.0})
        for (const bool front : {false, true})
            add_leg(side, front, mesh);
    return mesh;
}

} // namespace vdb_shell::samples
