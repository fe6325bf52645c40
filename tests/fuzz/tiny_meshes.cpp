// SPDX-License-Identifier: Apache-2.0
#include "fuzz/targets.h"

#include "support/shapes.h"
#include "vdb_shell/certify/overlaps.h"
#include "vdb_shell/core/error.h"
#include "vdb_shell/pipeline.h"

#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <cstring>

// Every change keeps each edge in as many triangles as before, or merges two edges: so the surface
// stays closed, whatever else it becomes.

namespace vdb_shell::fuzz
{
namespace
{

using openvdb::Vec3d;
using openvdb::Vec3I;
using openvdb::Vec3s;

class Bytes
{
public:
    explicit Bytes(std::string_view bytes) : rest_(bytes) {}
    bool empty() const { return rest_.empty(); }
    std::uint32_t next()
    {
        const auto value = rest_.empty() ? 0u : std::uint32_t(std::uint8_t(rest_[0]));
        rest_.remove_prefix(rest_.empty() ? 0 : 1);
        return value;
    }
    std::uint32_t below(std::size_t limit) { return limit ? next() % std::uint32_t(limit) : 0; }
    /// Of a lattice about the origin, where much is flat, in a line or in one place.
    float coordinate() { return (float(next()) - 128) / 32; }
    float any_float()
    {
        std::uint32_t bits = 0;
        for (int k = 0; k < 4; ++k)
            bits = bits << 8 | next();
        float value = 0;
        std::memcpy(&value, &bits, sizeof value);
        return std::abs(value) <= float(kLargestCoordinate) ? value : 0;
    }

private:
    std::string_view rest_;
};

/// Readers refuse what is larger.
Vec3s within_limit(Vec3s p)
{
    for (int axis = 0; axis < 3; ++axis)
        p[axis] = std::clamp(p[axis], -float(kLargestCoordinate), float(kLargestCoordinate));
    return p;
}

TriangleMesh first_surface(Bytes& bytes)
{
    switch (bytes.below(6)) {
    case 0:
        return test::unit_tetrahedron();
    case 1:
        return test::box(Vec3d(-1), Vec3d(1));
    case 2:
        return test::icosphere(1, 0);
    case 3:
        return test::torus(1, 0.4, 3, 3);
    case 4:
        return test::joined(test::icosphere(1, 0),
                            test::reversed(test::box(Vec3d(-0.25), Vec3d(0.25))));
    default:
        return test::joined(test::unit_tetrahedron(), test::unit_tetrahedron());
    }
}

/// A point on the triangle becomes a vertex.
void split_triangle(TriangleMesh& mesh, Bytes& bytes)
{
    const std::size_t at = bytes.below(mesh.triangles.size());
    const Vec3I t = mesh.triangles[at];
    const auto added = std::uint32_t(mesh.points.size());
    mesh.points.push_back(Vec3s(
        (Vec3d(mesh.points[t[0]]) + Vec3d(mesh.points[t[1]]) + Vec3d(mesh.points[t[2]])) / 3));
    mesh.triangles[at] = {t[0], t[1], added};
    mesh.triangles.push_back({t[1], t[2], added});
    mesh.triangles.push_back({t[2], t[0], added});
}

/// The triangle behind an edge that runs from a to b in another; the number of triangles if none.
std::size_t behind(const TriangleMesh& mesh, std::uint32_t a, std::uint32_t b, Vec3I& turned)
{
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
        for (int k = 0; k < 3; ++k) {
            const Vec3I& t = mesh.triangles[i];
            turned = {t[k], t[(k + 1) % 3], t[(k + 2) % 3]};
            if (turned[0] == b && turned[1] == a)
                return i;
        }
    return mesh.triangles.size();
}

/// The edge in the middle of two triangles is cut in two, or turned.
void change_edge(TriangleMesh& mesh, Bytes& bytes, bool cut)
{
    const std::size_t at = bytes.below(mesh.triangles.size());
    const Vec3I t = mesh.triangles[at];
    Vec3I other;
    const std::size_t opposite = behind(mesh, t[0], t[1], other);
    if (opposite == mesh.triangles.size() || opposite == at || other[2] == t[2])
        return;
    if (!cut) {
        mesh.triangles[at] = {t[2], t[0], other[2]};
        mesh.triangles[opposite] = {t[2], other[2], t[1]};
        return;
    }
    const auto added = std::uint32_t(mesh.points.size());
    mesh.points.push_back(Vec3s((Vec3d(mesh.points[t[0]]) + Vec3d(mesh.points[t[1]])) / 2));
    mesh.triangles[at] = {t[0], added, t[2]};
    mesh.triangles.push_back({added, t[1], t[2]});
    mesh.triangles[opposite] = {t[1], added, other[2]};
    mesh.triangles.push_back({added, t[0], other[2]});
}

/// All triangles of one vertex are given to another; those that then repeat a corner go.
void merge_vertices(TriangleMesh& mesh, Bytes& bytes)
{
    const std::uint32_t from = bytes.below(mesh.points.size()),
                        to = bytes.below(mesh.points.size());
    std::vector<Vec3I> kept;
    for (Vec3I t : mesh.triangles) {
        for (int k = 0; k < 3; ++k)
            t[k] = t[k] == from ? to : t[k];
        if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0])
            kept.push_back(t);
    }
    if (!kept.empty())
        mesh.triangles = std::move(kept);
}

void move_vertex(TriangleMesh& mesh, Bytes& bytes, int how)
{
    Vec3s& p = mesh.points[bytes.below(mesh.points.size())];
    if (how == 0)
        p = {bytes.coordinate(), bytes.coordinate(), bytes.coordinate()};
    else if (how == 1)
        p[int(bytes.below(3))] = bytes.any_float();
    else
        p = mesh.points[bytes.below(mesh.points.size())];
}

void change_all(TriangleMesh& mesh, Bytes& bytes)
{
    const float factor = std::ldexp(1.0F, int(bytes.below(64)) - 32);
    // Braces: the order in which the bytes are taken is that of the compiler otherwise.
    const Vec3s by{bytes.coordinate(), bytes.coordinate(), bytes.coordinate()};
    for (Vec3s& p : mesh.points)
        p = within_limit((p + by) * factor);
}

void change(TriangleMesh& mesh, Bytes& bytes)
{
    switch (bytes.below(10)) {
    case 0:
    case 1:
        return move_vertex(mesh, bytes, 0);
    case 2:
        return move_vertex(mesh, bytes, 1);
    case 3:
        return move_vertex(mesh, bytes, 2);
    case 4:
        return split_triangle(mesh, bytes);
    case 5:
        return change_edge(mesh, bytes, true);
    case 6:
        return change_edge(mesh, bytes, false);
    case 7:
        return merge_vertices(mesh, bytes);
    case 8:
        return change_all(mesh, bytes);
    default:
        if (mesh.triangles.size() < 40)
            mesh = test::joined(
                std::move(mesh),
                test::translated(test::unit_tetrahedron(),
                                 {bytes.coordinate(), bytes.coordinate(), bytes.coordinate()}));
    }
}

/// Points that no triangle uses are dropped by readers; the library is given none.
TriangleMesh without_unused(const TriangleMesh& mesh)
{
    TriangleMesh result;
    std::vector<std::uint32_t> number(mesh.points.size(), UINT32_MAX);
    for (Vec3I t : mesh.triangles) {
        for (int k = 0; k < 3; ++k) {
            if (number[t[k]] == UINT32_MAX) {
                number[t[k]] = std::uint32_t(result.points.size());
                result.points.push_back(mesh.points[t[k]]);
            }
            t[k] = number[t[k]];
        }
        result.triangles.push_back(t);
    }
    return result;
}

/// Away from the origin by a power of two, so that coordinates of the lattice stay in it.
void move_to_one_side(TriangleMesh& mesh)
{
    float farthest = 0;
    for (const Vec3s& p : mesh.points)
        for (int axis = 0; axis < 3; ++axis)
            farthest = std::max(farthest, std::abs(p[axis]));
    const float by = farthest > 0 ? std::ldexp(1.0F, std::ilogb(farthest) + 3) : 0;
    for (Vec3s& p : mesh.points)
        p = within_limit(p + Vec3s(by));
}

/// No grid is large, and no loop long: time goes into many inputs.
ShellOptions some_options(std::uint32_t resolution, Bytes& bytes)
{
    ShellOptions o;
    o.level_set.resolution = 8 + int(resolution % 9);
    o.coverage.samples = 0;
    o.grow.free_rounds = 4;
    const std::uint32_t how = bytes.next();
    o.grow.method = how % 2 ? Method::thickest : Method::certified;
    o.mend = how % 8 == 6;
    // A wrap has the triangles of a tiny surface as well: of sixteen voxels it has thousands, and
    // takes twenty seconds.
    o.wrap.resolution = 4 + int(resolution % 3);
    const std::uint32_t side = bytes.below(8);
    o.side = side == 7 ? Side::both : side == 6 ? Side::outward : Side::inward;
    if ((how & 32) && o.side != Side::outward)
        o.grow.enough_fill = 0.75;
    const std::uint32_t bits = bytes.next();
    if (bits & 1)
        o.line_step.thickness = 0.125;
    // Outward a thickness makes the level set as deep as that, whatever the size of the surface.
    o.level_set.max_memory_gib = 0.04;
    if (bits & 2)
        o.repair.emplace().drop_loose = how & 16;
    if (bits & 4)
        o.layers.layers = int(bytes.below(4));
    if (bits & 8)
        o.taper.wanted = true;
    if (bits & 16)
        o.taper.core = CoreSurface::stitched;
    if (bits & 32)
        o.check.turn_inside_out = true;
    if (bits & 64)
        o.scale.factor = 0.5;
    if (bits & 128)
        o.split.rule = SplitRule(bytes.below(4));
    return o;
}

} // namespace

void tiny_meshes(std::string_view input)
{
    static const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
    // About the origin a grid has eight nodes of 32^3 below its root instead of one, and to clear
    // them takes nine tenths of the time: so few surfaces stand there.
    constexpr std::uint32_t kAboutTheOrigin = 27;
    Bytes bytes(input);
    const std::uint32_t first = bytes.next();
    const ShellOptions options = some_options(first, bytes);
    TriangleMesh mesh = first_surface(bytes);
    for (int changes = 0; changes < 24 && !bytes.empty(); ++changes)
        change(mesh, bytes);
    if (first >= kAboutTheOrigin)
        move_to_one_side(mesh);
    try {
        const ShellResult result = build_shell(without_unused(mesh), options, "fuzz");
        const std::string faults = faults_of(result.report);
        require(faults.empty(), "the shell is not valid: " + faults);
        const Overlaps overlaps = find_overlaps(result.tets);
        require(overlaps.none(), "tets overlap: " + overlaps.summary());
    } catch (const GeometryError& error) {
        require(*error.what() != '\0', "refused without a word");
    } catch (const InvalidOption&) {
    }
}

} // namespace vdb_shell::fuzz
