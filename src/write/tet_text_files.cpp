// SPDX-License-Identifier: Apache-2.0

// Tets as text: TetGen's .node, .ele and .face, Medit's .mesh, Gmsh's .msh (format 4.1). Digits are
// the shortest that give the same double again and independent of the locale (TextOut), so the
// float32 that were certified survive the text. Points keep their order; indices begin at 0 for
// TetGen and at 1 for Medit and Gmsh. What stands where is in docs/file_format.md.

#include "vdb_shell/mesh/triangle_mesh.h"
#include "vdb_shell/shell/core_tets.h"

#include "vdb_shell/write/text_out.h"
#include "write/tet_boundary.h"
#include "write/tet_formats.h"

#include <algorithm>
#include <string>
#include <utility>

namespace vdb_shell
{
namespace
{

/// Of a tet or a triangle.
template <typename Corners>
void write_corners(TextOut& text, const Corners& corners, std::uint32_t base)
{
    for (int corner = 0; corner < int(Corners::size); ++corner)
        text << ' ' << corners[corner] + base;
}

openvdb::Vec3d placed(const Placement& placement, const openvdb::Vec3s& point)
{
    // Adding an origin of 0 would turn -0 into 0, which are different floats and would change the
    // bytes of a file that is read back.
    return placement.moves() ? placement.in_file(point) : openvdb::Vec3d(point);
}

/// One named scalar per node or element, tags from 1. The numbers between the name and the values
/// are Gmsh's tags: one string, one real (the time, 0), three integers (the step, the number of
/// components, the number of values).
void write_gmsh_data(TextOut& text, const char* section, const char* name,
                     const std::vector<std::int32_t>& values)
{
    text << '$' << section << "\n1\n\"" << name << "\"\n1\n0\n3\n0\n1\n" << values.size() << '\n';
    for (std::size_t i = 0; i < values.size(); ++i)
        text << i + 1 << ' ' << values[i] << '\n';
    text << "$End" << section << '\n';
}

/// Tets of one layer of the shell, or those of the core: they stand together.
struct Volume {
    std::size_t first, last;
    std::string name;
};

std::vector<Volume> volumes_of(const TetMesh& tets)
{
    std::vector<Volume> volumes;
    const std::vector<std::uint8_t>& layer = tets.prism_layer;
    const bool several = std::any_of(layer.begin(), layer.end(),
                                     [](std::uint8_t one) { return one > 0 && one != kCoreLayer; });
    for (std::size_t first = 0, last = 0; first < layer.size(); first = last) {
        while (last < layer.size() && layer[last] == layer[first])
            ++last;
        volumes.push_back({first, last,
                           layer[first] == kCoreLayer ? "core"
                           : several                  ? "layer_" + std::to_string(layer[first])
                                                      : "shell"});
    }
    return volumes;
}

/// The triangles of one kind of boundary; files number it as TetBoundary does.
struct Surface {
    TetBoundary boundary;
    std::vector<std::size_t> places; ///< among all triangles

    int number() const { return int(boundary); }
};

/// Those that there are.
std::vector<Surface> surfaces_of(const std::vector<BoundaryTriangle>& boundary)
{
    std::vector<Surface> surfaces;
    for (const auto& [name, kind] : names(TetBoundary{})) {
        Surface surface{kind, {}};
        for (std::size_t i = 0; i < boundary.size(); ++i)
            if (boundary[i].boundary == kind)
                surface.places.push_back(i);
        if (!surface.places.empty())
            surfaces.push_back(std::move(surface));
    }
    return surfaces;
}

/// What a .msh is made of. Volumes are numbered from 1.
struct GmshParts {
    const std::vector<BoundaryTriangle>& boundary;
    std::vector<Surface> surfaces;
    std::vector<Volume> volumes;

    std::size_t count() const { return surfaces.size() + volumes.size(); }
};

/// Dimension, number and name of what solvers choose parts of the mesh by.
void write_gmsh_names(TextOut& text, const GmshParts& parts)
{
    text << "$PhysicalNames\n" << parts.count() << '\n';
    for (const Surface& surface : parts.surfaces)
        text << "2 " << surface.number() << " \"" << name_in_table(surface.boundary) << "\"\n";
    for (std::size_t k = 0; k < parts.volumes.size(); ++k)
        text << "3 " << k + 1 << " \"" << parts.volumes[k].name << "\"\n";
    text << "$EndPhysicalNames\n";
}

/// Surfaces and volumes, each with the box of the whole, which format 4.1 asks for, and with the
/// physical group of its own number; none has parts that bound it. Scaling by a power of two and
/// adding in double is what placed() does to the points, so the box holds them.
void write_gmsh_entities(TextOut& text, const TetMesh& tets, const GmshParts& parts,
                         const Placement& placement)
{
    const Bounds bounds = tets.points.empty() ? Bounds{} : bounds_of(tets.points);
    const auto write = [&](std::size_t number) {
        text << number;
        for (const openvdb::Vec3d& corner : {bounds.low, bounds.high})
            for (int axis = 0; axis < 3; ++axis)
                text << ' ' << placement.origin[axis] + placement.unit * corner[axis];
        text << " 1 " << number << " 0\n";
    };
    text << "$Entities\n0 0 " << parts.surfaces.size() << ' ' << parts.volumes.size() << '\n';
    for (const Surface& surface : parts.surfaces)
        write(std::size_t(surface.number()));
    for (std::size_t k = 0; k < parts.volumes.size(); ++k)
        write(k + 1);
    text << "$EndEntities\n";
}

/// Tets first, so that a tet's tag is its number and the data of elements, which some readers take
/// in the order of the elements, begin with theirs.
void write_gmsh_elements(TextOut& text, const TetMesh& tets, const GmshParts& parts)
{
    constexpr int kTriangle = 2, kFourNodeTet = 4;
    const std::size_t count = tets.tets.size() + parts.boundary.size();
    text << "$Elements\n" << parts.count() << ' ' << count << " 1 " << count << '\n';
    for (std::size_t k = 0; k < parts.volumes.size(); ++k) {
        const Volume& volume = parts.volumes[k];
        text << "3 " << k + 1 << ' ' << kFourNodeTet << ' ' << volume.last - volume.first << '\n';
        for (std::size_t t = volume.first; t < volume.last; ++t) {
            text << t + 1;
            write_corners(text, tets.tets[t], 1);
            text << '\n';
        }
    }
    std::size_t tag = tets.tets.size();
    for (const Surface& surface : parts.surfaces) {
        text << "2 " << surface.number() << ' ' << kTriangle << ' ' << surface.places.size()
             << '\n';
        for (const std::size_t place : surface.places) {
            text << ++tag;
            write_corners(text, parts.boundary[place].corners, 1);
            text << '\n';
        }
    }
    text << "$EndElements\n";
}

/// By element, what its tet has: a triangle has that of the tet whose face it is.
template <typename Number>
std::vector<std::int32_t> by_element(const std::vector<Number>& by_tet, const GmshParts& parts)
{
    std::vector<std::int32_t> values = signed_numbers(by_tet);
    values.reserve(values.size() + parts.boundary.size());
    for (const Surface& surface : parts.surfaces)
        for (const std::size_t place : surface.places)
            values.push_back(values[parts.boundary[place].tet]);
    return values;
}

} // namespace

void write_tetgen_node(std::ostream& out, const TetMesh& tets, const Placement& placement)
{
    TextOut text(out);
    // TetGen's readers pass over lines that begin with #. The numbers behind are those of points,
    // dimensions, attributes and boundary markers.
    text << "# index x y z source_vertex layer\n" << tets.points.size() << " 3 2 0\n";
    const std::vector<std::int32_t> vertex = signed_numbers(tets.source_vertex);
    const std::vector<std::int32_t> layer = signed_numbers(tets.layer);
    for (std::size_t i = 0; i < tets.points.size(); ++i)
        text << i << ' ' << placed(placement, tets.points[i]) << ' ' << vertex[i] << ' ' << layer[i]
             << '\n';
}

void write_tetgen_ele(std::ostream& out, const TetMesh& tets)
{
    TextOut text(out);
    const bool layers = has_layers(tets);
    text << "# index a b c d prism" << (layers ? " layer\n" : "\n") << tets.tets.size()
         << (layers ? " 4 2\n" : " 4 1\n");
    const std::vector<std::int32_t> prism = signed_numbers(tets.prism);
    const std::vector<std::int32_t> layer = signed_numbers(tets.prism_layer);
    for (std::size_t t = 0; t < tets.tets.size(); ++t) {
        text << t;
        write_corners(text, tets.tets[t], 0);
        text << ' ' << prism[t];
        if (layers)
            text << ' ' << layer[t];
        text << '\n';
    }
}

void write_tetgen_face(std::ostream& out, const TetMesh& tets)
{
    TextOut text(out);
    const std::vector<BoundaryTriangle> boundary = boundary_of(tets);
    text << "# index a b c boundary\n" << boundary.size() << " 1\n";
    for (std::size_t i = 0; i < boundary.size(); ++i) {
        text << i;
        write_corners(text, boundary[i].corners, 0);
        text << ' ' << int(boundary[i].boundary) << '\n';
    }
}

void write_medit(std::ostream& out, const TetMesh& tets, const Placement& placement)
{
    TextOut text(out);
    // Version 2: coordinates are read as doubles.
    text << "MeshVersionFormatted 2\nDimension 3\nVertices\n" << tets.points.size() << '\n';
    const std::vector<std::int32_t> layer = signed_numbers(tets.layer);
    for (std::size_t i = 0; i < tets.points.size(); ++i)
        text << placed(placement, tets.points[i]) << ' ' << layer[i] << '\n';
    const std::vector<BoundaryTriangle> boundary = boundary_of(tets);
    text << "Triangles\n" << boundary.size() << '\n';
    for (const BoundaryTriangle& triangle : boundary) {
        for (int corner = 0; corner < 3; ++corner)
            text << triangle.corners[corner] + 1u << ' ';
        text << int(triangle.boundary) << '\n';
    }
    text << "Tetrahedra\n" << tets.tets.size() << '\n';
    for (std::size_t t = 0; t < tets.tets.size(); ++t) {
        for (int corner = 0; corner < 4; ++corner)
            text << tets.tets[t][corner] + 1u << ' ';
        // One region for all tets of the shell: remeshers keep the borders between different
        // references, and faces between prisms must not become such borders.
        text << (tets.prism_layer[t] == kCoreLayer ? "2\n" : "1\n");
    }
    text << "End\n";
}

void write_gmsh(std::ostream& out, const TetMesh& tets, const Placement& placement)
{
    TextOut text(out);
    const std::size_t points = tets.points.size();
    const std::vector<BoundaryTriangle> boundary = boundary_of(tets);
    const GmshParts parts{boundary, surfaces_of(boundary), volumes_of(tets)};
    // Version, text, and bytes of a size_t as a binary file would have them.
    text << "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n";
    write_gmsh_names(text, parts);
    write_gmsh_entities(text, tets, parts, placement);
    // One block, its tags from 1 on without a gap; then the block: of dimension 3, entity 1,
    // without parameters.
    text << "$Nodes\n1 " << points << " 1 " << points << "\n3 1 0 " << points << '\n';
    for (std::size_t i = 0; i < points; ++i)
        text << i + 1 << '\n';
    // Format 4.1 lists all tags of a block first and then all coordinates.
    for (const openvdb::Vec3s& point : tets.points)
        text << placed(placement, point) << '\n';
    text << "$EndNodes\n";
    write_gmsh_elements(text, tets, parts);
    write_gmsh_data(text, "NodeData", "source_vertex", signed_numbers(tets.source_vertex));
    write_gmsh_data(text, "NodeData", "layer", signed_numbers(tets.layer));
    write_gmsh_data(text, "ElementData", "prism", by_element(tets.prism, parts));
    if (has_layers(tets))
        write_gmsh_data(text, "ElementData", "layer", by_element(tets.prism_layer, parts));
}

} // namespace vdb_shell
