// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mesh/topology.h"

#include <openvdb/Types.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace vdb_shell::growth
{

using openvdb::Vec3I;

/// What the fans of a surface cost: a move asks about those of the vertex and of its neighbours, so
/// a round takes the sum of the squares of their sizes.
class FanWork
{
public:
    /// Triangles around a vertex. Middles of caps in models of machine parts have some hundred.
    static constexpr std::size_t kCrowd = 1024;

    void add(std::size_t triangles)
    {
        squares_ += double(triangles) * double(triangles);
        corners_ += double(triangles);
        any_crowd_ |= triangles > kCrowd;
    }
    /// A good surface has 6 for each corner.
    bool too_much() const
    {
        constexpr double kMost = 100;
        return any_crowd_ && squares_ > kMost * corners_;
    }

private:
    double squares_ = 0, corners_ = 0;
    bool any_crowd_ = false;
};

/// A corner of a face: `local` is 0, 1 or 2.
struct FaceCorner {
    int face, local;
};

/// The combinatorics of the surface, which growth never changes. Indices are int: they are counted
/// down and compared with -1 all over, and a surface has fewer than 2^31 corners.
struct Connectivity {
    int vertices = 0;
    std::vector<Vec3I> faces;
    std::vector<int> first;           ///< vertex -> its first entry in `incident`; one past the end
    std::vector<FaceCorner> incident; ///< ascending by face
    Rims rims;
    std::vector<int> neighbour_first, neighbour; ///< vertex -> adjacent vertices, ascending
    std::vector<int> component;                  ///< by vertex
    int components = 0;
    bool has_crowds = false;              ///< fans are too much work (FanWork)
    std::vector<std::vector<int>> colour; ///< classes of vertices with no common neighbour

    int face_count() const { return static_cast<int>(faces.size()); }
    int corner(int face, int local) const { return static_cast<int>(faces[face][local]); }
    bool incident_to(int face, int vertex) const
    {
        return corner(face, 0) == vertex || corner(face, 1) == vertex || corner(face, 2) == vertex;
    }
    bool share_a_corner(int f, int g) const
    {
        return incident_to(g, corner(f, 0)) || incident_to(g, corner(f, 1)) ||
               incident_to(g, corner(f, 2));
    }
};

Connectivity connect(std::size_t vertices, const std::vector<Vec3I>& faces);

/// The iterable slice of a CSR list that belongs to one vertex.
template <class Entry> struct Slice {
    const Entry *first, *last;
    const Entry* begin() const { return first; }
    const Entry* end() const { return last; }
    int size() const { return static_cast<int>(last - first); }
};
inline Slice<FaceCorner> star(const Connectivity& c, int v)
{
    return {c.incident.data() + c.first[v], c.incident.data() + c.first[v + 1]};
}
/// The faces around a vertex, ascending.
std::vector<int> faces_at(const Connectivity& c, int v);
/// The faces around any of these vertices, ascending.
std::vector<int> faces_at(const Connectivity& c, const std::vector<int>& vertices);
inline Slice<int> neighbours(const Connectivity& c, int v)
{
    return {c.neighbour.data() + c.neighbour_first[v],
            c.neighbour.data() + c.neighbour_first[v + 1]};
}

} // namespace vdb_shell::growth
