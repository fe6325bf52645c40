// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/write/cross_section.h"
#include "vdb_shell/write/vdb_file.h"
#include "vdb_shell/write/view.h"

#include <filesystem>

namespace vdb_shell
{

enum class PictureKind {
    section, ///< what a plane cuts, flat (write_cross_section)
    surface, ///< the outermost surface, shaded
    cut_away ///< the same without what lies on the viewer's side of the plane: solid tets there
};
const NameTable<PictureKind>& names(PictureKind);

enum class PictureColours {
    prism,    ///< tints that differ between neighbours, and mean nothing else
    layer,    ///< from the outermost, light, to the innermost, dark
    quality,  ///< smallest dihedral angle: red at 0, sand at 15, blue at 30 degrees and more; of a
              ///< triangle of the surface that of its worst tet
    thickness ///< length of the pillars over the longest: light where thin, dark where thick
};
const NameTable<PictureColours>& names(PictureColours);

struct PictureOptions {
    PictureKind kind = PictureKind::section;
    CrossSectionOptions section;
    ViewOptions view;
    PictureColours colours = PictureColours::prism; ///< not of a section
};
OptionList describe(PictureOptions& options);

/// Throws InvalidOption where options are out of range or contradict each other.
void require_sensible(const PictureOptions& options);

/// Draws the shell as a PNG; grids are not needed. The picture in space is drawn without
/// perspective and fills its frame; that of a turntable or of a posed shell is square and about a
/// sphere that stays in place: the one around the shell, of a posed one that around the shell at
/// rest, enlarged by kPosedRoom. Same bytes for any number of threads. Throws InvalidOption,
/// WriteError.
void write_picture(const std::filesystem::path& path, const ShellFile& file,
                   const PictureOptions& options = {}, OutputSet* with = nullptr);
/// Room that a posed shell has beside its shape at rest: an arm held out reaches as far again as
/// half of a figure's height.
inline constexpr double kPosedRoom = 1.3;

/// Two shells side by side, at one scale, cut by the same plane (at its share of the first one's
/// bounding box).
void write_picture_pair(const std::filesystem::path& path, const ShellFile& left,
                        const ShellFile& right, const PictureOptions& options = {},
                        OutputSet* with = nullptr);

} // namespace vdb_shell
