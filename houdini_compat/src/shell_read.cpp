// SPDX-License-Identifier: Apache-2.0

// Reads a shell back from a Houdini geometry that this program wrote, bit for bit, or refuses it
// with the name of what does not fit. People edit such files in Houdini, so nothing is assumed:
// counts are bounded by the elements that are there, triangles of all surfaces are compared with
// the outermost, and the checksum of all arrays decides in the end whether it is the shell that was
// written. Whether the shell is valid is not tested here; `check` certifies it afresh.

#include "vdb_shell/core/error.h"
#include "vdb_shell/houdini/geometry_file.h"
#include "vdb_shell/houdini/shell_geometry.h"
#include "vdb_shell/write/shell_points.h"

#include "core_columns.h"
#include "filled_core.h"
#include "geometry_digest.h"
#include "input_columns.h"
#include "shell_columns.h"

#include <cmath>
#include <limits>

namespace vdb_shell::houdini
{
namespace
{

using openvdb::Vec3I;
using openvdb::Vec3s;

// A shell is written once and read with suspicion: everything that stands in the file twice must
// agree, and all arrays together must have the checksum that was written.

void read_layers(const Columns& detail, const std::string& name, Counts& counts)
{
    counts.layers = detail.count(kLayers, ShellStack::kMostLayers);
    if (counts.layers == 0)
        detail.fail(kLayers, "is 0");
    counts.skin = detail.count(kSkin, counts.layers);
    if (counts.prisms % counts.layers != 0)
        refuse(name, std::to_string(counts.prisms) + " prisms are not a multiple of " +
                         std::to_string(counts.layers) + " layers");
    // Every vertex gets a point on each surface in memory, whatever the file holds. A vertex that
    // is a corner of no triangle has no place in a shell, so this bound costs nothing and keeps the
    // memory below a multiple of the primitives.
    if (counts.vertices > 3 * counts.triangles())
        refuse(name, std::to_string(counts.vertices) + " vertices cannot all be corners of " +
                         std::to_string(counts.triangles()) + " triangles");
}

void require_primitives(const HoudiniGeometry& geometry, const Counts& counts,
                        const std::string& name)
{
    const std::size_t shown = counts.surfaces().size() * counts.triangles();
    const std::size_t found = geometry.primitives.size();
    // Between the shown surfaces, triangles stand for those prisms that have no tet. How many there
    // are is not stated, so with layers only a lower bound is known; read_splits finds out whether
    // one is missing.
    if (counts.layered() ? counts.tets + shown > found : counts.tets + shown != found)
        refuse(name, "it has " + std::to_string(found) + " primitives, but " +
                         std::to_string(counts.tets) + " tets and " +
                         std::to_string(counts.prisms) + " prisms make " +
                         (counts.layered() ? "at least " : "") +
                         std::to_string(counts.tets + shown));
    for (std::size_t i = 0; i < geometry.primitives.size(); ++i) {
        const bool tet = i < counts.tets;
        const Primitive& primitive = geometry.primitives[i];
        if ((primitive.type == PrimitiveType::tetrahedron) != tet ||
            primitive.vertices != (tet ? 4u : 3u))
            refuse(name, "primitive " + std::to_string(i) + " is no " +
                             (tet ? "tetrahedron" : "triangle"));
    }
}

Counts read_counts(const HoudiniGeometry& geometry, const Columns& detail, const std::string& name)
{
    const std::int32_t schema = detail.integers(kSchema)[0];
    if (schema < 1 || schema > kShellSchema)
        detail.fail(kSchema, "is " + std::to_string(schema) + ", schemas 1 to " +
                                 std::to_string(kShellSchema) + " can be read");
    // Each count is bounded by the elements that the geometry has, before memory is taken by it.
    Counts counts;
    counts.vertices = detail.count(kVertices, geometry.points);
    counts.prisms = detail.count(kPrisms, geometry.primitives.size());
    counts.tets = detail.count(kTets, geometry.primitives.size());
    if (schema >= kLayeredSchema)
        read_layers(detail, name, counts);
    if (schema >= kTaperedSchema)
        counts.tapered = detail.count(kTapered, 1) == 1;
    counts.posed = schema >= kPosedSchema && detail.count(kPosed, 1) == 1;
    require_primitives(geometry, counts, name);
    return counts;
}

/// Of each primitive its prism, numbered layer by layer. For triangles on the shown surfaces it
/// follows from their place, and what the attributes say has to agree; for tets and collapsed
/// prisms the attributes alone tell.
std::vector<std::size_t> read_prisms(const Columns& primitives, const Counts& counts)
{
    const auto& prism = primitives.integers(kPrism);
    const std::vector<std::int32_t> single(counts.layered() ? 0 : prism.size(), 0);
    const auto& layer = counts.layered() ? primitives.integers(kLayer) : single;
    const std::vector<std::size_t> surfaces = counts.surfaces();
    const std::size_t triangles = counts.triangles();
    const auto require = [&](const char* attribute, std::size_t i, std::int32_t value,
                             std::size_t limit, bool place_is_free, std::size_t expected) {
        const auto index = static_cast<std::size_t>(value);
        if (value < 0 || index >= limit || !(place_is_free || index == expected))
            primitives.fail(attribute, "of primitive " + std::to_string(i) + " is " +
                                           std::to_string(value) + " of " + std::to_string(limit));
    };
    std::vector<std::size_t> prisms;
    prisms.reserve(prism.size());
    for (std::size_t i = 0; i < prism.size(); ++i) {
        const std::size_t place = i < counts.tets ? 0 : i - counts.tets;
        const bool shown = i >= counts.tets && place < surfaces.size() * triangles;
        // A collapsed prism shows as the triangle of the surface above it.
        const std::size_t surface = shown ? surfaces[place / triangles] : 0;
        require(kPrism, i, prism[i], triangles, !shown, shown ? place % triangles : 0);
        require(kLayer, i, layer[i], counts.layers, !shown, layer_at(surface, counts.layers));
        prisms.push_back(static_cast<std::size_t>(layer[i]) * triangles +
                         static_cast<std::size_t>(prism[i]));
    }
    return prisms;
}

/// The triangles are those of the outermost surface, where points and vertices have the same
/// numbers; those of all other surfaces are held against them.
void read_triangles(const HoudiniGeometry& geometry, const Counts& counts, const Ids& ids,
                    const std::vector<std::size_t>& prisms, const std::string& name,
                    ShellStack& stack)
{
    const std::size_t triangles = counts.triangles();
    const auto corner = [&](std::size_t i, int k) {
        // Houdini's polygons run clockwise.
        constexpr int kTurned[] = {0, 2, 1};
        return geometry
            .vertex_point[4 * counts.tets + 3 * i + static_cast<std::size_t>(kTurned[k])];
    };
    std::vector<Vec3I> outermost(triangles);
    for (std::size_t p = 0; p < triangles; ++p)
        for (int k = 0; k < 3; ++k) {
            outermost[p][k] = corner(p, k);
            if (outermost[p][k] >= counts.vertices)
                refuse(name, "prism " + std::to_string(p) + ": point " +
                                 std::to_string(outermost[p][k]) +
                                 " is not on the outermost surface");
        }
    const std::vector<std::size_t> surfaces = counts.surfaces();
    for (std::size_t i = 0; i < prisms.size() - counts.tets; ++i) {
        const std::size_t prism = prisms[counts.tets + i], p = prism % triangles;
        const std::size_t surface =
            i < surfaces.size() * triangles ? surfaces[i / triangles] : prism / triangles;
        for (int k = 0; k < 3; ++k)
            if (corner(i, k) != ids[surface][outermost[p][k]])
                refuse(name, "prism " + std::to_string(p) + ": point " +
                                 std::to_string(corner(i, k)) + " is not below point " +
                                 std::to_string(outermost[p][k]));
    }
    for (PrismShell& layer : stack.layers)
        layer.triangles = outermost;
}

/// All primitives of a prism tell the same diagonals, and each prism has at least one primitive. So
/// the splits are complete and do not depend on which primitive is looked at.
void read_splits(const Columns& primitives, const Counts& counts,
                 const std::vector<std::size_t>& prisms, const std::string& name, ShellStack& stack)
{
    const auto& order = primitives.integers(kSplitOrder, 3);
    const std::size_t triangles = counts.triangles();
    const auto said = [](std::size_t i, std::int32_t value) {
        return "of primitive " + std::to_string(i) + " has " + std::to_string(value);
    };
    // Of each prism the first primitive that has told its diagonals.
    std::vector<std::size_t> teller(counts.prisms, prisms.size());
    stack.splits.resize(counts.layers);
    for (PrismSplit& split : stack.splits)
        split.order.resize(triangles);
    for (std::size_t i = 0; i < prisms.size(); ++i) {
        const std::size_t prism = prisms[i];
        const bool first = teller[prism] == prisms.size();
        if (first)
            teller[prism] = i;
        for (std::size_t k = 0; k < 3; ++k) {
            const std::int32_t value = order[3 * i + k];
            if (value < 0 || value > 2)
                primitives.fail(kSplitOrder, said(i, value) + ", which is not in [0, 2]");
            if (value != order[3 * teller[prism] + k])
                primitives.fail(kSplitOrder, said(i, value) + " where primitive " +
                                                 std::to_string(teller[prism]) +
                                                 " of its prism has " +
                                                 std::to_string(order[3 * teller[prism] + k]));
            stack.splits[prism / triangles].order[prism % triangles][k] =
                static_cast<std::uint8_t>(value);
        }
    }
    for (std::size_t prism = 0; prism < counts.prisms; ++prism)
        if (teller[prism] == prisms.size())
            refuse(name, "no primitive tells the diagonals of prism " +
                             std::to_string(prism % triangles) + " in layer " +
                             std::to_string(prism / triangles));
}

/// The tets number those points that they use, in the order of the points: that is how make_tets
/// numbers them, and the checksum depends on it.
void read_tets(const HoudiniGeometry& geometry, const Columns& points, const Counts& counts,
               const std::vector<std::size_t>& prisms, TetMesh& tets)
{
    const auto& source = points.integers(kSourceVertex);
    const std::vector<Vec3s> position = points.vectors("P");
    std::vector<std::uint32_t> number(geometry.points, 0);
    for (std::size_t k = 0; k < 4 * counts.tets; ++k)
        number[geometry.vertex_point[k]] = 1;
    for (std::size_t i = 0; i < geometry.points; ++i) {
        if (number[i] == 0)
            continue;
        number[i] = static_cast<std::uint32_t>(tets.points.size());
        tets.points.push_back(position[i]);
        tets.source_vertex.push_back(static_cast<std::uint32_t>(source[i]));
        tets.layer.push_back(static_cast<std::uint8_t>(counts.layered()
                                                           ? points.integers(kSurface)[i]
                                                       : i < counts.vertices ? 0
                                                                             : 1));
    }
    for (std::size_t t = 0; t < counts.tets; ++t) {
        const auto corner = [&](std::size_t k) { return number[geometry.vertex_point[4 * t + k]]; };
        // Houdini counts the corners of a tetrahedron with the other orientation.
        tets.tets.emplace_back(corner(0), corner(1), corner(3), corner(2));
        tets.prism.push_back(static_cast<std::uint32_t>(prisms[t] % counts.triangles()));
        tets.prism_layer.push_back(static_cast<std::uint8_t>(prisms[t] / counts.triangles()));
    }
}

void read_placement(const HoudiniGeometry& geometry, const Columns& detail, Placement& placement)
{
    if (!find(geometry.detail_attributes, kOrigin) && !find(geometry.detail_attributes, kUnit))
        return;
    const auto& origin = detail.get<std::vector<double>>(kOrigin, 3);
    placement.origin = openvdb::Vec3d(origin[0], origin[1], origin[2]);
    placement.unit = detail.get<std::vector<double>>(kUnit, 1)[0];
    // A unit that is no power of two would round the coordinates once more on their way out. frexp
    // gives the fraction 0.5 for powers of two alone, and -0.5 for their negatives.
    int exponent = 0;
    if (!placement.origin.isFinite())
        detail.fail(kOrigin, "is not finite");
    if (!std::isfinite(placement.unit) || std::frexp(placement.unit, &exponent) != 0.5)
        detail.fail(kUnit, "is " + std::to_string(placement.unit) + ", not a power of two");
}

/// Nothing where the file says nothing of a core.
AddedSize read_core_size(const HoudiniGeometry& geometry, const Columns& detail)
{
    if (!find(geometry.detail_attributes, kCoreTetCount))
        return {};
    return {detail.count(kCorePointCount, geometry.points),
            detail.count(kCoreTetCount, geometry.primitives.size())};
}

/// The shell of a geometry that has no core, without checksum and digests.
ShellFile shell_alone(const HoudiniGeometry& geometry, const std::string& name)
{
    const Columns detail(geometry.detail_attributes, "detail attribute", name);
    const Columns points(geometry.point_attributes, "point attribute", name);
    const Columns primitives(geometry.primitive_attributes, "primitive attribute", name);
    const Counts counts = read_counts(geometry, detail, name);
    ShellFile file;
    file.stack.tapered = counts.tapered;
    const std::vector<std::size_t> prisms = read_prisms(primitives, counts);
    const Ids ids = read_pillars(geometry, points, counts, file.stack);
    read_triangles(geometry, counts, ids, prisms, name, file.stack);
    read_splits(primitives, counts, prisms, name, file.stack);
    read_tets(geometry, points, counts, prisms, file.tets);
    file.stack.splits.front().ripples =
        detail.count(kRipples, std::numeric_limits<std::int32_t>::max());
    read_placement(geometry, detail, file.placement);
    file.parameters_json = detail.text(kParameters);
    file.report_json = detail.text(kReport);
    // To the library an inconsistent shell is a wrong argument, here it is a damaged file.
    try {
        vdb_shell::require_consistent(file.stack, file.tets);
    } catch (const InvalidOption& error) {
        refuse(name, std::string("its parts do not fit together: ") + error.what());
    }
    if (counts.posed)
        file.rest.surface =
            vectors_by_surface(number_points(file.stack, {}), points.vectors(kRest));
    if (counts.posed && find(geometry.point_attributes, kVelocity))
        file.rest.velocity.surface =
            vectors_by_surface(number_points(file.stack, {}), points.vectors(kVelocity));
    file.core_feet = read_core_attributes(geometry, points, file.stack, name);
    return file;
}

ShellFile with_its_core(const HoudiniGeometry& geometry, const std::string& name)
{
    const AddedSize size =
        read_core_size(geometry, Columns(geometry.detail_attributes, "detail attribute", name));
    if (size.tets == 0)
        return shell_alone(geometry, name);
    ShellFile file = shell_alone(without_last(geometry, size, name), name);
    read_core(geometry, size, name, file);
    return file;
}

} // namespace

bool is_shell(const HoudiniGeometry& geometry)
{
    return find(geometry.detail_attributes, kSchema) != nullptr;
}

ShellFile shell_of_geometry(const HoudiniGeometry& geometry, const std::string& name)
{
    if (!is_shell(geometry))
        refuse(name,
               std::string("it holds no shell: detail attribute \"") + kSchema + "\" is missing");
    const Columns detail(geometry.detail_attributes, "detail attribute", name);
    const std::size_t input = find(geometry.detail_attributes, kInputPointCount)
                                  ? detail.count(kInputPointCount, geometry.points)
                                  : 0;
    ShellFile file = input > 0 ? with_its_core(without_last(geometry, {input, 0}, name), name)
                               : with_its_core(geometry, name);
    if (input > 0)
        file.input = read_input_points(geometry, input, file.stack.surface(0).size(), name);
    const std::string found = checksum_of(file.stack, file.tets, file.core);
    if (found != detail.text(kChecksum))
        refuse(name, "the shell's arrays have checksum " + found + ", the file says " +
                         detail.text(kChecksum));
    // After the others, whose messages say more.
    file.digests = require_digests(geometry, name);
    return file;
}

ShellFile read_shell_geometry(const std::filesystem::path& path)
{
    return shell_of_geometry(read_geometry(path).geometry, path.string());
}

} // namespace vdb_shell::houdini
