// SPDX-License-Identifier: Apache-2.0

// What the scans of all formats do with a face: count it, remove corners that repeat the one
// before, and keep it or note it as skipped. Guarantee: each face of the file is in exactly one of
// the two lists, so the counts of the report add up and nothing gets lost. A face in which every
// corner comes more than once is skipped: from whichever corner a fan began, one of its triangles
// would have that corner twice. Nothing here looks at positions; mesh_of_scan.cpp calls
// tidy_polygon() again when equal positions have been merged.

#include "io/file_scan.h"

#include <algorithm>

namespace vdb_shell
{

void require_numbered(const std::string& name, std::size_t count, const char* what)
{
    if (count > INT32_MAX)
        refuse(name, "it has " + std::to_string(count) + " " + what + ", over the limit of " +
                         std::to_string(INT32_MAX));
}

std::size_t first_unique_corner(const Polygon& polygon)
{
    // Sorted, because comparing all pairs takes seconds for a polygon of 50,000 corners.
    Polygon sorted = polygon;
    std::sort(sorted.begin(), sorted.end());
    const auto once = [&](std::uint32_t corner) {
        const auto [first, last] = std::equal_range(sorted.begin(), sorted.end(), corner);
        return last - first == 1;
    };
    return static_cast<std::size_t>(std::find_if(polygon.begin(), polygon.end(), once) -
                                    polygon.begin());
}

bool tidy_polygon(Polygon& polygon)
{
    // Nearly all faces are sound triangles, which need no search.
    if (polygon.size() == 3 && polygon[0] != polygon[1] && polygon[1] != polygon[2] &&
        polygon[2] != polygon[0])
        return true;
    // Where the polygon ends it begins again, so the last corners are compared with the first.
    polygon.erase(std::unique(polygon.begin(), polygon.end()), polygon.end());
    while (polygon.size() > 1 && polygon.front() == polygon.back())
        polygon.pop_back();
    return polygon.size() >= 3 && first_unique_corner(polygon) < polygon.size();
}

void add_face(FileScan& scan, Polygon& polygon)
{
    const std::size_t face = scan.file_faces++;
    // A face without a triangle is kept out of everything after this, but never out of the report.
    if (!tidy_polygon(polygon)) {
        scan.skipped_faces.push_back(face);
        return;
    }
    scan.corners.insert(scan.corners.end(), polygon.begin(), polygon.end());
    scan.polygon_sizes.push_back(static_cast<std::uint32_t>(polygon.size()));
}

void require_corner(const std::string& name, const Place& face, std::int64_t index,
                    std::size_t vertices, const std::string& shown)
{
    // Signed, so that what the file says can be compared before it is narrowed.
    if (index < 0 || static_cast<std::uint64_t>(index) >= vertices)
        refuse(name, face.text() + ": the vertex index " + shown +
                         " is out of range, the file has " + std::to_string(vertices) +
                         " vertices");
}

} // namespace vdb_shell
