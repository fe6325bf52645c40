// SPDX-License-Identifier: Apache-2.0
#include "shapes/polygon_mesh.h"

#include "vdb_shell/core/error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <map>
#include <utility>

namespace vdb_shell::samples
{

namespace
{

using openvdb::Vec3d;

// A pair is joined when every corner of the quad is within about 40 degrees of a right angle
// (cosine 0.64) and its halves are folded by less than about 25 degrees.
constexpr double kLargestCornerCosine = 0.64;
constexpr double kSmallestFoldCosine = 0.9;

struct Candidate {
    double badness;
    Polygon quad;
    std::uint32_t first, second; ///< triangles
};

double corner_cosine(const Vec3d& before, const Vec3d& corner, const Vec3d& after)
{
    return std::abs((before - corner).unitSafe().dot((after - corner).unitSafe()));
}

double quad_badness(const std::vector<Vec3d>& points, const Polygon& quad)
{
    const Vec3d &a = points[quad[0]], &b = points[quad[1]], &c = points[quad[2]],
                &d = points[quad[3]];
    const double worst_corner = std::max({corner_cosine(d, a, b), corner_cosine(a, b, c),
                                          corner_cosine(b, c, d), corner_cosine(c, d, a)});
    const Vec3d first = (b - a).cross(c - a).unitSafe(), second = (c - a).cross(d - a).unitSafe();
    const double fold = first.dot(second);
    if (worst_corner > kLargestCornerCosine || fold < kSmallestFoldCosine)
        return 1.0;
    return worst_corner;
}

std::vector<Candidate> quad_candidates(const PolygonMesh& mesh)
{
    // Directed edge -> (triangle, opposite corner).
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::pair<std::uint32_t, std::uint32_t>>
        sides;
    for (std::uint32_t t = 0; t < mesh.faces.size(); ++t)
        for (std::size_t k = 0; k < 3; ++k)
            sides[{mesh.faces[t][k], mesh.faces[t][(k + 1) % 3]}] = {t, mesh.faces[t][(k + 2) % 3]};
    std::vector<Candidate> candidates;
    for (const auto& [edge, left] : sides) {
        const auto right = sides.find({edge.second, edge.first});
        if (edge.first > edge.second || right == sides.end())
            continue;
        const Polygon quad{edge.first, right->second.second, edge.second, left.second};
        const double badness = quad_badness(mesh.points, quad);
        if (badness < 1.0)
            candidates.push_back({badness, quad, left.first, right->second.first});
    }
    std::stable_sort(candidates.begin(), candidates.end(),
                     [](const Candidate& a, const Candidate& b) { return a.badness < b.badness; });
    return candidates;
}

} // namespace

PolygonMesh join_into_quads(const PolygonMesh& triangles)
{
    PolygonMesh joined{triangles.points, triangles.faces};
    std::vector<bool> used(triangles.faces.size(), false);
    for (const Candidate& candidate : quad_candidates(triangles)) {
        if (used[candidate.first] || used[candidate.second])
            continue;
        used[candidate.first] = used[candidate.second] = true;
        joined.faces[std::min(candidate.first, candidate.second)] = candidate.quad;
        joined.faces[std::max(candidate.first, candidate.second)].clear();
    }
    joined.faces.erase(std::remove_if(joined.faces.begin(), joined.faces.end(),
                                      [](const Polygon& face) { return face.empty(); }),
                       joined.faces.end());
    return joined;
}

void write_obj(const std::filesystem::path& path, const PolygonMesh& mesh)
{
    std::string text = "# made by vdb_shell_make_meshes, SPDX-License-Identifier: Apache-2.0\n";
    std::array<char, 128> line{};
    for (const Vec3d& p : mesh.points) {
        // Adding zero turns -0.000000 into 0.000000.
        const auto rounded = [](double x) { return std::round(x * 1e6) / 1e6 + 0.0; };
        std::snprintf(line.data(), line.size(), "v %.6f %.6f %.6f\n", rounded(p[0]), rounded(p[1]),
                      rounded(p[2]));
        text += line.data();
    }
    for (const Polygon& face : mesh.faces) {
        text += 'f';
        for (const std::uint32_t corner : face)
            text += ' ' + std::to_string(corner + 1);
        text += '\n';
    }
    std::ofstream out(path, std::ios::binary);
    out << text << std::flush;
    if (!out)
        throw WriteError(path.string() + ": cannot be written");
}

} // namespace vdb_shell::samples
