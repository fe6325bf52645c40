// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/options/describe.h"
#include "vdb_shell/write/vdb_file.h"
#include "vdb_shell/write/view.h"

#include <filesystem>
#include <vector>

namespace vdb_shell
{
class OutputSet;

/// What the stage says of its coordinates; they themselves are written as they are.
struct UsdOptions {
    UpAxis up_axis = UpAxis::y;
    double meters_per_unit = 1.0;
    double frames_per_second = 24.0; ///< of stages with several samples
};
OptionList describe(UsdOptions& options);

/// The shell at one time.
struct UsdSample {
    double time = 0.0; ///< time code: the frame
    const ShellFile* shell = nullptr;
    /// The .vdb that holds shell->surface and shell->depth; empty: the stage gets no volume.
    std::filesystem::path volume;
};

/// Writes a stage as text (.usda): Mesh "surface", which is the skin, right-handed TetMesh "tets"
/// of all layers with the faces of its boundary, and Volume "grids" over the two volumes of the
/// .vdb, by a path relative to the stage. docs/usd.md lists attributes and primvars. With one
/// sample everything is timeless. With more, what differs between them is time-sampled. Numbers
/// read back as the same float32, same bytes for the same input; the file appears whole or not at
/// all. Throws InvalidOption for no samples, times that do not increase, a volume for some samples
/// only or without grids, options that are not positive and finite; GeometryError for samples whose
/// surfaces have different triangles or which have other layers; WriteError.
void write_usd(const std::filesystem::path& path, const std::vector<UsdSample>& samples,
               const UsdOptions& options = {}, OutputSet* with = nullptr);

/// Throws InvalidOption where the stage at `path` could not name the volume, because its path is no
/// UTF-8: asked before the work begins.
void require_usd_asset(const std::filesystem::path& path, const std::filesystem::path& volume);

/// The triangles that belong to one tet only, outward from it when it is positive; sorted.
std::vector<openvdb::Vec3I> boundary_triangles(const TetMesh& tets);

} // namespace vdb_shell
