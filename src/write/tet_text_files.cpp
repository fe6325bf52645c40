// SPDX-License-Identifier: Apache-2.0

// Tets as text: TetGen's .node and .ele, Medit's .mesh, Gmsh's .msh (format 4.1). Digits are the
// shortest that give the same double again and independent of the locale (TextOut), so the float32
// that were certified survive the text. Points keep their order; indices begin at 0 for TetGen and
// at 1 for Medit and Gmsh. What stands where is in docs/file_format.md.

#include "vdb_shell/mesh/triangle_mesh.h"
#include "vdb_shell/shell/core_tets.h"

#include "vdb_shell/write/text_out.h"
#include "write/tet_formats.h"

namespace vdb_shell
{
namespace
{

void write_corners(TextOut& text, const openvdb::Vec4I& tet, std::uint32_t base)
{
    for (int corner = 0; corner < 4; ++corner)
        text << ' ' << tet[corner] + base;
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

/// One entity, a volume, with the box that format 4.1 asks for. Scaling by a power of two and
/// adding in double is what placed() does to the points, so the box holds them.
void write_gmsh_entities(TextOut& text, const TetMesh& tets, const Placement& placement)
{
    const Bounds bounds = tets.points.empty() ? Bounds{} : bounds_of(tets.points);
    text << "$Entities\n0 0 0 1\n1";
    for (const openvdb::Vec3d& corner : {bounds.low, bounds.high})
        for (int axis = 0; axis < 3; ++axis)
            text << ' ' << placement.origin[axis] + placement.unit * corner[axis];
    text << " 0 0\n$EndEntities\n";
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

void write_medit(std::ostream& out, const TetMesh& tets, const Placement& placement)
{
    TextOut text(out);
    // Version 2: coordinates are read as doubles.
    text << "MeshVersionFormatted 2\nDimension 3\nVertices\n" << tets.points.size() << '\n';
    const std::vector<std::int32_t> layer = signed_numbers(tets.layer);
    for (std::size_t i = 0; i < tets.points.size(); ++i)
        text << placed(placement, tets.points[i]) << ' ' << layer[i] << '\n';
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
    const std::size_t points = tets.points.size(), count = tets.tets.size();
    // Version, text, and bytes of a size_t as a binary file would have them.
    text << "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n";
    write_gmsh_entities(text, tets, placement);
    // One block, its tags from 1 on without a gap; then the block: of dimension 3, entity 1,
    // without parameters.
    text << "$Nodes\n1 " << points << " 1 " << points << "\n3 1 0 " << points << '\n';
    for (std::size_t i = 0; i < points; ++i)
        text << i + 1 << '\n';
    // Format 4.1 lists all tags of a block first and then all coordinates.
    for (const openvdb::Vec3s& point : tets.points)
        text << placed(placement, point) << '\n';
    constexpr int kFourNodeTet = 4;
    text << "$EndNodes\n$Elements\n1 " << count << " 1 " << count << "\n3 1 " << kFourNodeTet << ' '
         << count << '\n';
    for (std::size_t t = 0; t < count; ++t) {
        text << t + 1;
        write_corners(text, tets.tets[t], 1);
        text << '\n';
    }
    text << "$EndElements\n";
    write_gmsh_data(text, "NodeData", "source_vertex", signed_numbers(tets.source_vertex));
    write_gmsh_data(text, "NodeData", "layer", signed_numbers(tets.layer));
    write_gmsh_data(text, "ElementData", "prism", signed_numbers(tets.prism));
    if (has_layers(tets))
        write_gmsh_data(text, "ElementData", "layer", signed_numbers(tets.prism_layer));
}

} // namespace vdb_shell
