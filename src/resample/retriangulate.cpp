// SPDX-License-Identifier: Apache-2.0

// Takes: an embedded surface. Gives: the same points and shape with other edges inside its flat
// parts. Modellers cut flat walls as they come: into needles from one side to the other, over which
// prisms have hardly any room (docs/measurements/retriangulation.md). Flips are Lawson's; each
// makes the ascending list of all triangles' smallest angles larger, so they end. That triangles
// stay turned as they are is tested exactly in the projection of the part. In a plane that is all
// there is to test; where a part is not exactly flat, what it covers in space changes by up to its
// thickness, so contacts are looked for afterwards, and parts that have any go back.

#include "vdb_shell/resample/retriangulate.h"

#include "core/exact.h"
#include "core/stage_progress.h"
#include "mesh/surface_defects.h"
#include "resample/flat_parts.h"
#include "resample/neighbours_across.h"
#include "resample/triangle_angle.h"
#include "vdb_shell/options/option.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace vdb_shell
{
namespace
{

using openvdb::Vec3d;
using openvdb::Vec3I;

// Of the diagonal. CAD programs write six digits, which round by up to 5e-7 of it.
constexpr double kTolerance = 1e-5;
// The smallest angle has to grow by more than rounding: a square has two cuts as good as each
// other.
constexpr double kLeastFactor = 1 + 1e-6;
// Triangles between two looks at the interrupter: some milliseconds.
constexpr std::size_t kBetweenLooks = 4096;

constexpr int after(int side)
{
    return (side + 1) % 3;
}

/// Turns edges of one part after the other.
class Flipper
{
public:
    Flipper(TriangleMesh& mesh, std::vector<NeighboursAcross> across,
            const std::vector<std::uint32_t>& part_of)
        : mesh_(mesh), across_(std::move(across)), part_of_(part_of),
          waits_(mesh.triangles.size(), 0)
    {
    }

    /// Returns the number of flips.
    std::size_t flip_all(const FlatPart& part, const StageProgress& progress, double percent)
    {
        std::size_t flips = 0;
        waiting_ = part.triangles;
        for (const std::uint32_t t : waiting_)
            waits_[t] = 1;
        for (std::size_t i = 0; i < waiting_.size(); ++i) {
            if (i % kBetweenLooks == kBetweenLooks - 1)
                progress.stop_if_interrupted(percent);
            waits_[waiting_[i]] = 0;
            for (int side = 0; side < 3; ++side)
                if (flip(waiting_[i], side, part)) {
                    ++flips;
                    side = -1; // the triangle has other sides now
                }
        }
        return flips;
    }

    /// Whether some flip was between triangles that are not exactly in one plane.
    bool bent() const { return bent_; }

private:
    int side_from(std::uint32_t t, std::uint32_t corner) const
    {
        const Vec3I& c = mesh_.triangles[t];
        return c[0] == corner ? 0 : c[1] == corner ? 1 : 2;
    }

    /// Grows with the smallest angle of the two: 1 - cos.
    double openness(const Vec3I& one, const Vec3I& other) const
    {
        const auto cosine = [&](const Vec3I& c) {
            return cosine_of_smallest_angle(Vec3d(mesh_.points[c[0]]), Vec3d(mesh_.points[c[1]]),
                                            Vec3d(mesh_.points[c[2]]));
        };
        return 1 - std::max(cosine(one), cosine(other));
    }

    /// Whether an edge joins them already, which is so where a part is folded back onto itself.
    bool joined(std::uint32_t t, std::uint32_t a, std::uint32_t b) const
    {
        for (const int step : {0, 2}) { // to the sides that leave a, and those that come to it
            std::uint32_t at = t;
            do {
                const Vec3I& c = mesh_.triangles[at];
                if (c[0] == b || c[1] == b || c[2] == b)
                    return true;
                at = across_[at][std::size_t((side_from(at, a) + step) % 3)];
            } while (at != kNoNeighbour && at != t);
            if (at == t)
                return false; // all round
        }
        return false;
    }

    void wait(std::uint32_t t, const FlatPart& part)
    {
        if (t == kNoNeighbour || waits_[t] || part_of_[t] != part_of_[part.triangles.front()])
            return;
        waits_[t] = 1;
        waiting_.push_back(t);
    }

    void set_across(std::uint32_t t, std::uint32_t corner, std::uint32_t neighbour)
    {
        if (t != kNoNeighbour)
            across_[t][std::size_t(side_from(t, corner))] = neighbour;
    }

    /// Turns the edge if that makes the smallest angle beside it larger.
    bool flip(std::uint32_t t, int side, const FlatPart& part)
    {
        const std::uint32_t u = across_[t][std::size_t(side)];
        if (u == kNoNeighbour || part_of_[u] != part_of_[t])
            return false;
        const Vec3I old_t = mesh_.triangles[t], old_u = mesh_.triangles[u];
        const std::uint32_t a = old_t[side], b = old_t[after(side)], c = old_t[after(after(side))];
        const int across_side = side_from(u, b);
        const std::uint32_t d = old_u[after(after(across_side))];
        const Vec3I new_t(a, d, c), new_u(d, b, c);
        if (c == d || !(openness(new_t, new_u) > kLeastFactor * openness(old_t, old_u)))
            return false;
        if (!turns(mesh_, new_t, part) || !turns(mesh_, new_u, part) || joined(t, c, d))
            return false;
        bent_ = bent_ || exact::orient3d(mesh_.points[a], mesh_.points[b], mesh_.points[c],
                                         mesh_.points[d]) != 0;
        const std::uint32_t bc = across_[t][std::size_t(after(side))],
                            ca = across_[t][std::size_t(after(after(side)))],
                            ad = across_[u][std::size_t(after(across_side))],
                            db = across_[u][std::size_t(after(after(across_side)))];
        mesh_.triangles[t] = new_t;
        mesh_.triangles[u] = new_u;
        across_[t] = {ad, u, ca};
        across_[u] = {db, bc, t};
        set_across(ad, d, t);
        set_across(bc, c, u);
        for (const std::uint32_t near : {u, ad, db, bc, ca})
            wait(near, part);
        return true;
    }

    TriangleMesh& mesh_;
    std::vector<NeighboursAcross> across_;
    const std::vector<std::uint32_t>& part_of_;
    std::vector<std::uint32_t> waiting_;
    std::vector<std::uint8_t> waits_; ///< by triangle, whether it is yet to be looked at
    bool bent_ = false;
};

/// Undoes parts whose triangles touch others, as long as there are any: their flips become 0.
/// Returns how many parts that were.
std::size_t undo_contacts(TriangleMesh& mesh, const TriangleMesh& before, const FlatParts& flat,
                          std::vector<std::size_t>& flips, Interrupter* interrupter)
{
    std::size_t undone = 0;
    while (true) {
        const std::size_t at_first = undone;
        for (const TrianglePair& pair : find_self_intersections(mesh, {}, interrupter))
            for (const std::uint32_t t : pair) {
                const std::uint32_t part = flat.part_of[t];
                if (part == kInNoPart || flips[part] == 0)
                    continue;
                flips[part] = 0;
                ++undone;
                for (const std::uint32_t member : flat.parts[part].triangles)
                    mesh.triangles[member] = before.triangles[member];
            }
        if (undone == at_first)
            return undone;
    }
}

} // namespace

OptionList describe(RetriangulateOptions& o)
{
    return in_group(
        "Resampling",
        {option("wanted", o.wanted, "--retriangulate",
                "Turn edges inside flat parts of the surface, so that they are cut into "
                "better triangles; points and shape stay"),
         option("tolerance", o.tolerance, "--retriangulate-tolerance",
                "Farthest that it may part the surfaces, world units; unset: 1e-5 of "
                "the diagonal")
             .in(Unit::world_length)
             .within(above(0))
             .needing("--retriangulate")});
}

RetriangulateResult retriangulate(const TriangleMesh& mesh, const RetriangulateOptions& options,
                                  Interrupter* interrupter)
{
    require_in_range(options, "retriangulate");
    const StageProgress progress(interrupter, "retriangulate");
    RetriangulateResult out;
    RetriangulateReport& report = out.report;
    report.tolerance = options.tolerance.value_or(kTolerance * diagonal_of(bounds_of(mesh.points)));
    report.shape_before = triangle_figures(mesh);
    std::vector<NeighboursAcross> across = neighbours_across(mesh.triangles);
    const FlatParts flat = flat_parts(mesh, across, report.tolerance);
    report.flat_parts = flat.parts.size();

    out.mesh = mesh;
    std::vector<std::size_t> flips;
    Flipper flipper(out.mesh, std::move(across), flat.part_of);
    for (const FlatPart& part : flat.parts) {
        const double percent = 100 * double(report.flat_triangles) / double(mesh.triangles.size());
        progress.stop_if_interrupted(percent);
        flips.push_back(flipper.flip_all(part, progress, percent));
        report.flat_triangles += part.triangles.size();
    }
    if (flipper.bent())
        report.kept_parts = undo_contacts(out.mesh, mesh, flat, flips, interrupter);
    for (std::size_t i = 0; i < flips.size(); ++i) {
        report.flips += flips[i];
        if (flips[i] > 0)
            report.farthest = std::max(report.farthest, flat.parts[i].thickness);
    }
    report.shape = triangle_figures(out.mesh);
    return out;
}

} // namespace vdb_shell
