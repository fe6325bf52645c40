// SPDX-License-Identifier: Apache-2.0

// Takes: directions. Leaves: ones along which long pillars are valid beside needles. All twelve
// tets of a prism are positive if its quads are planar and its pillars end before they meet
// (docs/theory.md, "Planar quads"). A needle bears hardly any bend, for its tets are thin, and its
// long edges join vertices far apart: so what directions have to agree on is a problem of all at
// once. Pillars per unit of depth are the unknowns, parallel inner triangles what is kept: a pillar
// may move along the crease that it stands on, or in the plane that it stands on, at no price.
// Solved by Gauss and Newton's method. Nothing is tested here; what does not come out planar is
// mended.

#include "growth/planar_quads.h"

#include "core/least_squares.h"
#include "core/unit_vector.h"
#include "mesh/most_visible.h"

#include <algorithm>
#include <cmath>

namespace vdb_shell::growth
{
namespace
{

/// Below the edge from p to q of a face. Scale: depth over twice the face's area.
struct Quad {
    int p, q;
    Vec3d edge;
    double scale;
};

/// The inner triangle of a face is parallel where the pillar is 1 deep as it sees it.
struct SeenFrom {
    int vertex;
    Vec3d inward_normal;
};

class PlanarQuads
{
public:
    PlanarQuads(const GrowState& s, const Directions& directions, const std::vector<double>& length)
        : s_(s), given_(directions), schedule_(s.schedule.planar)
    {
        std::vector<double> depth(s.a.size());
        for (std::size_t v = 0; v < s.a.size(); ++v) {
            // Pillars that see a triangle under a small angle are many times as long as it is deep.
            constexpr double kLeast = 0.1;
            const double seen = std::max(directions.visibility[v], kLeast);
            pillar_.push_back(directions.inward[v] / seen);
            depth[v] = length[v] * seen;
        }
        start_ = pillar_;
        for (int f = 0; f < s.mesh->face_count(); ++f)
            add_face(f, depth);
    }

    void solve()
    {
        double energy = energy_now();
        for (int round = 0; round < schedule_.most_rounds; ++round) {
            const double before = energy;
            if (!move(step(), energy) || before - energy < schedule_.least_gain * before)
                return;
        }
    }

    Directions directions() const
    {
        Directions found = given_;
        std::vector<std::vector<Vec3d>> normals(s_.a.size());
        for (const SeenFrom& seen : seen_)
            normals[seen.vertex].push_back(seen.inward_normal);
        for (std::size_t v = 0; v < normals.size(); ++v) {
            if (!is_free(static_cast<int>(v)))
                continue;
            const Vec3d direction = unit_vector(pillar_[v]);
            const double visibility = smallest_dot(normals[v], direction);
            // What is not a number, far from the range of doubles, is refused as well.
            if (visibility >= std::min(schedule_.least_visibility,
                                       schedule_.kept_visibility_share * given_.visibility[v])) {
                found.inward[v] = direction;
                found.visibility[v] = visibility;
            }
        }
        return found;
    }

private:
    void add_face(int f, const std::vector<double>& depth)
    {
        const Corners c = outer_corners(s_, f);
        const Vec3d normal = (c[2] - c[0]).cross(c[1] - c[0]);
        const double twice_area = normal.length();
        if (!(twice_area > 0))
            return;
        for (int k = 0; k < 3; ++k) {
            const int p = s_.mesh->corner(f, k), q = s_.mesh->corner(f, (k + 1) % 3);
            seen_.push_back({p, normal / twice_area});
            quads_.push_back(
                {p, q, s_.a[q] - s_.a[p], std::sqrt(depth[p] * depth[q]) / twice_area});
        }
    }

    bool is_free(int v) const { return given_.visibility[v] > 0; }
    /// 1 where a tet of the prism is flat.
    double bend(const Quad& quad) const
    {
        return quad.scale * pillar_[quad.p].cross(pillar_[quad.q]).dot(quad.edge);
    }

    double energy_now() const
    {
        double sum = 0;
        for (const Quad& quad : quads_)
            sum += bend(quad) * bend(quad);
        for (const SeenFrom& seen : seen_) {
            const double off = seen.inward_normal.dot(pillar_[seen.vertex]) - 1;
            sum += schedule_.parallel_weight * off * off;
        }
        for (std::size_t v = 0; v < pillar_.size(); ++v)
            sum += schedule_.staying_weight * (pillar_[v] - start_[v]).lengthSqr();
        return sum;
    }

    /// Coefficients of the unknowns of a vertex, three each; none where it is not free.
    void add_terms(int v, const Vec3d& coefficients, SparseRow& row) const
    {
        for (int k = 0; k < 3 && is_free(v); ++k)
            row.terms.emplace_back(3 * std::size_t(v) + std::size_t(k), coefficients[k]);
    }

    /// How far all pillars go where the sum of squares is least, if bends were linear.
    std::vector<Vec3d> step() const
    {
        std::vector<SparseRow> rows;
        std::vector<double> constants;
        const auto add = [&](SparseRow row, double constant) {
            rows.push_back(std::move(row));
            constants.push_back(constant);
        };
        for (const Quad& quad : quads_) {
            SparseRow row;
            add_terms(quad.p, quad.scale * pillar_[quad.q].cross(quad.edge), row);
            add_terms(quad.q, quad.scale * quad.edge.cross(pillar_[quad.p]), row);
            add(std::move(row), bend(quad));
        }
        const double parallel = std::sqrt(schedule_.parallel_weight);
        for (const SeenFrom& seen : seen_) {
            SparseRow row;
            add_terms(seen.vertex, parallel * seen.inward_normal, row);
            add(std::move(row), parallel * (seen.inward_normal.dot(pillar_[seen.vertex]) - 1));
        }
        const double staying = std::sqrt(schedule_.staying_weight);
        for (int v = 0; v < s_.mesh->vertices; ++v)
            for (int k = 0; k < 3 && is_free(v); ++k)
                add({{{3 * std::size_t(v) + std::size_t(k), staying}}},
                    staying * (pillar_[v][k] - start_[v][k]));
        std::vector<double> x(3 * pillar_.size());
        const std::vector<double> factor = scale_columns(rows, x.size());
        LeastSquaresLimits limits;
        limits.most_steps = std::size_t(schedule_.most_steps);
        minimise_squares(rows, constants, x, limits);
        std::vector<Vec3d> steps(pillar_.size());
        for (std::size_t v = 0; v < steps.size(); ++v)
            for (std::size_t k = 0; k < 3; ++k)
                steps[v][int(k)] = x[3 * v + k] * factor[3 * v + k];
        return steps;
    }

    /// As far as the sum of squares becomes smaller; false where it does not.
    bool move(const std::vector<Vec3d>& step, double& energy)
    {
        constexpr double kShortest = 0.01;
        const std::vector<Vec3d> before = pillar_;
        for (double share = 1; share > kShortest; share *= 0.5) {
            for (std::size_t v = 0; v < pillar_.size(); ++v)
                pillar_[v] = before[v] + share * step[v];
            const double now = energy_now();
            if (now < energy) {
                energy = now;
                return true;
            }
        }
        pillar_ = before;
        return false;
    }

    const GrowState& s_;
    const Directions given_;
    const PlanarSchedule& schedule_;
    std::vector<Vec3d> pillar_, start_; ///< by vertex, per unit of depth
    std::vector<Quad> quads_;
    std::vector<SeenFrom> seen_;
};

} // namespace

Directions with_planar_quads(const GrowState& s, const Directions& directions,
                             const std::vector<double>& length)
{
    PlanarQuads quads(s, directions, length);
    quads.solve();
    return quads.directions();
}

} // namespace vdb_shell::growth
