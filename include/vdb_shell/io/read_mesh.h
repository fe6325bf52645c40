// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/mesh/placement.h"
#include "vdb_shell/mesh/triangle_mesh.h"
#include "vdb_shell/options/describe.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace vdb_shell
{
class OutputSet;

struct ReadOptions {
    /// Merge vertices of exactly equal float32 position (seams of OBJ files). Off, the vertices
    /// stay as the file has them; but STL has no vertices to keep, so there equal positions are
    /// merged in any case.
    bool weld = true;
    /// Read the object about a point near its middle, which ReadReport::placement keeps: what the
    /// file says in more digits than float32 has far from the origin is not lost.
    bool recentre = false;
    /// Read the object in a unit near its size: for objects of microns, and beyond 1e18.
    bool rescale = false;
};
OptionList describe(ReadOptions& options);

/// What a file said and what became of it. `file_*` counts what the file declares or lists, before
/// anything is left out, so that the counts have to add up and nothing is lost without a word.
struct ReadReport {
    std::string format;                    ///< "OBJ", "PLY (binary)", ...
    std::size_t file_vertices = 0;         ///< vertices that the file declares or lists
    std::size_t file_faces = 0;            ///< faces that the file declares or lists
    std::size_t polygons_triangulated = 0; ///< faces of more than three corners
    std::size_t welded_vertices = 0;       ///< vertices merged into an equal one before them
    std::size_t unused_vertices = 0;       ///< vertices of the file that no triangle uses; dropped
    /// File faces left out, ascending: repeats of the corner before left aside, they have fewer
    /// than three corners or none that comes only once (by index, and by position when welded).
    std::vector<std::size_t> skipped_faces;
    Placement placement; ///< moves nothing unless ReadOptions ask for that
    /// The farthest that rounding to float32 moved a coordinate, in the mesh's units.
    double largest_rounding = 0;
};

struct ReadResult {
    TriangleMesh mesh;
    ReadReport report;
    /// By point of the mesh: the vertex property `id` of a PLY file, the point attribute `id` of
    /// Houdini geometry, which name a vertex whatever its place in the file; of merged vertices
    /// that of the first. Empty where the file has none, or none of whole numbers.
    std::vector<std::int64_t> ids;
    /// By face of the file that was kept, its first triangle; a face's triangles stand one after
    /// the other. Empty where each face is one triangle.
    std::vector<std::uint32_t> first_triangles;
};

/// Reads OBJ, PLY, OFF or STL by extension; docs/mesh_files.md lists the forms that are understood.
/// Polygons are triangulated: a fan when convex, else by cutting ears in the plane of the Newell
/// normal, which is right for planar simple polygons (of up to 1000 corners; a fan beyond).
/// Throws ReadError with file, element and value: missing, empty or truncated file, unknown
/// extension, a coordinate that is not finite in float32 or over kLargestCoordinate, a face index
/// out of range, no faces, data beyond what a header declares, and binary OFF, of which there are
/// two incompatible kinds. Text coordinates are rounded once, to the nearest float32 (of the
/// difference from an origin, in double, with `recentre`). Guarantee: file_faces = polygons kept +
/// skipped_faces.size(); every triangle of the mesh indexes three different points; points stand in
/// the file's order.
ReadResult read_mesh(const std::filesystem::path& path, const ReadOptions& options = {});

/// Writes OBJ, PLY (binary), OFF or STL (binary), by extension. Coordinates are written so that
/// reading them gives the same float32 bit for bit. With a placement that moves they are written
/// where the file had them, as doubles; STL has none and is refused. The file appears whole or not
/// at all. Throws WriteError; InvalidOption for an unknown extension.
void write_mesh(const std::filesystem::path& path, const TriangleMesh& mesh,
                const Placement& placement = {}, OutputSet* with = nullptr);

/// Throws the InvalidOption of write_mesh for a placement that the format has no place for; for
/// callers that know the placement long before they write.
void require_place_for(const std::filesystem::path& path, const Placement& placement);

} // namespace vdb_shell
