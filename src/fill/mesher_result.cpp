// SPDX-License-Identifier: Apache-2.0

// What is done with a mesher's tets before they are held against the shell: those outside the void
// are left out, and points get float32 coordinates. Nothing here decides whether the tets are
// sound; certify_core does.

#include "fill/mesher_result.h"

#include "vdb_shell/shell/quality.h"

#include "core/bucket_sort.h"
#include "core/exact.h"
#include "core/stage_stop.h"
#include "shell/tet_faces.h"

#include <algorithm>
#include <array>
#include <functional>
#include <limits>
#include <map>
#include <tuple>

namespace vdb_shell::fill
{
namespace
{

using openvdb::Vec3d;
using openvdb::Vec3I;
using openvdb::Vec3s;
using openvdb::Vec4I;

/// A face of a tet, or a triangle of the surface (`wall`); `owner` is the tet or the triangle.
struct Face {
    std::array<std::uint32_t, 3> turned; ///< the smallest corner first, in the face's direction
    bool wall;
    std::uint32_t owner;
    /// The same for both directions.
    std::array<std::uint32_t, 3> corners() const
    {
        return {turned[0], std::min(turned[1], turned[2]), std::max(turned[1], turned[2])};
    }
};

/// Those of the same corners come together, tets before walls.
bool operator<(const Face& x, const Face& y)
{
    return std::make_tuple(x.corners(), x.wall, x.turned, x.owner) <
           std::make_tuple(y.corners(), y.wall, y.turned, y.owner);
}

Face face_of(const Vec3I& f, bool wall, std::uint32_t owner)
{
    const int k = f[0] < f[1] ? (f[0] < f[2] ? 0 : 2) : (f[1] < f[2] ? 1 : 2);
    return {{f[k], f[(k + 1) % 3], f[(k + 2) % 3]}, wall, owner};
}

std::vector<Face> sorted_faces(const MesherTets& made, const TriangleMesh& surface)
{
    std::vector<Face> faces;
    for (std::uint32_t t = 0; t < made.tets.size(); ++t)
        for (std::size_t corner = 0; corner < 4; ++corner)
            faces.push_back(face_of(tet_face(made.tets[t], corner), false, t));
    for (std::uint32_t t = 0; t < surface.triangles.size(); ++t)
        faces.push_back(face_of(surface.triangles[t], true, t));
    const auto smallest = [](const Face& face) { return face.turned[0]; };
    const std::size_t points = std::max(made.points.size(), surface.points.size());
    // By the smallest corner first: as many buckets as points, each with a few faces.
    return bucket_sort<Face>(std::array{std::move(faces)}, points, smallest, std::less<>());
}

/// A few directions of a cube: its faces and its corners.
const std::vector<Vec3d>& directions()
{
    static const std::vector<Vec3d> all = [] {
        std::vector<Vec3d> made;
        for (int x = -1; x <= 1; ++x)
            for (int y = -1; y <= 1; ++y)
                for (int z = -1; z <= 1; ++z)
                    if (const int square = x * x + y * y + z * z; square == 1 || square == 3)
                        made.push_back(Vec3d(x, y, z).unit());
        return made;
    }();
    return all;
}

/// Moves single points until no tet is flat, or none can be made better.
class Untangling
{
public:
    Untangling(std::vector<Vec3s>& points, std::size_t fixed, const std::vector<Vec4I>& tets)
        : points_(points), fixed_(fixed), tets_(tets), around_(points.size())
    {
        // Which tets a point has, once for all rounds: points move, tets do not change.
        for (std::uint32_t t = 0; t < tets.size(); ++t)
            for (int corner = 0; corner < 4; ++corner)
                around_[tets[t][corner]].push_back(t);
    }

    std::size_t run()
    {
        // A point that stands in the way of another is moved in the round after.
        constexpr int kRounds = 20;
        std::vector<char> moved(points_.size(), 0);
        for (int round = 0; round < kRounds; ++round) {
            bool changed = false;
            for (std::size_t t = 0; t < tets_.size(); ++t) {
                stop_if_stage_wants(t);
                const Vec4I& tet = tets_[t];
                for (int corner = 0; corner < 4 && flat(tet); ++corner)
                    // Points of the surface are the shell's and must not move by a bit.
                    if (tet[corner] >= fixed_ && improve(tet[corner])) {
                        moved[tet[corner]] = 1;
                        changed = true;
                    }
            }
            if (!changed)
                break;
        }
        return std::size_t(std::count(moved.begin(), moved.end(), 1));
    }

private:
    bool positive(const Vec4I& t) const
    {
        return exact::orient3d(points_[t[0]], points_[t[1]], points_[t[2]], points_[t[3]]) > 0;
    }

    double shape(const Vec4I& t) const
    {
        return mean_ratio(Vec3d(points_[t[0]]), Vec3d(points_[t[1]]), Vec3d(points_[t[2]]),
                          Vec3d(points_[t[3]]));
    }

    /// Not positive, or so close to it that a solver cannot use it; the regular tet has 1. Of a tet
    /// between four points of one surface nothing can be moved.
    bool flat(const Vec4I& t) const
    {
        constexpr double kFlat = 0.02;
        return shape(t) < kFlat || !positive(t);
    }

    /// Tets around the point that are not positive, and by how much tets fall short of a modest
    /// shape: fewer are better, then less is. A sum and not the worst, which may be of a tet that
    /// this point cannot help.
    std::pair<std::size_t, double> badness(std::uint32_t point) const
    {
        constexpr double kModest = 0.1;
        std::size_t bad = 0;
        double lacking = 0;
        for (const std::uint32_t t : around_[point]) {
            bad += positive(tets_[t]) ? 0 : 1;
            lacking += std::max(0.0, kModest - shape(tets_[t]));
        }
        return {bad, lacking};
    }

    double shortest_edge(std::uint32_t point) const
    {
        double shortest = std::numeric_limits<double>::max();
        for (const std::uint32_t t : around_[point])
            for (int corner = 0; corner < 4; ++corner)
                if (tets_[t][corner] != point)
                    shortest = std::min(
                        shortest,
                        (Vec3d(points_[tets_[t][corner]]) - Vec3d(points_[point])).length());
        return shortest;
    }

    /// Takes the best of a few places about the point, near ones and farther ones.
    bool improve(std::uint32_t point)
    {
        const Vec3d here(points_[point]);
        Vec3s best = points_[point];
        auto least = badness(point);
        const Vec3s before = best;
        // From the shortest edge down to 1e-6 of it, where float32 end.
        constexpr int kSteps = 10;
        double step = shortest_edge(point);
        for (int i = 0; i < kSteps; ++i, step /= 4)
            for (const Vec3d& direction : directions()) {
                points_[point] = Vec3s(here + step * direction);
                const auto badness_there = badness(point);
                // From where the point stands and not from the best so far, so the order of
                // directions decides only between equals, for the first.
                if (badness_there < least) {
                    least = badness_there;
                    best = points_[point];
                }
            }
        points_[point] = best;
        return best != before;
    }

    std::vector<Vec3s>& points_;
    std::size_t fixed_;
    const std::vector<Vec4I>& tets_;
    std::vector<std::vector<std::uint32_t>> around_;
};

/// A tet, as it is or turned over.
struct Oriented {
    std::uint32_t tet;
    bool turned;
};

struct Neighbours {
    /// By tet: those across faces that are no walls, turned where the two lie on one side of the
    /// face as they stand.
    std::vector<std::vector<Oriented>> across;
    /// By tet, for each of its faces that is a wall: whether it stands behind that wall.
    std::vector<std::vector<bool>> walls;
};

Neighbours neighbours_of(const MesherTets& made, const TriangleMesh& surface)
{
    const std::vector<Face> faces = sorted_faces(made, surface);
    Neighbours neighbours;
    neighbours.across.resize(made.tets.size());
    neighbours.walls.resize(made.tets.size());
    for (std::size_t first = 0, last = 0; first < faces.size(); first = last) {
        std::size_t walls = 0;
        while (last < faces.size() && faces[last].corners() == faces[first].corners())
            walls += faces[last++].wall ? 1 : 0;
        const std::size_t owners = last - first - walls;
        for (std::size_t i = first; walls > 0 && i < first + owners; ++i)
            // Seen from its tet, the triangle runs as it does seen from outside the void.
            neighbours.walls[faces[i].owner].push_back(faces[i].turned == faces[last - 1].turned);
        // A wall parts the inside from the outside, so nothing hangs together across it. A face of
        // three tets or more parts them too: the certificate refuses it.
        if (walls > 0 || owners != 2)
            continue;
        const Face &x = faces[first], &y = faces[first + 1];
        neighbours.across[x.owner].push_back({y.owner, x.turned == y.turned});
        neighbours.across[y.owner].push_back({x.owner, x.turned == y.turned});
    }
    return neighbours;
}

/// All that hang together with the root, oriented as it is: a mesher tells the orientation of a
/// flat tet by a rounded volume, which may be wrong, and its neighbours know better.
std::vector<Oriented> piece_of(const Neighbours& neighbours, Oriented root, std::vector<char>& seen)
{
    std::vector<Oriented> piece{root};
    seen[root.tet] = 1;
    for (std::size_t i = 0; i < piece.size(); ++i) {
        const Oriented here = piece[i];
        for (const Oriented& next : neighbours.across[here.tet])
            if (!seen[next.tet]) {
                seen[next.tet] = 1;
                piece.push_back({next.tet, here.turned != next.turned});
            }
    }
    return piece;
}

} // namespace

std::vector<Vec4I> tets_inside(const MesherTets& made, const TriangleMesh& surface)
{
    const Neighbours neighbours = neighbours_of(made, surface);
    std::vector<char> seen(made.tets.size(), 0);
    std::vector<Vec4I> kept;
    for (std::uint32_t root = 0; root < made.tets.size(); ++root) {
        // A piece begins at a tet with a wall, which says how its tets have to be turned. A piece
        // without any is none of the void's.
        if (seen[root] || neighbours.walls[root].empty())
            continue;
        // Inside the void the root runs as its wall says.
        const std::vector<Oriented> piece =
            piece_of(neighbours, {root, !neighbours.walls[root].front()}, seen);
        std::ptrdiff_t votes = 0;
        for (const Oriented& one : piece)
            for (const bool agrees : neighbours.walls[one.tet])
                // A count decides and no single wall, for single tets may be turned wrongly.
                votes += agrees ? 1 : -1;
        if (votes <= 0)
            continue;
        for (const Oriented& one : piece) {
            kept.push_back(made.tets[one.tet]);
            if (one.turned)
                std::swap(kept.back()[2], kept.back()[3]);
        }
    }
    return kept;
}

void close_cut_triangles(MesherTets& inside, const TriangleMesh& surface)
{
    const std::vector<Face> faces = sorted_faces(inside, surface);
    // Of the faces that should not be there: the new points, by each pair of other corners.
    std::multimap<std::array<std::uint32_t, 2>, std::uint32_t> cuts;
    std::vector<std::uint32_t> missing;
    for (std::size_t first = 0, last = 0; first < faces.size(); first = last) {
        while (last < faces.size() && faces[last].corners() == faces[first].corners())
            ++last;
        const auto corners = faces[first].corners();
        if (last - first != 1)
            continue;
        // A triangle of the surface that no tet has.
        if (faces[first].wall)
            missing.push_back(faces[first].owner);
        // Ascending, and new points have the largest numbers.
        else if (corners[2] >= surface.points.size() && corners[1] < surface.points.size())
            cuts.insert({{corners[0], corners[1]}, corners[2]});
    }
    for (const std::uint32_t wall : missing) {
        const Vec3I& t = surface.triangles[wall];
        std::map<std::uint32_t, int> sides;
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t a = t[k], b = t[(k + 1) % 3];
            const auto [begin, end] = cuts.equal_range({std::min(a, b), std::max(a, b)});
            for (auto cut = begin; cut != end; ++cut)
                ++sides[cut->second];
        }
        // A point on an edge makes faces with the other two, one inside with all three.
        for (const auto& [point, count] : sides)
            if (count >= 2) {
                inside.tets.emplace_back(t[0], t[2], t[1], point);
                break;
            }
    }
}

std::vector<Vec3s> rounded_points(const std::vector<Vec3d>& points, std::size_t fixed,
                                  const std::vector<Vec4I>& tets, std::size_t& moved)
{
    std::vector<Vec3s> rounded(points.begin(), points.end());
    moved = Untangling(rounded, fixed, tets).run();
    return rounded;
}

} // namespace vdb_shell::fill
