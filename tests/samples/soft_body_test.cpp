// SPDX-License-Identifier: Apache-2.0

#include "soft_body/motion.h"
#include "soft_body/multigrid.h"
#include "soft_body/refine.h"

#include "support/files.h"

#include <vdb_shell/core/error.h>
#include <vdb_shell/io/read_mesh.h>
#include <vdb_shell/pipeline.h>
#include <vdb_shell/write/tet_file.h>
#include <vdb_shell/write/vdb_file.h>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

using namespace soft_body;
using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace
{

/// A block of cells, each cut into the six tets around its diagonal.
Solid block(std::array<int, 3> cells, const Vector3d& size)
{
    Solid solid;
    const auto index = [&](int x, int y, int z) {
        return (z * (cells[1] + 1) + y) * (cells[0] + 1) + x;
    };
    solid.points.resize(3, index(cells[0], cells[1], cells[2]) + 1);
    for (int z = 0; z <= cells[2]; ++z)
        for (int y = 0; y <= cells[1]; ++y)
            for (int x = 0; x <= cells[0]; ++x)
                solid.points.col(index(x, y, z)) = Vector3d(
                    x * size.x() / cells[0], y * size.y() / cells[1], z * size.z() / cells[2]);
    static constexpr int orders[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1},
                                         {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
    for (int z = 0; z < cells[2]; ++z)
        for (int y = 0; y < cells[1]; ++y)
            for (int x = 0; x < cells[0]; ++x)
                for (int o = 0; o < 6; ++o) {
                    std::array<int, 3> at{x, y, z};
                    Tet tet{index(x, y, z)};
                    for (int k = 0; k < 3; ++k) {
                        ++at[std::size_t(orders[o][k])];
                        tet[std::size_t(k) + 1] = index(at[0], at[1], at[2]);
                    }
                    if (o >= 3) // an odd order runs the other way round
                        std::swap(tet[2], tet[3]);
                    solid.tets.push_back(tet);
                }
    return solid;
}

/// The same with inner points moved about, so that no two tets are alike.
Solid irregular_block()
{
    Solid solid = block({4, 4, 4}, {1, 1, 1});
    for (Eigen::Index i = 0; i < solid.points.cols(); ++i) {
        auto p = solid.points.col(i);
        if ((p.array() > 0 && p.array() < 1).all())
            p += .06 * Vector3d(std::sin(3. * double(i)), std::sin(5. * double(i) + 1),
                                std::sin(7. * double(i) + 2));
    }
    return solid;
}

Held held_where(const Points& points, const std::function<bool(const Vector3d&)>& is)
{
    Held held;
    for (Eigen::Index i = 0; i < points.cols(); ++i)
        held.push_back(is(points.col(i)));
    return held;
}

double volume(const Solid& solid)
{
    return Elasticity(solid, {1, 0, 1}).mass().sum();
}

Matrix3d some_rotation()
{
    return Eigen::AngleAxisd(2.1, Vector3d(1, -2, .5).normalized()).toRotationMatrix();
}

/// Work of a downward load on a horizontal bar of square section that is clamped at x = 0: the
/// compliance of each refinement.
std::vector<double> cantilever(double length, double side, const Material& material)
{
    std::vector<double> found;
    Solid solid = block({int(4 * length / side), 4, 4}, {length, side, side});
    Points start;
    for (int k = 0; k < 2; ++k) {
        const Held held = held_where(solid.points, [](const Vector3d& p) { return p.x() == 0; });
        found.push_back(deflect(solid, Elasticity(solid, material), held, 1).compliance);
        solid = refine(solid).solid;
    }
    return found;
}

} // namespace

TEST(SoftBody, ConstantStrainIsReproducedExactly)
{
    const Solid solid = irregular_block();
    const Elasticity elasticity(solid, {3, .4, 1});
    Matrix3d slope;
    slope << .1, .02, -.03, .05, -.07, .04, .01, .06, .08;
    const Points wanted = slope * solid.points;
    const Held held = held_where(solid.points, [](const Vector3d& p) {
        return (p.array() == 0).any() || (p.array() == 1).any();
    });
    Points start = wanted;
    for (Eigen::Index i = 0; i < start.cols(); ++i)
        if (!held[std::size_t(i)])
            start.col(i).setZero();
    const BlockMatrix stiffness = elasticity.stiffness();
    // The right side is 0 and so is its norm: as far down as doubles go.
    const Solved solved = conjugate_gradients(stiffness, held, Points::Zero(3, start.cols()),
                                              divide_by_diagonal(stiffness, held), start, {0, 300});
    EXPECT_LT((solved.x - wanted).cwiseAbs().maxCoeff(), 1e-12);

    // Hooke's law with Lame's 30 / 7 and 15 / 14.
    const Matrix3d strain = (slope + slope.transpose()) / 2;
    const Matrix3d stress = 30. / 7 * strain.trace() * Matrix3d::Identity() + 15. / 7 * strain;
    for (const Matrix3d& found : elasticity.stress(solved.x))
        EXPECT_LT((found - stress).cwiseAbs().maxCoeff(), 1e-10);
}

TEST(SoftBody, RigidMotionsGiveNoForce)
{
    const Solid solid = irregular_block();
    const Elasticity elasticity(solid, {3, .4, 1});
    const Vector3d far(5, -3, 2), spin(.3, -.2, .7);
    Points small(3, solid.points.cols());
    for (Eigen::Index i = 0; i < small.cols(); ++i)
        small.col(i) = spin.cross(Vector3d(solid.points.col(i))) + far;
    EXPECT_LT((elasticity.stiffness() * small).cwiseAbs().maxCoeff(), 1e-12);

    const Points turned = (some_rotation() * solid.points).colwise() + far;
    std::vector<Matrix3d> rotations;
    // The rule turns by less than a right angle a round; the second call begins near.
    elasticity.update_rotations(turned, rotations);
    elasticity.update_rotations(turned, rotations);
    for (const Matrix3d& rotation : rotations)
        EXPECT_LT((rotation - some_rotation()).cwiseAbs().maxCoeff(), 1e-9);
    EXPECT_LT(elasticity.forces(turned, rotations).cwiseAbs().maxCoeff(), 1e-9);
    EXPECT_LT(
        (elasticity.stiffness(rotations) * Points(some_rotation() * small)).cwiseAbs().maxCoeff(),
        1e-9);
}

TEST(SoftBody, ForcesAreTheStiffnessTimesSmallDisplacements)
{
    const Solid solid = irregular_block();
    const Elasticity elasticity(solid, {3, .4, 1});
    Points small(3, solid.points.cols());
    for (Eigen::Index i = 0; i < small.cols(); ++i)
        small.col(i) = 1e-3 * Vector3d(std::sin(2. * double(i)), std::cos(3. * double(i)),
                                       std::sin(4. * double(i)));
    const std::vector<Matrix3d> still(solid.tets.size(), Matrix3d::Identity());
    EXPECT_LT((elasticity.forces(solid.points + small, still) + elasticity.stiffness() * small)
                  .cwiseAbs()
                  .maxCoeff(),
              1e-14);
}

TEST(SoftBody, AColumnIsCompressedByItsWeight)
{
    // Without Poisson's effect it sinks by rho g (H z - z^2 / 2) / E and the work is
    // (rho g)^2 A H^3 / 3 E.
    const double height = 2;
    const Material material{1e5, 0, 1000};
    const double load = material.density * kGravity;
    const Solid solid = block({3, 3, 12}, {.5, .5, height});
    const Held held = held_where(solid.points, [](const Vector3d& p) { return p.z() == 0; });
    const Deflection found = deflect(solid, Elasticity(solid, material), held, 2);
    EXPECT_TRUE(found.converged);
    const double top = load * height * height / (2 * material.young);
    // The mean of the top's 16 points: a corner carries the mass of its own tets, one or six.
    EXPECT_NEAR(found.displacement.row(2).tail(16).mean(), -top, .01 * top);
    const double work = load * load * .25 * std::pow(height, 3) / (3 * material.young);
    EXPECT_NEAR(found.compliance, work, .01 * work);
    EXPECT_LT(found.compliance, work); // of linear tets, which are too stiff
}

TEST(SoftBody, ABarBendsAsABeam)
{
    // Timoshenko's cantilever under its weight w: w^2 (L^5 / 20 E I + L^3 / 3 k G A), k = 5 / 6
    // without Poisson's effect.
    const double length = 6, side = 1;
    const Material material{1e5, 0, 10};
    const double w = material.density * kGravity * side * side, inertia = std::pow(side, 4) / 12;
    const double work = w * w *
                        (std::pow(length, 5) / (20 * material.young * inertia) +
                         std::pow(length, 3) / (3 * 5. / 6 * material.young / 2 * side * side));
    const std::vector<double> found = cantilever(length, side, material);
    EXPECT_LT(found[0], found[1]);
    EXPECT_LT(found[1], work);
    // Halving the edges quarters the error of a smooth solution.
    EXPECT_NEAR(found[1] + (found[1] - found[0]) / 3, work, .02 * work);
}

TEST(SoftBody, RefiningKeepsTheSolid)
{
    const Solid solid = irregular_block();
    const Solid fine = refine(solid).solid;
    EXPECT_EQ(fine.tets.size(), 8 * solid.tets.size());
    EXPECT_EQ(boundary(fine).size(), 4 * boundary(solid).size());
    EXPECT_NEAR(volume(fine), 1, 1e-12);
    const std::vector<double> thirds{1, 4. / 3, 13. / 9};
    EXPECT_NEAR(extrapolate(thirds), 1.5, 1e-12); // 1 + 1/3 + 1/9 + ...
}

TEST(SoftBody, MultigridAndDiagonalLeadToTheSameDeflection)
{
    const Material material{2e4, .4, 1000};
    // What is held ends at points of all three.
    const Solid coarse = block({2, 2, 10}, {.2, .2, 1});
    const Convergence found = converge(coarse, material, 2, 2);
    Solid solid = coarse;
    for (double compliance : found.compliances) {
        const Deflection again =
            deflect(solid, Elasticity(solid, material), hold_foot(solid.points, 2), 2);
        EXPECT_NEAR(compliance, again.compliance, 1e-5 * compliance);
        solid = refine(solid).solid;
    }
    EXPECT_GT(found.limit, found.compliances.back());
}

TEST(SoftBody, RefiningWithTheSameSkinHeldOnlySoftens)
{
    Solid coarse = irregular_block();
    const Held held = hold_skin(coarse, 2);
    EXPECT_EQ(std::count(held.begin(), held.end(), char(1)), 25); // the bottom of 4 x 4 cells
    const Refined refined = refine(coarse);
    const Held fine = hold_midpoints(coarse, held, refined.parents);
    EXPECT_EQ(std::count(fine.begin(), fine.end(), char(1)), 81); // of 8 x 8
    const Convergence found = converge(coarse, {2e4, .4, 1000}, 2, 2, true);
    EXPECT_LT(found.compliances[0], found.compliances[1]);
    EXPECT_LT(found.compliances[1], found.compliances[2]);
    EXPECT_LT(found.compliances[2], found.limit);
}

TEST(SoftBody, TheExplicitStepIsThatOfAllEigenvalues)
{
    const Solid solid = block({2, 2, 3}, {1, 1, 2});
    const Elasticity elasticity(solid, {3, .4, 2});
    const Held held = hold_foot(solid.points, 2);
    const BlockMatrix stiffness = elasticity.stiffness();
    const int size = 3 * stiffness.rows();
    Eigen::MatrixXd whole = Eigen::MatrixXd::Zero(size, size);
    for (int i = 0; i < stiffness.rows(); ++i)
        for (int k = stiffness.start[std::size_t(i)]; k < stiffness.start[std::size_t(i) + 1];
             ++k) {
            const int j = stiffness.column[std::size_t(k)];
            if (!held[std::size_t(i)] && !held[std::size_t(j)])
                whole.block<3, 3>(3 * i, 3 * j) =
                    stiffness.block[std::size_t(k)] /
                    std::sqrt(elasticity.mass()[i] * elasticity.mass()[j]);
        }
    const double largest =
        Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(whole).eigenvalues().maxCoeff();
    EXPECT_NEAR(largest_eigenvalue(stiffness, elasticity.mass(), held), largest, 1e-4 * largest);
}

TEST(SoftBody, MotionComesToRestInTheDeflection)
{
    const Material material{2e6, .3, 1000}; // stiff: rotations are small, as linear theory has them
    const Solid solid = block({2, 2, 4}, {.1, .1, .2});
    const Elasticity elasticity(solid, material);
    const Held held = hold_foot(solid.points, 2);
    MotionOptions options;
    options.seconds = 1;
    options.damping = .02;
    Points first, last;
    int frames = 0;
    move(solid, elasticity, held, 2, options, [&](const Frame& frame) {
        EXPECT_EQ(frame.number, frames++);
        (frame.number == 0 ? first : last) = frame.places;
    });
    EXPECT_EQ(frames, 25);
    EXPECT_EQ(first, solid.points);
    const Deflection still = deflect(solid, elasticity, held, 2);
    EXPECT_LT((last - first - still.displacement).cwiseAbs().maxCoeff(),
              .02 * still.displacement.cwiseAbs().maxCoeff());
}

TEST(SoftBody, AShellIsTheSameFromEveryFile)
{
    const vdb_shell::test::TemporaryFolder folder;
    const auto mesh = vdb_shell::read_mesh(VDB_SHELL_SAMPLE_MESHES "/sphere.obj").mesh;
    vdb_shell::ShellOptions options;
    options.level_set.resolution = 32;
    const auto shell = vdb_shell::build_shell(mesh, options);
    vdb_shell::write_tets(folder / "shell.node", shell.tets);
    vdb_shell::ShellFile file;
    file.surface = shell.level_set;
    file.depth = vdb_shell::shell_depth_grid(shell.tets, .05);
    file.stack = shell.stack;
    file.tets = shell.tets;
    vdb_shell::write_shell_vdb(folder / "shell.vdb", file);

    const Solid solid = read_solid(folder / "shell.vdb");
    ASSERT_EQ(solid.tets.size(), shell.tets.tets.size());
    EXPECT_EQ(solid.points.cols(), Eigen::Index(shell.tets.points.size()));
    EXPECT_NEAR(volume(solid), vdb_shell::tet_volume(shell.tets), 1e-9);
    const Solid again = read_solid(folder / "shell.ele");
    EXPECT_EQ(again.points, solid.points);
    EXPECT_EQ(again.tets, solid.tets);
    EXPECT_EQ(again.layer, solid.layer);
    // What can be seen is the surface; what is held inside is the other side's points.
    EXPECT_EQ(skin(solid).size(), mesh.triangles.size());
    const Held inner = hold_inner(solid);
    EXPECT_EQ(std::count(inner.begin(), inner.end(), char(1)),
              solid.points.cols() - Eigen::Index(mesh.points.size()));
}

TEST(SoftBody, FilesOfOthersAreReadAndBrokenOnesRefused)
{
    const vdb_shell::test::TemporaryFolder folder;
    const std::string points = "# vtk DataFile Version 2.0\nx\nASCII\nDATASET UNSTRUCTURED_GRID\n"
                               "POINTS 5 double\n9 9 9  0 0 0  1 0 0\n0 1 0  0 0 1\n";
    const auto read = [&](const std::string& cells) {
        vdb_shell::test::write_bytes(folder / "solid.vtk", points + cells);
        return read_solid(folder / "solid.vtk");
    };
    const Solid solid = read("CELLS 2 9\n3 1 2 3\n4 1 2 3 4\nCELL_TYPES 2\n5\n10\n");
    ASSERT_EQ(solid.tets, (std::vector<Tet>{{0, 1, 2, 3}})); // without the point of no tet
    EXPECT_EQ(solid.points.cols(), 4);
    EXPECT_NEAR(volume(solid), 1. / 6, 1e-15);
    EXPECT_TRUE(solid.layer.empty());
    EXPECT_THROW(read("CELLS 1 5\n4 1 3 2 4\n"), vdb_shell::GeometryError); // inverted
    EXPECT_THROW(read("CELLS 1 5\n4 1 2 3 5\n"), vdb_shell::ReadError);
    EXPECT_THROW(read("CELLS 1 5\n4 1 2 3\n"), vdb_shell::ReadError);
    EXPECT_THROW(read("CELLS 99999999999 5\n"), vdb_shell::ReadError);
    EXPECT_THROW(read(""), vdb_shell::ReadError);

    // TetGen counts from the number of its first point.
    vdb_shell::test::write_bytes(
        folder / "t.node", "4 3 0 1\n1 0 0 0 1\n2 1 0 0 1\n3 0 1 0 1\n4 0 0 1 1\n# made by\n");
    vdb_shell::test::write_bytes(folder / "t.ele", "1 4 0\n1 1 2 3 4\n");
    EXPECT_EQ(read_solid(folder / "t.node").tets, solid.tets);
    EXPECT_EQ(read_solid(folder / "t.node").points, solid.points);
    EXPECT_THROW(read_solid(folder / "t.stl"), vdb_shell::ReadError);
}

TEST(SoftBody, WhatIsHeldNowhereIsRefused)
{
    Solid two = block({1, 1, 1}, {1, 1, 1});
    const Solid other = block({1, 1, 1}, {1, 1, 1});
    const auto count = two.points.cols();
    two.points.conservativeResize(3, 2 * count);
    two.points.rightCols(count) = other.points.colwise() + Vector3d(0, 0, 3);
    for (Tet tet : other.tets) {
        for (int& corner : tet)
            corner += int(count);
        two.tets.push_back(tet);
    }
    EXPECT_THROW(require_held(two, hold_foot(two.points, 2)), vdb_shell::GeometryError);
    EXPECT_NO_THROW(require_held(two, hold_foot(two.points, 0)));
    EXPECT_THROW(hold_inner(two), vdb_shell::GeometryError); // no layers
}
