// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/surfaces.h"

#include "vdb_shell/field/narrow_band.h"

#include "support/shapes.h"

#include <limits>
#include <map>
#include <utility>

namespace vdb_shell::bench
{
namespace
{

TriangleMesh make_mesh(Surface surface, std::int64_t size)
{
    const int n = static_cast<int>(size);
    return surface == Surface::icosphere ? test::icosphere(1.0, n)
                                         : test::torus(1.0, 0.4, n, 2 * n / 3);
}

GrowResult grow(Surface surface, std::int64_t size)
{
    const TriangleMesh& mesh = mesh_of(surface, size);
    const std::vector<double> no_cap(mesh.points.size(), std::numeric_limits<double>::infinity());
    return grow_shell(mesh, directions_of(surface, size), lengths_of(surface, size), no_cap, {},
                      {});
}

/// One kind of intermediate result, each made once.
template <typename Value> class Kept
{
public:
    template <typename Make> const Value& get(Surface surface, std::int64_t size, Make&& make)
    {
        const auto key = std::make_pair(surface, size);
        const auto found = values_.find(key);
        return found != values_.end() ? found->second : values_.emplace(key, make()).first->second;
    }

private:
    std::map<std::pair<Surface, std::int64_t>, Value> values_;
};

} // namespace

LevelSetOptions deep_options()
{
    LevelSetOptions options;
    options.resolution = kResolution;
    return options;
}

LevelSetOptions narrow_options(const TriangleMesh& mesh)
{
    LevelSetOptions options = deep_options();
    // The grid gets three voxels more than this: the half-width of a usual level set.
    constexpr double kNone = 1e-3;
    options.interior_depth = kNone * resolve_voxel_size(mesh, options);
    return options;
}

const char* name_of(Surface surface)
{
    return surface == Surface::icosphere ? "icosphere" : "torus";
}

const TriangleMesh& mesh_of(Surface surface, std::int64_t size)
{
    static Kept<TriangleMesh> kept;
    return kept.get(surface, size, [&] { return make_mesh(surface, size); });
}

const openvdb::FloatGrid& deep_field_of(Surface surface, std::int64_t size)
{
    static Kept<openvdb::FloatGrid::Ptr> kept;
    return *kept.get(surface, size,
                     [&] { return mesh_to_level_set(mesh_of(surface, size), deep_options()); });
}

const openvdb::FloatGrid& narrow_field_of(Surface surface, std::int64_t size)
{
    static Kept<openvdb::FloatGrid::Ptr> kept;
    const TriangleMesh& mesh = mesh_of(surface, size);
    return *kept.get(surface, size, [&] { return mesh_to_narrow_band(mesh, deep_options()); });
}

const Directions& directions_of(Surface surface, std::int64_t size)
{
    static Kept<Directions> kept;
    return kept.get(surface, size, [&] {
        return compute_directions(mesh_of(surface, size), narrow_field_of(surface, size), {});
    });
}

const LineLengths& lengths_of(Surface surface, std::int64_t size)
{
    static Kept<LineLengths> kept;
    return kept.get(surface, size, [&] {
        return line_step(mesh_of(surface, size), deep_field_of(surface, size),
                         directions_of(surface, size), {});
    });
}

const GrowResult& shell_of(Surface surface, std::int64_t size)
{
    static Kept<GrowResult> kept;
    return kept.get(surface, size, [&] { return grow(surface, size); });
}

const TetMesh& tets_of(Surface surface, std::int64_t size)
{
    static Kept<TetMesh> kept;
    return kept.get(surface, size, [&] {
        const GrowResult& grown = shell_of(surface, size);
        return make_tets(grown.shell, grown.split);
    });
}

} // namespace vdb_shell::bench
