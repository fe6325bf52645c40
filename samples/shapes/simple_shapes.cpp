// SPDX-License-Identifier: Apache-2.0
#include "shapes/simple_shapes.h"

#include <array>
#include <cmath>
#include <map>

namespace vdb_shell::samples
{

namespace
{

using openvdb::Vec3d;

std::uint32_t wrap(int i, int n)
{
    return static_cast<std::uint32_t>(i % n);
}

struct Bracket {
    static constexpr double kThickness = 0.2, kLength = 1.6, kHeight = 1.2, kWidth = 1.0;
    static constexpr double kFillet = 0.15, kHole = 0.28, kHoleX = 1.0;
    PolygonMesh mesh;

    std::uint32_t add(const Vec3d& point)
    {
        mesh.points.push_back(point);
        return static_cast<std::uint32_t>(mesh.points.size() - 1);
    }
    void quad(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d)
    {
        mesh.faces.push_back({a, b, c});
        mesh.faces.push_back({a, c, d});
    }
};

using Loop = std::vector<std::uint32_t>;

/// The L counter-clockwise seen from +z, starting at the outer corner, which sees all of it.
Loop profile_loop(Bracket& bracket, double z, int fillet_sides)
{
    using B = Bracket;
    Loop loop{bracket.add({0, 0, z}), bracket.add({B::kLength, 0, z}),
              bracket.add({B::kLength, B::kThickness, z})};
    const double centre = B::kThickness + B::kFillet;
    for (int i = 0; i <= fillet_sides; ++i) {
        const double angle = 0.5 * kPi * i / fillet_sides;
        loop.push_back(bracket.add(
            {centre - B::kFillet * std::sin(angle), centre - B::kFillet * std::cos(angle), z}));
    }
    loop.push_back(bracket.add({B::kThickness, B::kHeight, z}));
    loop.push_back(bracket.add({0, B::kHeight, z}));
    return loop;
}

Loop hole_loop(Bracket& bracket, double y, int sides)
{
    Loop loop;
    for (int i = 0; i < sides; ++i) {
        const double angle = 2 * kPi * i / sides;
        loop.push_back(bracket.add({Bracket::kHoleX + Bracket::kHole * std::cos(angle), y,
                                    0.5 * Bracket::kWidth + Bracket::kHole * std::sin(angle)}));
    }
    return loop;
}

/// A rectangle with a round hole: corner k fans to the k-th quarter of the circle. Corners and
/// circle run the same way round; `flip` turns the triangles over.
void plate_with_hole(Bracket& bracket, const std::array<std::uint32_t, 4>& corners,
                     const Loop& circle, bool flip)
{
    const int sides = static_cast<int>(circle.size()), quarter = sides / 4;
    const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        bracket.mesh.faces.push_back(flip ? Polygon{a, c, b} : Polygon{a, b, c});
    };
    for (int k = 0; k < 4; ++k) {
        for (int i = k * quarter; i < (k + 1) * quarter; ++i)
            add(corners[k], circle[wrap(i + 1, sides)], circle[i]);
        add(corners[k], corners[(k + 1) % 4], circle[wrap((k + 1) * quarter, sides)]);
    }
}

} // namespace

PolygonMesh sphere(int around, int down)
{
    PolygonMesh mesh;
    mesh.points.push_back({0, 1, 0});
    for (int j = 1; j < down; ++j)
        for (int i = 0; i < around; ++i) {
            const double polar = kPi * j / down, turn = 2 * kPi * i / around;
            mesh.points.push_back({std::sin(polar) * std::sin(turn), std::cos(polar),
                                   std::sin(polar) * std::cos(turn)});
        }
    mesh.points.push_back({0, -1, 0});
    const auto south = static_cast<std::uint32_t>(mesh.points.size() - 1);
    const auto at = [&](int j, int i) {
        return static_cast<std::uint32_t>(1 + (j - 1) * around) + wrap(i, around);
    };
    for (int i = 0; i < around; ++i) {
        mesh.faces.push_back({0, at(1, i), at(1, i + 1)});
        for (int j = 1; j + 1 < down; ++j)
            mesh.faces.push_back({at(j, i), at(j + 1, i), at(j + 1, i + 1), at(j, i + 1)});
        mesh.faces.push_back({south, at(down - 1, i + 1), at(down - 1, i)});
    }
    return mesh;
}

PolygonMesh box(int n)
{
    PolygonMesh mesh;
    std::map<std::array<int, 3>, std::uint32_t> index;
    const Vec3d half(1.0, 0.6, 0.4);
    const auto at = [&](const std::array<int, 3>& cell) {
        const auto [found, is_new] =
            index.try_emplace(cell, static_cast<std::uint32_t>(mesh.points.size()));
        if (is_new)
            mesh.points.push_back(
                half * Vec3d(2.0 * cell[0] / n - 1, 2.0 * cell[1] / n - 1, 2.0 * cell[2] / n - 1));
        return found->second;
    };
    for (std::size_t axis = 0; axis < 3; ++axis)
        for (const int side : {0, n})
            for (int i = 0; i < n; ++i)
                for (int j = 0; j < n; ++j) {
                    const auto corner = [&](int u, int v) {
                        std::array<int, 3> cell{};
                        cell[axis] = side;
                        // Swapping u and v on the low side keeps every quad outward.
                        cell[(axis + 1) % 3] = side ? i + u : i + v;
                        cell[(axis + 2) % 3] = side ? j + v : j + u;
                        return at(cell);
                    };
                    mesh.faces.push_back({corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)});
                }
    return mesh;
}

PolygonMesh torus(int around, int across)
{
    PolygonMesh mesh;
    for (int i = 0; i < around; ++i)
        for (int j = 0; j < across; ++j) {
            const double turn = 2 * kPi * i / around, tube = 2 * kPi * j / across;
            const double radius = 1.0 + 0.35 * std::cos(tube);
            mesh.points.push_back(
                {radius * std::sin(turn), 0.35 * std::sin(tube), radius * std::cos(turn)});
        }
    const auto at = [&](int i, int j) {
        return wrap(i, around) * static_cast<std::uint32_t>(across) + wrap(j, across);
    };
    for (int i = 0; i < around; ++i)
        for (int j = 0; j < across; ++j)
            mesh.faces.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
    return mesh;
}

PolygonMesh bracket(int hole_sides, int fillet_sides)
{
    Bracket result;
    const Loop back = profile_loop(result, 0.0, fillet_sides);
    const Loop front = profile_loop(result, Bracket::kWidth, fillet_sides);
    const Loop low = hole_loop(result, 0.0, hole_sides);
    const Loop high = hole_loop(result, Bracket::kThickness, hole_sides);
    for (std::size_t i = 1; i + 1 < front.size(); ++i) {
        result.mesh.faces.push_back({front[0], front[i], front[i + 1]});
        result.mesh.faces.push_back({back[0], back[i + 1], back[i]});
    }
    // Side i runs from loop corner i to i+1; 0 and 2 are the two plates around the hole.
    for (std::size_t i = 0; i < front.size(); ++i)
        if (const std::size_t next = (i + 1) % front.size(); i != 0 && i != 2)
            result.quad(back[i], back[next], front[next], front[i]);
    plate_with_hole(result, {front[1], front[0], back[0], back[1]}, low, false);
    plate_with_hole(result, {front[2], front[3], back[3], back[2]}, high, true);
    for (int i = 0; i < hole_sides; ++i) {
        const std::uint32_t next = wrap(i + 1, hole_sides);
        result.quad(low[i], low[next], high[next], high[i]);
    }
    return result.mesh;
}

} // namespace vdb_shell::samples
