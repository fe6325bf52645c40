// SPDX-License-Identifier: Apache-2.0

// Takes a solid and leaves its surface, as triangles and as a file.

#include "solid.h"

#include <vdb_shell/core/atomic_file.h>

#include <algorithm>
#include <map>
#include <ostream>

namespace soft_body
{

std::vector<Triangle> boundary(const Solid& solid)
{
    static constexpr int kFaces[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};
    std::vector<std::pair<Triangle, Triangle>> found; // sorted corners first
    found.reserve(4 * solid.tets.size());
    for (const Tet& tet : solid.tets)
        for (const auto& f : kFaces) {
            const Triangle face{tet[std::size_t(f[0])], tet[std::size_t(f[1])],
                                tet[std::size_t(f[2])]};
            Triangle sorted = face;
            std::sort(sorted.begin(), sorted.end());
            found.emplace_back(sorted, face);
        }
    std::sort(found.begin(), found.end());
    std::vector<Triangle> outside;
    for (std::size_t i = 0; i < found.size(); ++i) {
        const bool before = i > 0 && found[i - 1].first == found[i].first;
        const bool after = i + 1 < found.size() && found[i + 1].first == found[i].first;
        if (!before && !after)
            outside.push_back(found[i].second);
    }
    return outside;
}

std::vector<Triangle> skin(const Solid& solid)
{
    std::vector<Triangle> triangles = boundary(solid);
    if (solid.layer.empty())
        return triangles;
    const auto deep = [&](const Triangle& t) {
        return std::any_of(t.begin(), t.end(), [&](int c) { return solid.layer[std::size_t(c)]; });
    };
    triangles.erase(std::remove_if(triangles.begin(), triangles.end(), deep), triangles.end());
    return triangles;
}

void write_obj(const std::filesystem::path& path, const Points& points,
               const std::vector<Triangle>& triangles)
{
    std::map<int, std::size_t> number; // from 1, as .obj counts
    for (const Triangle& t : triangles)
        for (int corner : t)
            number.emplace(corner, 0);
    vdb_shell::write_stream_atomically(path, [&](std::ostream& out) {
        std::size_t next = 0;
        for (auto& [corner, name] : number) {
            name = ++next;
            const auto p = points.col(corner);
            out << "v " << p.x() << ' ' << p.y() << ' ' << p.z() << '\n';
        }
        for (const Triangle& t : triangles)
            out << "f " << number[t[0]] << ' ' << number[t[1]] << ' ' << number[t[2]] << '\n';
    });
}

} // namespace soft_body
