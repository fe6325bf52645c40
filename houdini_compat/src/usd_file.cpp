// SPDX-License-Identifier: Apache-2.0

// Writes shells as one USD stage in the text format: the surface as a Mesh, the tets as a TetMesh,
// the grids by reference to a .vdb. One sample or one for each time; what is the same at all times
// is written once, by comparing the texts of the values. Coordinates are the float32 that were
// certified, in the frame of the mesh, and the placement is an xformOp of doubles on the prims, so
// nothing is rounded once more. There is no dependence on USD's own library: the text format is
// plain enough. How stages are checked, and by what they were not, is in docs/usd.md.

#include "vdb_shell/houdini/usd_file.h"

#include "vdb_shell/core/atomic_file.h"
#include "vdb_shell/core/error.h"
#include "vdb_shell/write/shell_points.h"

#include "usd_asset.h"
#include "usd_extent.h"
#include "usd_stage.h"
#include "usd_text.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <list>

namespace vdb_shell
{
namespace
{

namespace fs = std::filesystem;
using openvdb::Vec3d;
using openvdb::Vec3I;
using openvdb::Vec3s;
using openvdb::Vec4I;

using Samples = std::vector<UsdSample>;

void write_header(UsdStage& stage, const Samples& samples, const UsdOptions& options)
{
    stage.line("#usda 1.0");
    stage.line("(");
    stage.line("    customLayerData = {");
    stage.line("        string creator = \"vdb_shell " VDB_SHELL_VERSION "\"");
    stage.line("    }");
    stage.line("    defaultPrim = \"shell\"");
    if (samples.size() > 1)
        stage.line("    endTimeCode = " + usd_value(samples.back().time));
    stage.line("    metersPerUnit = " + usd_value(options.meters_per_unit));
    if (samples.size() > 1) {
        stage.line("    startTimeCode = " + usd_value(samples.front().time));
        stage.line("    timeCodesPerSecond = " + usd_value(options.frames_per_second));
    }
    stage.line(std::string("    upAxis = \"") + (options.up_axis == UpAxis::y ? "Y" : "Z") + "\"");
    stage.line(")");
    stage.line("");
}

const std::vector<Vec3s>& skin_of(const UsdSample& sample)
{
    return sample.shell->stack.surface(sample.shell->stack.skin);
}

/// Whether the layers have to be told. One sample may speak for all, as require_fitting asks that
/// all have the same.
bool has_layers(const Samples& samples)
{
    const ShellStack& stack = samples.front().shell->stack;
    // A core has no layer, and has to say so.
    return stack.layers.size() > 1 || stack.skin > 0 ||
           std::any_of(samples.begin(), samples.end(),
                       [](const UsdSample& s) { return has_core(s.shell->tets); });
}

void write_stops(UsdStage& stage, const Samples& samples)
{
    const auto reasons_of = [](const PrismShell& layer) {
        std::vector<std::int32_t> reasons;
        for (const StopReason reason : layer.stop)
            reasons.push_back(std::int32_t(reason));
        return usd_array(reasons);
    };
    // The lowest layer has the reasons of the pillars below the skin, the first layer those of the
    // pillars above it.
    stage.primvar("int[] primvars:stopReason",
                  [&](const UsdSample& s) { return reasons_of(s.shell->stack.layers.back()); });
    if (on_both_sides(samples.front().shell->stack))
        stage.primvar("int[] primvars:stopReasonOuter", [&](const UsdSample& s) {
            return reasons_of(s.shell->stack.layers.front());
        });
}

std::string usd_triple(const Vec3d& v)
{
    return "(" + usd_value(v[0]) + ", " + usd_value(v[1]) + ", " + usd_value(v[2]) + ")";
}

/// Puts the prim where the file of the surface has it: file = origin + unit * mesh. USD applies the
/// last operation of the order first, so the scale stands behind the translation. Grids of a .vdb
/// have the origin in their own transforms and need the unit alone.
void write_placement(UsdStage& stage, const Samples& samples, bool with_origin)
{
    // All samples get the operations if one of them moves, because the order of operations cannot
    // change with time.
    const bool moves = std::any_of(samples.begin(), samples.end(), [](const UsdSample& sample) {
        return sample.shell->placement.moves();
    });
    if (!moves)
        return;
    stage.attribute("double3 xformOp:scale",
                    [](const UsdSample& s) { return usd_triple(Vec3d(s.shell->placement.unit)); });
    if (with_origin)
        stage.attribute("double3 xformOp:translate",
                        [](const UsdSample& s) { return usd_triple(s.shell->placement.origin); });
    stage.line(std::string("uniform token[] xformOpOrder = [") +
               (with_origin ? "\"xformOp:translate\", " : "") + "\"xformOp:scale\"]");
}

/// Where points were at rest, and how fast they move (UsdGeomPointBased::velocities): in the frame
/// of the points. `of_prim` takes what a prim has from what the shell has.
template <typename OfPrim>
void write_motion(UsdStage& stage, const Samples& samples, const OfPrim& of_prim)
{
    const auto moving = [](const UsdSample& s) { return !s.shell->rest.velocity.empty(); };
    const auto posed = [](const UsdSample& s) { return s.shell->rest.posed(); };
    if (std::any_of(samples.begin(), samples.end(), posed))
        stage.primvar("point3f[] primvars:rest", [&](const UsdSample& s) {
            return usd_array(of_prim(s, rest_points(*s.shell)));
        });
    // Prims have the same attributes at all times, and a speed that nobody knows is not 0.
    if (std::all_of(samples.begin(), samples.end(), moving))
        stage.attribute("vector3f[] velocities", [&](const UsdSample& s) {
            return usd_array(of_prim(s, s.shell->rest.velocity));
        });
}

void write_surface(UsdStage& stage, const Samples& samples)
{
    stage.open("def Mesh \"surface\"");
    stage.attribute("float3[] extent", [](const UsdSample& s) { return extent_of(skin_of(s)); });
    stage.attribute("int[] faceVertexCounts", [](const UsdSample& s) {
        return usd_array(std::vector<std::int32_t>(s.shell->stack.triangles().size(), 3));
    });
    stage.attribute("int[] faceVertexIndices", [](const UsdSample& s) {
        std::vector<std::uint32_t> corners;
        for (const Vec3I& triangle : s.shell->stack.triangles())
            corners.insert(corners.end(), {triangle[0], triangle[1], triangle[2]});
        return usd_array(corners);
    });
    stage.line("uniform token orientation = \"rightHanded\"");
    stage.attribute("point3f[] points", [](const UsdSample& s) { return usd_array(skin_of(s)); });
    write_motion(stage, samples, [](const UsdSample& s, const PointVectors& vectors) {
        return vectors.surface[s.shell->stack.skin];
    });
    write_stops(stage, samples);
    stage.primvar("float[] primvars:thickness", [](const UsdSample& s) {
        std::vector<float> lengths;
        for (std::size_t v = 0; v < skin_of(s).size(); ++v)
            lengths.push_back(thickness_of(s.shell->stack, v));
        return usd_array(lengths);
    });
    // Without it a Mesh is a subdivision surface by USD's default, and would be drawn smoothed.
    stage.line("uniform token subdivisionScheme = \"none\"");
    write_placement(stage, samples, true);
    stage.close();
}

/// A value for each point of the tets.
template <typename Value> std::string per_point(const UsdSample& sample, const Value& value)
{
    using Result = decltype(value(std::size_t()));
    std::vector<Result> values;
    for (std::size_t i = 0; i < sample.shell->tets.points.size(); ++i)
        values.push_back(value(i));
    return usd_array(values);
}

void write_tet_primvars(UsdStage& stage)
{
    stage.primvar("float[] primvars:depth", [](const UsdSample& s) {
        const auto layers = std::uint8_t(s.shell->stack.layers.size());
        // All of the core is as deep as the innermost surface.
        return per_point(s, [&](std::size_t i) {
            return float(double(std::min(s.shell->tets.layer[i], layers)) / layers);
        });
    });
    stage.primvar("int[] primvars:layer", [](const UsdSample& s) {
        return usd_array(signed_numbers(s.shell->tets.layer));
    });
    stage.primvar("int[] primvars:sourceVertex", [](const UsdSample& s) {
        return usd_array(signed_numbers(s.shell->tets.source_vertex));
    });
    stage.primvar("float[] primvars:thickness", [](const UsdSample& s) {
        return per_point(s, [&](std::size_t i) {
            const std::uint32_t vertex = s.shell->tets.source_vertex[i];
            return vertex == CoreTets::kNoVertex ? 0.0f : thickness_of(s.shell->stack, vertex);
        });
    });
}

/// Where pillars ended at cores: at their innermost points, as in the other formats.
void write_core_primvars(UsdStage& stage, const Samples& samples)
{
    if (std::all_of(samples.begin(), samples.end(),
                    [](const UsdSample& s) { return s.shell->core_feet.empty(); }))
        return;
    const auto add = [&stage](const char* declaration, const auto& value) {
        stage.primvar(declaration, [value](const UsdSample& s) {
            std::vector<CoreFoot> feet =
                feet_of_tet_points(s.shell->stack, s.shell->tets, s.shell->core_feet);
            feet.resize(s.shell->tets.points.size());
            return per_point(s, [&](std::size_t i) { return value(feet[i]); });
        });
    };
    add("int[] primvars:core", [](const CoreFoot& foot) { return foot.core; });
    add("float[] primvars:coreDistance", [](const CoreFoot& foot) { return foot.distance; });
    add("int[] primvars:coreTriangle", [](const CoreFoot& foot) { return foot.triangle; });
    add("float3[] primvars:coreUvw", [](const CoreFoot& foot) { return foot.uvw; });
}

/// Custom properties and not primvars: uniform primvars of a TetMesh have one value for each face
/// that is drawn, not one for each tet.
void write_tet_properties(UsdStage& stage, const Samples& samples)
{
    if (has_layers(samples)) {
        stage.attribute("custom int[] userProperties:layer", [](const UsdSample& s) {
            return usd_array(signed_numbers(s.shell->tets.prism_layer));
        });
        stage.attribute("custom int userProperties:layers", [](const UsdSample& s) {
            return std::to_string(s.shell->stack.layers.size());
        });
    }
    stage.attribute("custom int[] userProperties:prism", [](const UsdSample& s) {
        return usd_array(signed_numbers(s.shell->tets.prism));
    });
    if (has_layers(samples))
        stage.attribute("custom int userProperties:skin",
                        [](const UsdSample& s) { return std::to_string(s.shell->stack.skin); });
}

void write_tets(UsdStage& stage, const Samples& samples)
{
    stage.open("def TetMesh \"tets\"");
    stage.attribute("float3[] extent",
                    [](const UsdSample& s) { return extent_of(s.shell->tets.points); });
    stage.line("uniform token orientation = \"rightHanded\"");
    stage.attribute("point3f[] points",
                    [](const UsdSample& s) { return usd_array(s.shell->tets.points); });
    write_motion(stage, samples, [](const UsdSample& s, const PointVectors& vectors) {
        return vectors_of_tet_points(s.shell->tets, vectors);
    });
    write_core_primvars(stage, samples);
    write_tet_primvars(stage);
    stage.attribute("int3[] surfaceFaceVertexIndices", [](const UsdSample& s) {
        return usd_array(boundary_triangles(s.shell->tets));
    });
    stage.attribute("int4[] tetVertexIndices",
                    [](const UsdSample& s) { return usd_array(s.shell->tets.tets); });
    write_tet_properties(stage, samples);
    write_placement(stage, samples, true);
    stage.close();
}

void write_grids(UsdStage& stage, const Samples& samples, const fs::path& path)
{
    stage.open("def Volume \"grids\"");
    stage.attribute("float3[] extent",
                    [](const UsdSample& s) { return extent_of_volume(*s.shell); });
    for (const char* name : {"depth", "surface"})
        stage.line(std::string("rel field:") + name + " = </shell/grids/" + name + ">");
    write_placement(stage, samples, false);
    const std::pair<const char*, const char*> grids[] = {{"depth", "fogVolume"},
                                                         {"surface", "levelSet"}};
    for (const auto& [name, field_class] : grids) {
        stage.line("");
        stage.open(std::string("def OpenVDBAsset \"") + name + "\"");
        stage.line(std::string("token fieldClass = \"") + field_class + "\"");
        stage.line("token fieldDataType = \"float\"");
        stage.line(std::string("token fieldName = \"") + name + "\"");
        stage.attribute("asset filePath", [&path](const UsdSample& s) {
            return usd_asset(relative_asset(path, s.volume));
        });
        stage.close();
    }
    stage.close();
}

[[noreturn]] void refuse(const fs::path& path, const std::string& what)
{
    throw InvalidOption(path.string() + ": " + what);
}

[[noreturn]] void refuse_shell(const fs::path& path, const std::string& what)
{
    throw GeometryError(path.string() + ": " + what);
}

void require_positive(const fs::path& path, const char* what, double value)
{
    if (!(value > 0.0) || !std::isfinite(value))
        refuse(path, std::string(what) + " is " + usd_value(value) +
                         ", expected a positive finite number");
}

/// Prims and attributes are the same at all times, only values may differ. So the shells need the
/// same layers, the same triangles, and a volume at all times or at none.
void require_alike(const fs::path& path, const std::string& name, const UsdSample& sample,
                   const UsdSample& first)
{
    const ShellStack &stack = sample.shell->stack, &other = first.shell->stack;
    if (stack.layers.size() != other.layers.size() || stack.skin != other.skin)
        refuse_shell(path, name + ": it has " + std::to_string(stack.layers.size()) +
                               " layers, the surface is number " + std::to_string(stack.skin) +
                               "; sample 0 has " + std::to_string(other.layers.size()) + " and " +
                               std::to_string(other.skin));
    if (stack.triangles() != other.triangles())
        refuse_shell(path, name + ": its surface has other triangles than that of sample 0");
    if (sample.volume.empty() != first.volume.empty())
        refuse(path, name + ": all samples have a volume or none has");
}

void require_fitting(const fs::path& path, const Samples& samples)
{
    if (samples.empty())
        refuse(path, "a stage needs at least one sample");
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const UsdSample& sample = samples[i];
        const std::string name = "sample " + std::to_string(i) + " at " + usd_value(sample.time);
        // Negated, so that a time that is not a number is refused as well.
        if (!std::isfinite(sample.time) || (i > 0 && !(sample.time > samples[i - 1].time)))
            refuse(path, name + ": times must be finite and increase");
        if (!sample.shell || sample.shell->stack.layers.empty())
            refuse(path, name + ": it has no shell");
        require_alike(path, name, sample, samples.front());
        if (!sample.volume.empty())
            require_usd_asset(path, sample.volume);
        if (!sample.volume.empty() && !(sample.shell->surface && sample.shell->depth))
            refuse(path, name + ": it has a volume but no grids");
    }
}

/// The samples, with the core among the tets of those that have one; `filled` keeps them.
Samples with_cores(Samples samples, std::list<ShellFile>& filled)
{
    for (UsdSample& sample : samples) {
        if (sample.shell->core.empty())
            continue;
        filled.push_back(*sample.shell);
        filled.back().tets = joined_tets(sample.shell->tets, sample.shell->core);
        sample.shell = &filled.back();
    }
    return samples;
}

} // namespace

std::vector<Vec3I> boundary_triangles(const TetMesh& tets)
{
    // The four faces with their normals outward for a positive tet, in the order of USD's
    // right-handed TetMesh.
    constexpr int kFaces[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};
    struct Face {
        std::array<std::uint32_t, 3> sorted;
        Vec3I corners;
    };
    std::vector<Face> faces;
    faces.reserve(4 * tets.tets.size());
    for (const Vec4I& tet : tets.tets) {
        for (const auto& corner : kFaces) {
            const Vec3I face(tet[corner[0]], tet[corner[1]], tet[corner[2]]);
            std::array<std::uint32_t, 3> sorted{face[0], face[1], face[2]};
            std::sort(sorted.begin(), sorted.end());
            faces.push_back({sorted, face});
        }
    }
    // Sorting brings equal faces together in O(n log n), and no hash or address decides the order;
    // ties are broken by the corners, so the order is total.
    std::sort(faces.begin(), faces.end(), [](const Face& a, const Face& b) {
        return a.sorted != b.sorted ? a.sorted < b.sorted : a.corners < b.corners;
    });
    std::vector<Vec3I> boundary;
    for (std::size_t i = 0, end = 0; i < faces.size(); i = end) {
        while (end < faces.size() && faces[end].sorted == faces[i].sorted)
            ++end;
        // A face of one tet only. Faces of two are inside; faces of more, which only shells that do
        // not conform have, belong to no boundary either.
        if (end == i + 1)
            boundary.push_back(faces[i].corners);
    }
    std::sort(boundary.begin(), boundary.end());
    return boundary;
}

void write_usd(const fs::path& path, const std::vector<UsdSample>& given, const UsdOptions& options,
               OutputSet* with)
{
    require_fitting(path, given);
    std::list<ShellFile> filled;
    const Samples samples = with_cores(given, filled);
    require_positive(path, "metres per unit", options.meters_per_unit);
    require_positive(path, "frames per second", options.frames_per_second);
    write_stream_atomically(
        path,
        [&](std::ostream& out) {
            UsdStage stage(out, samples);
            write_header(stage, samples, options);
            stage.open("def Xform \"shell\" (\n    kind = \"component\"\n)");
            write_surface(stage, samples);
            stage.line("");
            write_tets(stage, samples);
            if (!samples.front().volume.empty()) {
                stage.line("");
                write_grids(stage, samples, path);
            }
            stage.close();
        },
        with);
}

} // namespace vdb_shell
