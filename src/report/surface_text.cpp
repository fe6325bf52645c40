// SPDX-License-Identifier: Apache-2.0

// Takes: the figures of one run. Gives: the first lines of the report for people, on the surface
// that was read, mended, wrapped and resampled. Lines of stages that did not run are left out.
// Triangles and vertices are counted in full, since they are compared with other programs' counts.

#include "report/surface_text.h"

#include "mesh/placement_json.h"
#include "report/resample_report.h"
#include "report/text_lines.h"

namespace vdb_shell
{
namespace
{

/// Of the surface that was worked with, which need not be the one in the file.
std::string mesh_lines(const MeshCheck& mesh)
{
    std::string text = number(mesh.points, 12) + " vertices, " + number(mesh.triangles, 12) +
                       " triangles, " + number(mesh.components.size(), 12) +
                       (mesh.components.size() == 1 ? " component" : " components");
    // Said in both cases: all that follows rests on it, and silence could mean that it was not
    // looked at.
    text += mesh.closed() ? ", closed" : ", OPEN";
    text += mesh.manifold() ? ", manifold" : ", NOT MANIFOLD";
    if (!mesh.embedded())
        text += (mesh.self_intersections.at_least ? ", at least " : ", ") +
                number(mesh.self_intersections.count, 12) + " SELF-INTERSECTIONS";
    return text;
}

/// The first of the vertices by index, those of the input, so that they can be found in the file
/// that was read.
std::string split_text(const ShellReport& report)
{
    std::string text = number(report.split_vertices.count, 12) +
                       (report.split_vertices.count == 1 ? " vertex" : " vertices") +
                       " of several fans, copied " + number(report.vertex_copies, 12) +
                       (report.vertex_copies == 1 ? " time" : " times") + " (first";
    for (const std::uint32_t vertex : report.split_vertices.first)
        text += " " + number(vertex, 12);
    return text + ")";
}

std::string contour_text(const ContourReport& contour)
{
    std::string text = number(contour.triangles, 12) + " triangles, simplified to " +
                       number(contour.simplified_triangles, 12);
    if (contour.method == ContourMethod::marching_tets)
        text += "; by marching tets, for volume to mesh left " +
                number(contour.volume_to_mesh_defects, 12) + " defects";
    // Said only where it happened: it changes what the solid is.
    if (contour.dropped_components > 0)
        text += "; " + number(contour.dropped_components, 12) + " inner components left out";
    return text;
}

/// Lengths also in voxels, which are what bounds the detail of a wrap.
void wrap_lines(std::ostringstream& out, const WrapReport& wrap)
{
    // Said only where it happened: it changes what the solid is.
    const std::string filled =
        wrap.filled_voxels > 0
            ? "; voids of " + number(wrap.filled_voxels, 12) + " of its voxels made solid"
            : "";
    line(out, "wrap",
         "voxel " + number(wrap.voxel_size) + ", " + contour_text(wrap.contour) + filled);
    line(out, "  input",
         percent(wrap.boundary_share) + " of its area bounds the solid, " +
             percent(wrap.sheet_share) + " thickened as sheets, " + percent(wrap.interior_share) +
             " inside");
    const auto distance = [&](const DistanceFigures& figures) {
        return "mean " + number(figures.mean) + ", max " + number(figures.max) + " (" +
               number(figures.max / wrap.voxel_size, 3) + " voxels)";
    };
    line(out, "  distance",
         "input to wrap " + distance(wrap.input_to_wrap) + "; wrap to input " +
             distance(wrap.wrap_to_input));
}

/// What was tried, and why it was not enough.
void mend_lines(std::ostringstream& out, const std::vector<MendAttempt>& attempts)
{
    for (const MendAttempt& attempt : attempts)
        line(out, &attempt == &attempts.front() ? "mend" : "",
             name_in_table(attempt.tried) + ": " +
                 (attempt.refusal.empty() ? "taken" : attempt.refusal));
}

void read_lines(std::ostringstream& out, const ReadReport& read)
{
    line(out, "read",
         read.format + ": " + number(read.file_vertices, 12) + " vertices, " +
             number(read.file_faces, 12) + " faces; " + number(read.polygons_triangulated, 12) +
             " polygons triangulated, " + number(read.welded_vertices, 12) + " vertices welded, " +
             number(read.unused_vertices, 12) + " unused, " +
             number(read.skipped_faces.size(), 12) + " faces skipped");
    // A file that was read as it stands has no other frame to tell of.
    if (read.placement.moves())
        line(out, "  placed", placement_text(read.placement));
}

} // namespace

void surface_lines(std::ostringstream& out, const ShellReport& report)
{
    line(out, "source", report.source);
    if (report.read)
        read_lines(out, *report.read);
    mend_lines(out, report.mend);
    if (report.repair)
        // The repair has lines of its own, the same that the command prints for a repair alone.
        out << "repair\n" << repair_text(*report.repair);
    if (report.wrap)
        wrap_lines(out, *report.wrap);
    if (report.contour)
        line(out, "contour", contour_text(*report.contour));
    if (report.retriangulate)
        retriangulate_lines(out, *report.retriangulate);
    if (report.decimate)
        decimate_line(out, *report.decimate);
    if (report.remesh)
        remesh_lines(out, *report.remesh);
    if (report.subdivided_from > 0)
        line(out, "subdivide", "from " + number(report.subdivided_from, 12) + " triangles");
    line(out, "mesh", mesh_lines(report.mesh));
    if (report.vertex_copies > 0)
        line(out, "split", split_text(report));
}

} // namespace vdb_shell
