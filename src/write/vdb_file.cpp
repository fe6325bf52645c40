// SPDX-License-Identifier: Apache-2.0

// Writes a shell as .vdb (level set, depth, three grids of points, metadata) and reads it back bit
// for bit. Reading trusts nothing: all that OpenVDB goes by is walked before OpenVDB sees the file
// (io), the metadata and the grids are checked by their own readers, and last the checksum of all
// arrays. Whatever a library throws at damaged data leaves here as ReadError. A trap: floats are
// certified in the mesh's own frame, so grids are moved by their transforms only and no coordinate
// is ever changed.

#include "vdb_shell/write/vdb_file.h"

#include "vdb_shell/core/error.h"
#include "vdb_shell/options/option.h"
#include "vdb_shell/options/option_value.h"

#include "core/parallel.h"
#include "core/point_grid_instances.h"
#include "io/vdb_archive.h"
#include "io/vdb_grids.h"
#include "io/vdb_seal.h"
#include "vdb_shell/core/output_set.h"
#include "vdb_shell/io/read_file.h"
#include "write/core_feet_grid.h"
#include "write/core_grids.h"
#include "write/file_digests.h"
#include "write/input_points_grid.h"
#include "write/point_grids.h"
#include "write/vdb_metadata.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

namespace vdb_shell
{
namespace
{

namespace fs = std::filesystem;
using openvdb::FloatGrid;
using openvdb::GridBase;

constexpr const char* kSurfaceGrid = "surface";
constexpr const char* kDepthGrid = "depth";

/// Half floats beyond 65504 become infinite without a word. All values are looked at, tiles and
/// inactive voxels too, because those may be written as well.
void require_half_range(const FloatGrid& grid, const fs::path& path)
{
    constexpr double kLargestHalf = 65504.0;
    double largest = std::abs(double(grid.background()));
    for (auto value = grid.cbeginValueAll(); value; ++value)
        largest = std::max(largest, std::abs(double(*value)));
    if (largest > kLargestHalf)
        throw InvalidOption(path.string() + ": grid \"" + grid.getName() +
                            "\" has a value of magnitude " + text_of(largest) +
                            "; half floats end at 65504, write it without --half");
}

/// Moves a grid by its transform alone, which has doubles, so that no voxel and no point is
/// touched. Precondition: voxels are cubes along the axes, as the grids of a shell that was read
/// from a mesh are.
void put_in_place(GridBase& grid, const openvdb::Vec3d& shift)
{
    if (shift == openvdb::Vec3d(0.0))
        return;
    // Not a copy of the transform: OpenVDB takes that one's voxel size from a matrix, as a
    // difference of far places.
    const openvdb::Vec3d there = grid.indexToWorld(openvdb::Vec3d(0.0)) + shift;
    const auto moved = openvdb::math::Transform::createLinearTransform(grid.voxelSize()[0]);
    if (there != openvdb::Vec3d(0.0))
        moved->postTranslate(there);
    grid.setTransform(moved);
}

/// A copy with its own name, metadata and transform that shares the voxels with the caller's grid:
/// it costs no memory to speak of, and the caller's grid stays as it is.
FloatGrid::Ptr named_copy(const FloatGrid::ConstPtr& grid, const char* name, bool half,
                          const Placement& placement, const fs::path& path)
{
    if (!grid)
        throw InvalidOption(path.string() + ": the shell cannot be written as .vdb: grid \"" +
                            name + "\" is missing");
    FloatGrid::Ptr copy = openvdb::ConstPtrCast<FloatGrid>(grid)->copy();
    copy->setName(name);
    copy->setCreator(creator_name());
    copy->setSaveFloatAsHalf(half);
    put_in_place(*copy, placement.shift());
    if (half)
        require_half_range(*copy, path);
    return copy;
}

/// A file of which all is known before a grid is decoded.
struct OpenFile {
    explicit OpenFile(const fs::path& where)
        : path(where), file(where.string()), digests(metadata_of(file), where)
    {
    }
    static openvdb::MetaMap metadata_of(openvdb::io::File& file)
    {
        open_vdb(file);
        return *file.getMetadata();
    }
    ShellInfo info() const { return info_from_metadata(*file.getMetadata(), path); }

    fs::path path;
    openvdb::io::File file;
    StatedDigests digests;
};

template <typename Grid> typename Grid::Ptr read_grid(OpenFile& from, const char* name)
{
    openvdb::io::File& file = from.file;
    const std::string where = from.path.string();
    if (!file.hasGrid(name))
        throw ReadError(where + ": grid \"" + name + "\" is missing");
    // The type comes first: grids of other types have not been held against the file, so nothing
    // may decode them.
    const std::string type = file.readGridMetadata(name)->type();
    if (type != Grid::gridType())
        throw ReadError(where + ": grid \"" + name + "\" has type " + type + ", expected " +
                        Grid::gridType());
    auto grid = openvdb::gridPtrCast<Grid>(file.readGrid(name));
    from.digests.require(*grid);
    return grid;
}

/// All that lies in the file of the points; the core's only where there is one.
struct AllPoints {
    PointGrids shell;
    CoreGrids core;
    openvdb::points::PointDataGrid::Ptr input;
};

AllPoints read_points_of(OpenFile& file, const ShellInfo& info)
{
    using openvdb::points::PointDataGrid;
    return {{read_grid<PointDataGrid>(file, kPointsGrid),
             read_grid<PointDataGrid>(file, kPrismsGrid),
             read_grid<PointDataGrid>(file, kTetsGrid)},
            info.core_tets > 0 ? CoreGrids{read_grid<PointDataGrid>(file, kCorePointsGrid),
                                           read_grid<PointDataGrid>(file, kCoreTetsGrid)}
                               : CoreGrids{},
            info.input_points > 0 ? read_grid<PointDataGrid>(file, kInputPointsGrid) : nullptr};
}

void require_consistent_rest(const ShellFile& file)
{
    if (!file.rest.posed())
        return;
    const auto fit = [&](const PointVectors& vectors) {
        bool fits = vectors.surface.size() == file.stack.surfaces() &&
                    vectors.core.size() == file.core.points.size();
        for (const std::vector<openvdb::Vec3s>& surface : vectors.surface)
            fits = fits && surface.size() == file.stack.surface(0).size();
        return fits;
    };
    if (!fit(file.rest) || !(file.rest.velocity.empty() || fit(file.rest.velocity)))
        throw InvalidOption("the shell cannot be written: its points at rest or their velocities "
                            "are not as many as its points");
}

/// With digests of all that it holds.
void write_sealed(const fs::path& path, openvdb::GridPtrVec grids, openvdb::MetaMap metadata)
{
    // Last of all, as the digest is of all other entries; the seal needs the bytes of the file.
    add_digests(metadata, grids);
    seal_vdb(path, write_vdb_archive(path, std::move(grids), metadata));
}

/// Adds the digests of another file to those of the first.
AllPoints find_points(OpenFile& main, const ShellInfo& info, std::size_t& digests)
{
    if (info.points_at == main.path)
        return read_points_of(main, info);
    return reading_vdb(info.points_at, [&] {
        OpenFile beside(info.points_at);
        // Names prove nothing: a file of the same name may be left from an earlier run.
        const std::string found = beside.info().checksum;
        if (found != info.checksum)
            throw ReadError(info.points_at.string() +
                            ": its points are those of another shell: checksum " + found +
                            ", expected " + info.checksum);
        digests += beside.digests.count();
        return read_points_of(beside, info);
    });
}

/// The volumes of a file as they are written, in their order there.
openvdb::GridPtrVec volumes_of(const ShellFile& file, bool half, const fs::path& path)
{
    openvdb::GridPtrVec volumes{named_copy(file.surface, kSurfaceGrid, half, file.placement, path),
                                named_copy(file.depth, kDepthGrid, half, file.placement, path)};
    // Whoever made the grid may have left it without a class, and tools pick volumes by it.
    volumes[1]->setGridClass(openvdb::GRID_FOG_VOLUME);
    for (const GridBase::Ptr& vectors : {file.rest_volume, file.velocity_volume}) {
        if (!vectors)
            continue;
        const GridBase::Ptr volume = vectors->copyGrid();
        volume->setCreator(creator_name());
        volume->setSaveFloatAsHalf(half);
        put_in_place(*volume, file.placement.shift());
        volumes.push_back(volume);
    }
    return volumes;
}

} // namespace

const NameTable<PointPlacement>& names(PointPlacement)
{
    static const NameTable<PointPlacement> table{{"same-file", PointPlacement::same_file},
                                                 {"beside", PointPlacement::beside}};
    return table;
}

OptionList describe(VdbWriteOptions& o)
{
    return in_group(
        "Output",
        {option("points", o.points, "--points",
                "Where a .vdb's point grids go: in the same file, or beside it in NAME.points.vdb")
             .needing("--output .vdb"),
         option("half", o.half, "--half",
                "Save a .vdb's volumes with half floats; its points stay exact")
             .needing("--output .vdb")});
}

void write_shell_vdb(const fs::path& path, const ShellFile& file, const VdbWriteOptions& options,
                     OutputSet* with)
{
    openvdb::initialize();
    require_consistent(file.stack, file.tets);
    require_consistent_core(file.stack, file.tets, file.core);
    require_consistent_rest(file);
    require_consistent(file.input, file.stack.surface(0).size());
    const bool beside = options.points == PointPlacement::beside;
    openvdb::MetaMap metadata;
    PointGrids made;
    // Checksum and grids each go over all arrays of the shell, and neither needs the other.
    run_together(
        [&] { metadata = shell_metadata(path, file, options.points); },
        [&] { made = make_point_grids(file.stack, file.tets, file.core_feet, file.rest); });
    openvdb::GridPtrVec volumes = volumes_of(file, options.half, path);
    openvdb::GridPtrVec points{made.points, made.prisms, made.tets};
    if (!file.core.empty()) {
        const CoreGrids core =
            make_core_grids(number_points(file.stack, file.tets), file.tets, file.core, file.rest);
        points.insert(points.end(), {core.points, core.tets});
    }
    if (!file.input.empty())
        points.push_back(make_input_points_grid(file.input));
    for (const GridBase::Ptr& grid : volumes)
        add_volume_metadata(*grid, metadata);
    // The grids of points were made for this call, so they may be changed in place.
    for (const GridBase::Ptr& grid : points) {
        put_in_place(*grid, file.placement.shift());
        add_points_metadata(*grid, metadata);
    }

    write_together(with, [&](OutputSet& set) {
        if (!beside)
            std::move(points.begin(), points.end(), std::back_inserter(volumes));
        set.write(path, [&](const fs::path& temporary) {
            write_sealed(temporary, std::move(volumes), metadata);
        });
        if (beside)
            set.write(points_file_of(path), [&](const fs::path& temporary) {
                write_sealed(temporary, std::move(points), metadata);
            });
    });
}

ShellInfo read_shell_info(const fs::path& path)
{
    return reading_vdb(path, [&] {
        openvdb::io::File file(path.string());
        open_vdb(file);
        return info_from_metadata(*file.getMetadata(), path);
    });
}

ShellFile read_shell_vdb(const fs::path& path)
{
    return reading_vdb(path, [&] {
        OpenFile file(path);
        const ShellInfo info = file.info();
        ShellFile result;
        result.digests = file.digests.count();
        result.surface = read_grid<FloatGrid>(file, kSurfaceGrid);
        result.depth = read_grid<FloatGrid>(file, kDepthGrid);
        result.placement = info.placement;
        // In memory all is in the mesh's frame, which the pillars are in. Moving back undoes the
        // writer's step on the transform alone.
        put_in_place(*result.surface, -info.placement.shift());
        put_in_place(*result.depth, -info.placement.shift());
        const ShellCounts counts{info.vertices,    info.points,    info.tet_points, info.prisms,
                                 info.tets,        info.layers,    info.skin,       info.tapered,
                                 info.core_points, info.core_tets, info.posed};
        const AllPoints points = find_points(file, info, result.digests);
        const std::string name = info.points_at.string();
        read_point_grids(points.shell, counts, name, result.stack, result.tets);
        if (points.core.tets)
            result.core = read_core_grids(points.core, counts,
                                          number_points(result.stack, result.tets), name);
        if (info.posed)
            result.rest = read_rest_points(points.shell, points.core, counts, result.stack, name);
        result.core_feet =
            read_core_feet(*points.shell.points, number_points(result.stack, {}), name);
        if (points.input)
            result.input = read_input_points_grid(*points.input, info.input_points,
                                                  std::size_t(info.vertices), name);
        // The file has the sum over all layers; it is put into the first layer.
        result.stack.splits.front().ripples = std::size_t(info.ripples);
        result.parameters_json = info.parameters_json;
        result.report_json = info.report_json;
        // It comes last, because only whole arrays have a checksum. Damage that kept every index in
        // range is found here.
        const std::string found = checksum_of(result.stack, result.tets, result.core);
        if (found != info.checksum)
            throw ReadError(path.string() + ": the shell's arrays have checksum " + found +
                            ", the file says " + info.checksum);
        return result;
    });
}

FloatGrid::Ptr read_float_grid(const fs::path& path, const std::string& name)
{
    return reading_vdb(path, [&] {
        openvdb::io::File file(path.string());
        open_vdb(file);
        const openvdb::GridPtrVecPtr grids = file.readAllGridMetadata();
        std::string chosen = name;
        // A file of one float grid needs no name; of several none is taken for the right one.
        if (name.empty()) {
            int found = 0;
            for (const GridBase::Ptr& grid : *grids)
                if (grid->isType<FloatGrid>()) {
                    chosen = grid->getName();
                    ++found;
                }
            if (found != 1)
                throw ReadError(path.string() + ": has " + std::to_string(found) +
                                " float grids, expected one or a name; it has " + list_of(*grids));
        }
        // As in read_grid, only what the walk has covered may be decoded.
        if (!grid_of_name(*grids, chosen, path.string())->isType<FloatGrid>())
            throw ReadError(path.string() + ": grid " + vdb_shell::quoted(chosen) +
                            " is not a float grid; the file has " + list_of(*grids));
        return openvdb::gridPtrCast<FloatGrid>(file.readGrid(chosen));
    });
}

} // namespace vdb_shell
