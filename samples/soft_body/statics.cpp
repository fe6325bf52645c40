// SPDX-License-Identifier: Apache-2.0

// Takes a solid, what holds it and its weight, and leaves how it deflects; and how it would with
// infinitely many tets.

#include "statics.h"

#include "multigrid.h"
#include "refine.h"

#include <vdb_shell/core/error.h>

#include <algorithm>
#include <functional>
#include <numeric>
#include <string>

namespace soft_body
{

Held hold_foot(const Points& points, int up, double share)
{
    const double low = points.row(up).minCoeff(), high = points.row(up).maxCoeff();
    Held held(std::size_t(points.cols()));
    for (std::size_t i = 0; i < held.size(); ++i)
        held[i] = points(up, Eigen::Index(i)) <= low + share * (high - low);
    return held;
}

Held hold_skin(const Solid& solid, int up)
{
    const Held below = hold_foot(solid.points, up);
    Held held(below.size());
    for (const Triangle& triangle : skin(solid))
        for (int corner : triangle)
            held[std::size_t(corner)] = below[std::size_t(corner)];
    return held;
}

Held hold_midpoints(const Solid& coarse, const Held& held,
                    const std::vector<std::array<int, 2>>& parents)
{
    std::vector<std::array<int, 2>> edges;
    for (const Triangle& t : skin(coarse))
        if (held[std::size_t(t[0])] && held[std::size_t(t[1])] && held[std::size_t(t[2])])
            for (std::size_t k = 0; k < 3; ++k)
                edges.push_back({std::min(t[k], t[(k + 1) % 3]), std::max(t[k], t[(k + 1) % 3])});
    std::sort(edges.begin(), edges.end());
    Held fine = held;
    for (const auto& edge : parents)
        fine.push_back(std::binary_search(edges.begin(), edges.end(), edge));
    return fine;
}

Held hold_inner(const Solid& solid)
{
    const int last =
        solid.layer.empty() ? 0 : *std::max_element(solid.layer.begin(), solid.layer.end());
    if (last == 0)
        throw vdb_shell::GeometryError("no inner surface to hold: the file has no layers of "
                                       "points, or no point below the first");
    Held held;
    for (int layer : solid.layer)
        held.push_back(layer == last);
    return held;
}

void require_held(const Solid& solid, const Held& held)
{
    std::vector<std::size_t> above(held.size());
    std::iota(above.begin(), above.end(), std::size_t(0));
    const auto root = [&](std::size_t i) {
        while (above[i] != i)
            i = above[i] = above[above[i]];
        return i;
    };
    for (const Tet& tet : solid.tets)
        for (int corner : tet)
            above[root(std::size_t(corner))] = root(std::size_t(tet[0]));
    std::vector<char> carried(held.size());
    for (std::size_t i = 0; i < held.size(); ++i)
        if (held[i])
            carried[root(i)] = 1;
    for (std::size_t i = 0; i < held.size(); ++i)
        if (!carried[root(i)])
            throw vdb_shell::GeometryError("point " + std::to_string(i) +
                                           ": its part of the solid is held nowhere");
}

Points weight(const Eigen::VectorXd& mass, int up)
{
    Points force = Points::Zero(3, mass.size());
    force.row(up) = -kGravity * mass.transpose();
    return force;
}

Deflection deflect(const Solid& solid, const Elasticity& elasticity, const Held& held, int up)
{
    require_held(solid, held);
    const BlockMatrix stiffness = elasticity.stiffness();
    const Points force = weight(elasticity.mass(), up);
    const Solved solved = conjugate_gradients(
        stiffness, held, force, divide_by_diagonal(stiffness, held), Points::Zero(3, force.cols()));
    return {solved.x, force.cwiseProduct(solved.x).sum(), solved.steps, solved.converged};
}

Convergence converge(const Solid& solid, const Material& material, int up, int refinements,
                     bool skin_alone)
{
    Convergence found{};
    Held held = skin_alone ? hold_skin(solid, up) : hold_foot(solid.points, up);
    require_held(solid, held);
    const Elasticity coarse(solid, material);
    Points force = weight(coarse.mass(), up);
    Multigrid multigrid(coarse.stiffness(), held);
    Points x = multigrid(force); // Cholesky alone
    found.compliances.push_back(force.cwiseProduct(x).sum());
    Solid finest = solid;
    for (int k = 0; k < refinements; ++k) {
        Refined refined = refine(finest);
        held = skin_alone ? hold_midpoints(finest, held, refined.parents)
                          : hold_foot(refined.solid.points, up);
        finest = std::move(refined.solid);
        const Elasticity elasticity(finest, material);
        force = weight(elasticity.mass(), up);
        multigrid.add_finer(elasticity.stiffness(), held, std::move(refined.parents));
        x = conjugate_gradients(multigrid.finest(), held, force, std::cref(multigrid),
                                multigrid.prolongate(x))
                .x;
        found.compliances.push_back(force.cwiseProduct(x).sum());
    }
    found.limit = extrapolate(found.compliances);
    return found;
}

double extrapolate(const std::vector<double>& compliances)
{
    const std::size_t n = compliances.size();
    if (n < 2)
        return compliances.at(0);
    const double after = compliances[n - 1] - compliances[n - 2];
    double factor = 4;
    // Corners of the held part slow the convergence down below that of smooth solutions.
    if (n > 2 && after != 0)
        factor = std::clamp((compliances[n - 2] - compliances[n - 3]) / after, 1.5, 4.0);
    return compliances[n - 1] + after / (factor - 1);
}

} // namespace soft_body
