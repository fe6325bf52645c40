// SPDX-License-Identifier: Apache-2.0

// The metadata of a shell's .vdb: written from the shell, read back with every entry held against
// its type and range. The counts let the reader bound its memory before it looks at a grid, and the
// checksum ties the point grids to their file. A file of one layer below the surface says nothing
// of layers: it is of schema 1, which older readers take. The table of entries is in
// docs/file_format.md. The copies on single grids are for Houdini, which makes attributes of a
// grid's metadata; they are never read here.

#include "write/vdb_metadata.h"

#include "core/text_stream.h"
#include "io/vdb_archive.h"

#include "vdb_shell/core/error.h"

#include "write/point_grids.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vdb_shell
{
namespace
{

namespace fs = std::filesystem;
using openvdb::Int32Metadata;
using openvdb::StringMetadata;

constexpr const char* kSchemaKey = "vdb_shell_schema";
constexpr const char* kVerticesKey = "vdb_shell_vertices";
constexpr const char* kPointsKey = "vdb_shell_points";
constexpr const char* kTetPointsKey = "vdb_shell_tet_points";
constexpr const char* kPrismsKey = "vdb_shell_prisms";
constexpr const char* kTetsKey = "vdb_shell_tets";
constexpr const char* kLayersKey = "vdb_shell_layers";
constexpr const char* kSkinKey = "vdb_shell_skin";
constexpr const char* kTaperedKey = "vdb_shell_tapered";
constexpr const char* kPosedKey = "vdb_shell_posed";
constexpr const char* kCorePointsKey = "vdb_shell_core_points";
constexpr const char* kCoreTetsKey = "vdb_shell_core_tets";
constexpr const char* kRipplesKey = "vdb_shell_ripples";
constexpr const char* kOriginKey = "vdb_shell_origin";
constexpr const char* kUnitKey = "vdb_shell_unit";
constexpr const char* kOrientationKey = "vdb_shell_orientation";
constexpr const char* kChecksumKey = "vdb_shell_checksum";
constexpr const char* kGridsKey = "vdb_shell_grids";
constexpr const char* kPointsFileKey = "vdb_shell_points_file";
constexpr const char* kParametersKey = "vdb_shell_parameters";
constexpr const char* kReportKey = "vdb_shell_report";
constexpr const char* kCreatorKey = "creator";

constexpr const char* kOrientation =
    "triangles counter-clockwise seen from outside; tets (a,b,c,d) with det(b-a,c-a,d-a) > 0 "
    "unless inverted; layer 0 outer, 1 inner";
constexpr const char* kOrientationOfLayers =
    "triangles counter-clockwise seen from outside; tets (a,b,c,d) with det(b-a,c-a,d-a) > 0 "
    "unless inverted; surfaces and layers from 0, the outermost";
constexpr const char* kGridNames = "surface depth shell_points shell_prisms shell_tets";
constexpr const char* kInputPointsKey = "vdb_shell_input_points";
constexpr const char* kCoreGridNames = " core_points core_tets";

[[noreturn]] void fail(const fs::path& path, const std::string& what)
{
    throw ReadError(path.string() + ": " + what);
}

/// An entry by its exact type. OpenVDB's own accessor would throw as well, but its message names
/// neither the file nor what was expected.
template <typename T>
const T& entry(const openvdb::MetaMap& metadata, const fs::path& path, const char* key)
{
    using Typed = openvdb::TypedMetadata<T>;
    const openvdb::Metadata::ConstPtr found = metadata[key];
    if (!found)
        fail(path, std::string("metadata \"") + key + "\" is missing");
    if (found->typeName() != Typed::staticTypeName())
        fail(path, std::string("metadata \"") + key + "\" has type " + found->typeName() +
                       ", expected " + Typed::staticTypeName());
    return static_cast<const Typed&>(*found).value();
}

std::int64_t count_entry(const openvdb::MetaMap& metadata, const fs::path& path, const char* key)
{
    // The ids of points, prisms and tets are int32, so no count needs more.
    const std::int32_t count = entry<std::int32_t>(metadata, path, key);
    if (count < 0)
        fail(path, std::string("metadata \"") + key + "\" is " + std::to_string(count) +
                       ", expected 0 or more");
    return count;
}

bool flag_entry(const openvdb::MetaMap& metadata, const fs::path& path, const char* key)
{
    const std::int64_t flag = count_entry(metadata, path, key);
    if (flag > 1)
        fail(path, std::string("metadata \"") + key + "\" is " + std::to_string(flag) +
                       ", expected 0 or 1");
    return flag == 1;
}

/// The schema is read before all else: a newer one may give other entries another meaning, and the
/// message should say that rather than name some missing entry.
int schema_of(const openvdb::MetaMap& metadata, const fs::path& path)
{
    if (!metadata[kSchemaKey])
        fail(path, std::string("it holds no shell: metadata \"") + kSchemaKey + "\" is missing");
    const int schema = entry<std::int32_t>(metadata, path, kSchemaKey);
    if (schema < 1 || schema > kShellSchema)
        fail(path, "its schema is " + std::to_string(schema) + ", schemas 1 to " +
                       std::to_string(kShellSchema) + " can be read");
    return schema;
}

/// The file with the points: this one, or one beside it, which may have been renamed together with
/// it.
fs::path points_place(const openvdb::MetaMap& metadata, const fs::path& path)
{
    const std::string& stated = entry<std::string>(metadata, path, kPointsFileKey);
    if (stated.empty())
        return path;
    const fs::path renamed = points_file_of(path);
    std::error_code ignored;
    // A name from a file may not lead out of that file's folder.
    const bool plain = fs::path(stated).filename() == fs::path(stated);
    if (!plain)
        fail(path, std::string("metadata \"") + kPointsFileKey + "\" is \"" + stated +
                       "\", expected a file name without a folder");
    // The file with the points carries the same metadata, so it may be the one that is opened. Else
    // the name that fits the file's present name is tried first: both may have been renamed
    // together. Whether the file found is the right one is for the checksum to tell.
    const bool is_points_file = path.filename() == fs::path(stated);
    if (is_points_file || fs::exists(renamed, ignored))
        return is_points_file ? path : renamed;
    return path.parent_path() / stated;
}

void read_layers(const openvdb::MetaMap& metadata, const fs::path& path, ShellInfo& info)
{
    // Each schema has what the one before it has and more, so reading ends where the file's own
    // schema does. What it does not say keeps its default: one layer, below the surface.
    if (info.schema < kLayeredSchema)
        return;
    info.layers = count_entry(metadata, path, kLayersKey);
    info.skin = count_entry(metadata, path, kSkinKey);
    const auto most = std::int64_t(ShellStack::kMostLayers);
    if (info.layers < 1 || info.layers > most)
        fail(path, std::string("metadata \"") + kLayersKey + "\" is " +
                       std::to_string(info.layers) + ", expected 1 to " + std::to_string(most));
    if (info.skin > info.layers)
        fail(path, std::string("metadata \"") + kSkinKey + "\" is " + std::to_string(info.skin) +
                       ", expected at most " + std::to_string(info.layers));
    if (info.schema < kTaperedSchema)
        return;
    info.tapered = flag_entry(metadata, path, kTaperedKey);
    if (info.schema < kFilledSchema)
        return;
    info.core_points = count_entry(metadata, path, kCorePointsKey);
    info.core_tets = count_entry(metadata, path, kCoreTetsKey);
    info.posed = info.schema >= kPosedSchema && flag_entry(metadata, path, kPosedKey);
}

void read_placement(const openvdb::MetaMap& metadata, const fs::path& path, Placement& placement)
{
    // Neither: coordinates are those of the file as they stand. One alone is damage, which entry()
    // tells.
    if (!metadata[kOriginKey] && !metadata[kUnitKey])
        return;
    placement.origin = entry<openvdb::Vec3d>(metadata, path, kOriginKey);
    placement.unit = entry<double>(metadata, path, kUnitKey);
    int exponent = 0;
    if (!placement.origin.isFinite() || !(placement.unit > 0) || !std::isfinite(placement.unit) ||
        // frexp gives the fraction 0.5 for powers of two alone. Any other unit would round the
        // coordinates once more, and the file would no longer hold the floats that were certified.
        std::frexp(placement.unit, &exponent) != 0.5)
        fail(path, std::string("metadata \"") + kOriginKey + "\" is " + placement.origin.str() +
                       " and \"" + kUnitKey + "\" is " + std::to_string(placement.unit) +
                       ", expected a finite point and a power of two");
}

/// The number of ripples is a figure for people; too large a one is cut off rather than refused.
std::int32_t as_int32(std::size_t value)
{
    return std::int32_t(
        std::min<std::size_t>(value, std::size_t(std::numeric_limits<std::int32_t>::max())));
}

} // namespace

int schema_for(const ShellCounts& counts)
{
    // The lowest schema that can say what the shell is, so that older readers take as many files as
    // they can.
    if (counts.posed)
        return kPosedSchema;
    if (counts.core_tets > 0)
        return kFilledSchema;
    if (counts.tapered)
        return kTaperedSchema;
    return counts.layers > 1 || counts.skin > 0 ? kLayeredSchema : 1;
}

std::size_t ripples_of(const ShellStack& stack)
{
    std::size_t sum = 0;
    for (const PrismSplit& split : stack.splits)
        sum += split.ripples;
    return sum;
}

fs::path points_file_of(const fs::path& path)
{
    return path.parent_path() / (path.stem().string() + ".points.vdb");
}

namespace
{

/// How many there are of everything. The casts are safe: require_consistent has bounded these
/// counts by int32, and it runs before this.
void insert_counts(openvdb::MetaMap& map, const ShellCounts& counts)
{
    map.insertMeta(kVerticesKey, Int32Metadata(std::int32_t(counts.vertices)));
    map.insertMeta(kPointsKey, Int32Metadata(std::int32_t(counts.points)));
    map.insertMeta(kTetPointsKey, Int32Metadata(std::int32_t(counts.tet_points)));
    map.insertMeta(kPrismsKey, Int32Metadata(std::int32_t(counts.prisms)));
    map.insertMeta(kTetsKey, Int32Metadata(std::int32_t(counts.tets)));
    if (schema_for(counts) >= kLayeredSchema) {
        map.insertMeta(kLayersKey, Int32Metadata(std::int32_t(counts.layers)));
        map.insertMeta(kSkinKey, Int32Metadata(std::int32_t(counts.skin)));
    }
    const bool filled = schema_for(counts) >= kFilledSchema;
    if (counts.tapered || filled)
        map.insertMeta(kTaperedKey, Int32Metadata(counts.tapered ? 1 : 0));
    if (filled) {
        map.insertMeta(kCorePointsKey, Int32Metadata(std::int32_t(counts.core_points)));
        map.insertMeta(kCoreTetsKey, Int32Metadata(std::int32_t(counts.core_tets)));
    }
    if (counts.posed)
        map.insertMeta(kPosedKey, Int32Metadata(1));
}

std::string grid_names(const ShellFile& file)
{
    return std::string(kGridNames) + (file.core.tets.empty() ? "" : kCoreGridNames) +
           (file.input.empty() ? "" : " input_points") + (file.rest_volume ? " rest" : "") +
           (file.velocity_volume ? " v" : "");
}

} // namespace

openvdb::MetaMap shell_metadata(const fs::path& path, const ShellFile& file, PointPlacement points)
{
    openvdb::MetaMap map;
    ShellCounts counts = counts_of(file.stack, file.tets, file.core);
    counts.posed = file.rest.posed();
    map.insertMeta(kCreatorKey, StringMetadata(creator_name()));
    map.insertMeta(kSchemaKey, Int32Metadata(schema_for(counts)));
    insert_counts(map, counts);
    map.insertMeta(kRipplesKey, Int32Metadata(as_int32(ripples_of(file.stack))));
    if (!file.input.empty())
        map.insertMeta(kInputPointsKey, Int32Metadata(std::int32_t(file.input.points.size())));
    if (file.placement.moves()) {
        map.insertMeta(kOriginKey, openvdb::Vec3DMetadata(file.placement.origin));
        map.insertMeta(kUnitKey, openvdb::DoubleMetadata(file.placement.unit));
    }
    const bool layered = schema_for(counts) >= kLayeredSchema;
    map.insertMeta(kOrientationKey, StringMetadata(layered ? kOrientationOfLayers : kOrientation));
    map.insertMeta(kChecksumKey, StringMetadata(checksum_of(file.stack, file.tets, file.core)));
    map.insertMeta(kGridsKey, StringMetadata(grid_names(file)));
    map.insertMeta(kPointsFileKey, StringMetadata(points == PointPlacement::beside
                                                      ? points_file_of(path).filename().string()
                                                      : std::string()));
    map.insertMeta(kParametersKey, StringMetadata(file.parameters_json));
    map.insertMeta(kReportKey, StringMetadata(file.report_json));
    return map;
}

void add_volume_metadata(openvdb::GridBase& grid, const openvdb::MetaMap& file)
{
    for (const char* key : {kSchemaKey, kOriginKey, kUnitKey})
        if (file[key])
            grid.insertMeta(key, *file[key]);
    // Houdini turns strings of JSON under names that begin with `dict_` into dictionaries.
    grid.insertMeta("dict_vdb_shell_parameters", *file[kParametersKey]);
    grid.insertMeta("dict_vdb_shell_report", *file[kReportKey]);
}

void add_points_metadata(openvdb::GridBase& grid, const openvdb::MetaMap& file)
{
    grid.setCreator(creator_name());
    const char* const kept[] = {kSchemaKey,   kVerticesKey, kPointsKey,  kTetPointsKey,
                                kPrismsKey,   kTetsKey,     kRipplesKey, kOrientationKey,
                                kLayersKey,   kSkinKey,     kTaperedKey, kCorePointsKey,
                                kCoreTetsKey, kOriginKey,   kUnitKey};
    for (const char* key : kept)
        if (file[key])
            grid.insertMeta(std::string("global:") + key, *file[key]);
}

ShellInfo info_from_metadata(const openvdb::MetaMap& metadata, const fs::path& path)
{
    ShellInfo info;
    info.schema = schema_of(metadata, path);
    info.vertices = count_entry(metadata, path, kVerticesKey);
    info.points = count_entry(metadata, path, kPointsKey);
    info.tet_points = count_entry(metadata, path, kTetPointsKey);
    info.prisms = count_entry(metadata, path, kPrismsKey);
    info.tets = count_entry(metadata, path, kTetsKey);
    info.ripples = count_entry(metadata, path, kRipplesKey);
    read_layers(metadata, path, info);
    if (metadata[kInputPointsKey])
        info.input_points = count_entry(metadata, path, kInputPointsKey);
    read_placement(metadata, path, info.placement);
    info.creator = entry<std::string>(metadata, path, kCreatorKey);
    info.orientation = entry<std::string>(metadata, path, kOrientationKey);
    info.checksum = entry<std::string>(metadata, path, kChecksumKey);
    // For people and programs that list a file. Which grids are read is decided by the counts.
    InText names(entry<std::string>(metadata, path, kGridsKey));
    for (std::string name; names >> name;)
        info.grids.push_back(name);
    info.points_at = points_place(metadata, path);
    info.parameters_json = entry<std::string>(metadata, path, kParametersKey);
    info.report_json = entry<std::string>(metadata, path, kReportKey);
    return info;
}

} // namespace vdb_shell
