// SPDX-License-Identifier: Apache-2.0
// Gives each vertex the direction of its line: the angle-weighted pseudo-normal of the mesh
// (Baerentzen and Aanaes, "Signed Distance Computation Using the Angle Weighted Pseudonormal",
// 2005) or the gradient of the field, tilted at random if the user wants that. Both depend on mesh,
// field and seed only. A vertex where the source gives no direction keeps the zero vector, which
// line stepping reports as "no_direction". Normals and gradients point outward; what is returned
// points inward.

#include "vdb_shell/step/directions.h"

#include "core/counter_random.h"
#include "core/parallel.h"
#include "core/unit_vector.h"
#include "field/field_sampler.h"
#include "step/most_radians.h"
#include "vdb_shell/core/error.h"
#include "vdb_shell/mesh/normals.h"
#include "vdb_shell/options/option.h"

#include <cassert>
#include <cmath>

namespace vdb_shell
{

using openvdb::Vec3d;

namespace
{

/// The upper 53 bits, all that a double holds, as a number from -1 up to but not including 1. The
/// standard library's distributions are not used, because each library may compute them in another
/// way.
double signed_unit(std::uint64_t bits)
{
    return static_cast<double>(bits >> 11) * 0x1p-52 - 1.0;
}

struct Disk {
    double x, y;
};

/// A point of the unit disk for a vertex, by rejection: no trigonometry, so no difference between
/// mathematics libraries.
Disk disk_point(std::uint64_t seed, std::size_t vertex)
{
    // The numbers are a function of seed and vertex alone, without a state that threads would have
    // to share. The seed is hashed first, so that seeds that differ by one do not merely exchange
    // the numbers of two vertices.
    const std::uint64_t stream = splitmix64(splitmix64(seed) ^ vertex);
    for (std::uint64_t draw = 0;; draw += 2) {
        const Disk p{signed_unit(splitmix64(stream + draw)),
                     signed_unit(splitmix64(stream + draw + 1))};
        if (p.x * p.x + p.y * p.y <= 1)
            return p;
    }
}

Vec3d tilted(const Vec3d& direction, const Disk& offset, double tangent)
{
    const Vec3d u = at_right_angles_to(direction).unit(); // any frame does
    const Vec3d v = direction.cross(u);
    return (direction + tangent * (offset.x * u + offset.y * v)).unit();
}

} // namespace

const NameTable<DirectionSource>& names(DirectionSource)
{
    static const NameTable<DirectionSource> table{{"pseudo-normal", DirectionSource::pseudo_normal},
                                                  {"gradient", DirectionSource::gradient}};
    return table;
}

OptionList describe(DirectionOptions& o)
{
    return in_group("Lines", {option("source", o.source, "--directions",
                                     "Where the lines' directions come from"),
                              option("perturbation_radians", o.perturbation_radians, "--perturb",
                                     "Largest random tilt of a direction, radians")
                                  .in(Unit::radians)
                                  .within(at_least(0).below(kMostRadians)),
                              option("seed", o.seed, "--perturb-seed", "Seed of the random tilt")
                                  .needing("--perturb")
                                  .in(Unit::seed)});
}

Directions directions_along(const TriangleMesh& mesh, std::vector<Vec3d> outward)
{
    Directions directions;
    directions.visibility = visibility_of(mesh, outward);
    directions.inward = std::move(outward);
    for (Vec3d& d : directions.inward)
        d = -d;
    return directions;
}

Directions compute_directions(const TriangleMesh& mesh, const openvdb::FloatGrid& level_set,
                              const DirectionOptions& options)
{
    require_in_range(options, "directions");
    std::vector<Vec3d> outward;
    if (options.source == DirectionSource::pseudo_normal) {
        outward = pseudo_normals(mesh);
    } else {
        outward.resize(mesh.points.size());
        for_each_range(outward.size(), [&](std::size_t begin, std::size_t end) {
            FieldSampler field(level_set);
            for (std::size_t v = begin; v < end; ++v)
                outward[v] = unit_or_zero(field.at(Vec3d(mesh.points[v])).gradient, 1.0);
        });
    }
    if (options.perturbation_radians > 0) {
        const double tangent = std::tan(options.perturbation_radians);
        for_each_index(outward.size(), [&](std::size_t v) {
            if (outward[v].lengthSqr() > 0)
                outward[v] = tilted(outward[v], disk_point(options.seed, v), tangent);
        });
    }
    return directions_along(mesh, std::move(outward));
}

} // namespace vdb_shell
