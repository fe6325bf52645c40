// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/field/level_set.h"
#include "vdb_shell/io/read_mesh.h"
#include "vdb_shell/mesh/check_mesh.h"
#include "vdb_shell/options/describe.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace vdb_shell
{
class OutputSet;

/// Boundary edges in a row. Where boundaries meet in a point they are told apart.
struct BoundaryLoop {
    std::uint32_t first_point = 0;
    std::size_t edges = 0;
    double length = 0;  ///< world units
    bool closed = true; ///< off where non-manifold edges leave a boundary without an end
};

/// Neighbouring triangles that are oriented against the larger rest of their piece.
struct FlippedPatch {
    std::uint32_t first_triangle = 0;
    std::size_t triangles = 0;
};

/// What float32 leaves of the coordinates.
struct FloatLimits {
    double farthest = 0; ///< largest absolute coordinate
    double spacing = 0;  ///< distance to the next float32 there
    /// Binary digits that coordinates have within the longest side of the bounding box: 24 around
    /// the origin, fewer far from it.
    int digits = 0;
    double shortest_edge = 0; ///< of length more than zero; 0 when there is none
    double longest_side = 0;  ///< of the bounding box
    /// How far rounding moved coordinates of the file; 0 where it had no more digits than these.
    double largest_rounding = 0;
};

/// Everything that stands in the way of a shell, or will show in it.
struct MeshInspection {
    MeshCheck check;
    std::vector<BoundaryLoop> boundary_loops;  ///< by first point
    std::vector<FlippedPatch> flipped_patches; ///< by first triangle
    /// First triangles of pieces that no turning of triangles makes two-sided (Moebius strip, Klein
    /// bottle).
    Defect<std::uint32_t> one_sided_pieces;
    /// Vertices from which no direction sees all their triangles: the smallest cosine to the
    /// normals is not positive for any. Growth pins them.
    Defect<std::uint32_t> blind_vertices;
    /// Triangles from whose middle the opposite side of the surface is nearer than a voxel,
    /// triangles with a common corner aside.
    Defect<std::uint32_t> thin_triangles;
    double voxel_size = 0; ///< of the level set that was asked for, world units
    FloatLimits floats;
};

struct InspectOptions {
    LevelSetOptions level_set;   ///< for what is thinner than a voxel
    double largest_rounding = 0; ///< ReadReport::largest_rounding: tells who lost the digits
};
OptionList describe(InspectOptions& options);

/// Looks at a surface however bad it is. Preconditions and exactness as check_mesh; thin triangles
/// are measured in double. Throws InvalidOption, Cancelled; never for a bad surface.
MeshInspection inspect_mesh(const TriangleMesh& mesh, const InspectOptions& options = {},
                            Interrupter* interrupter = nullptr);

/// One kind of thing that inspect_mesh found.
struct Finding {
    std::string kind;               ///< "boundary_edges", ...
    std::string text;               ///< for a person, without the count
    std::size_t count = 0;          ///< never 0
    std::vector<std::string> first; ///< the first of them: indices, pairs, loops
    bool blocks = false;            ///< `build` refuses the surface because of it
    std::string mend;               ///< the option or the act that mends it
};
std::vector<Finding> findings_of(const MeshInspection& inspection);

/// Whether `build` takes the surface as it is.
bool usable(const MeshInspection& inspection);

/// For a person: one line a finding, and the verdict.
std::string inspection_text(const std::string& name, const ReadReport& read,
                            const MeshInspection& inspection);
/// The same as JSON, two-space indent, with every loop, patch and component.
std::string inspection_json(const std::string& name, const ReadReport& read,
                            const MeshInspection& inspection);

/// Writes the mesh as binary PLY with each point and triangle coloured by its worst defect, and a
/// property `defects` whose bits name all of them (docs/stages/repair.md). Throws what
/// inspect_mesh throws; InvalidOption for another extension than .ply; WriteError.
void write_defect_picture(const std::filesystem::path& path, const TriangleMesh& mesh,
                          const InspectOptions& options = {}, OutputSet* with = nullptr,
                          Interrupter* interrupter = nullptr);

} // namespace vdb_shell
