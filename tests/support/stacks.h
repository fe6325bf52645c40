// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "support/cancelled.h"
#include "support/shapes.h"

#include "vdb_shell/certify/conformity.h"
#include "vdb_shell/certify/stack_certificate.h"
#include "vdb_shell/certify/tet_signs.h"
#include "vdb_shell/core/error.h"
#include "vdb_shell/core/interrupter.h"
#include "vdb_shell/growth/grow.h"
#include "vdb_shell/mesh/normals.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

// Grown shells, and what has to hold for stacks made of them.

namespace vdb_shell::test
{

/// Grown from the pseudo-normals, without line stepping.
inline GrowResult grown(const TriangleMesh& mesh, const GrowOptions& options = {},
                        double cap = std::numeric_limits<double>::infinity())
{
    const std::size_t count = mesh.points.size();
    const LineLengths none{std::vector<double>(count, 0.0), std::vector<std::uint32_t>(count, 0),
                           std::vector<StopReason>(count, StopReason::none)};
    return grow_shell(mesh, directions_along(mesh, pseudo_normals(mesh)), none,
                      std::vector<double>(count, cap), options, {});
}

inline GrowOptions by_method(Method method)
{
    GrowOptions options;
    options.method = method;
    return options;
}

/// Under each test of a prism, and the thickest.
inline std::vector<GrowOptions> ways_to_grow()
{
    GrowOptions chosen;
    chosen.prism_test = PrismTest::chosen_tets;
    return {{}, chosen, by_method(Method::thickest)};
}

/// A solid without symmetry: bumps of several lengths on a sphere.
inline TriangleMesh bumpy_sphere(int subdivisions = 3)
{
    TriangleMesh mesh = icosphere(1.0, subdivisions);
    for (openvdb::Vec3s& p : mesh.points) {
        const openvdb::Vec3d d(p);
        p = openvdb::Vec3s(d * (1 + 0.25 * std::sin(5 * d[0] + 1) * std::sin(4 * d[1]) +
                                0.1 * std::cos(7 * d[2] + d[0])));
    }
    return mesh;
}

/// A tube around a trefoil knot, whose strands pass each other closely.
inline TriangleMesh trefoil(int around, int across)
{
    const auto centre = [](double t) {
        return openvdb::Vec3d(std::sin(t) + 2 * std::sin(2 * t), std::cos(t) - 2 * std::cos(2 * t),
                              -std::sin(3 * t));
    };
    TriangleMesh mesh = torus(1.0, 0.3, around, across); // its triangles
    for (int i = 0; i < around; ++i) {
        const double t = 2 * M_PI * i / around;
        const openvdb::Vec3d along = (centre(t + 1e-4) - centre(t - 1e-4)).unit();
        const openvdb::Vec3d side = along.cross(openvdb::Vec3d(0, 0, 1)).unit();
        const openvdb::Vec3d up = side.cross(along);
        for (int j = 0; j < across; ++j) {
            const double s = 2 * M_PI * j / across;
            const openvdb::Vec3d out = std::cos(s) * side + std::sin(s) * up;
            mesh.points[std::size_t(i * across + j)] = openvdb::Vec3s(centre(t) + 0.55 * out);
        }
    }
    return signed_volume(mesh.points, mesh.triangles) > 0 ? mesh : reversed(mesh);
}

/// A pyramid over a U. No point of the U sees all its sides, so no direction at the apex (the last
/// vertex) sees all the faces there.
inline TriangleMesh pyramid_over_u()
{
    TriangleMesh mesh;
    mesh.points = {openvdb::Vec3s(0, 0, 0), openvdb::Vec3s(3, 0, 0), openvdb::Vec3s(3, 3, 0),
                   openvdb::Vec3s(2, 3, 0), openvdb::Vec3s(2, 1, 0), openvdb::Vec3s(1, 1, 0),
                   openvdb::Vec3s(1, 3, 0), openvdb::Vec3s(0, 3, 0), openvdb::Vec3s(1.5F, 0.5F, 2)};
    for (std::uint32_t i = 0; i < 8; ++i)
        mesh.triangles.emplace_back(i, (i + 1) % 8, 8);
    for (const auto& [a, b, c, d] :
         {std::array<std::uint32_t, 4>{0, 1, 4, 5}, std::array<std::uint32_t, 4>{0, 5, 6, 7},
          std::array<std::uint32_t, 4>{1, 2, 3, 4}}) {
        mesh.triangles.emplace_back(a, c, b);
        mesh.triangles.emplace_back(a, d, c);
    }
    return mesh;
}

inline void expect_certified(const ShellStack& stack, PrismTest test)
{
    EXPECT_EQ(certify_stack(stack, test).failures(), std::vector<std::string>{});
    const TetMesh tets = make_tets(stack);
    const TetSigns signs = count_tet_signs(tets);
    EXPECT_EQ(signs.inverted.count + signs.flat.count, 0U);
    EXPECT_TRUE(check_conformity(stack, tets).conforming());
}

/// Each surface between two layers is one surface, and the triangles are the same in all.
inline void expect_joined(const ShellStack& stack)
{
    for (std::size_t k = 0; k + 1 < stack.layers.size(); ++k) {
        EXPECT_EQ(stack.layers[k].inner, stack.layers[k + 1].outer) << "layer " << k;
        EXPECT_EQ(stack.layers[k].triangles, stack.layers[k + 1].triangles) << "layer " << k;
    }
}

/// What an InvalidOption says.
template <typename Call> std::string refusal_of(const Call& call)
{
    try {
        call();
    } catch (const InvalidOption& error) {
        return error.what();
    }
    return "accepted";
}

/// call(x) refuses, by name and value, every x that is no positive finite number.
template <typename Call> void expect_positive_finite(const std::string& name, const Call& call)
{
    const std::pair<double, const char*> numbers[] = {
        {0.0, "0"}, {-0.5, "-0.5"}, {INFINITY, "inf"}, {NAN, "nan"}};
    for (const auto& [number, shown] : numbers) {
        const std::string said = refusal_of([&, x = number] { call(x); });
        EXPECT_EQ(said.find(name + " is " + shown + ", must be "), 0U) << said;
        EXPECT_NE(said.find("above 0"), std::string::npos) << said;
    }
}

} // namespace vdb_shell::test
