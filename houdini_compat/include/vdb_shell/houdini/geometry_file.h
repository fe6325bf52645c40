// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/houdini/geometry.h"

#include <filesystem>
#include <iosfwd>
#include <string>

namespace vdb_shell
{
class OutputSet;
}

namespace vdb_shell::houdini
{

/// Forms of one and the same document (docs/houdini.md).
enum class Format {
    text,       ///< .geo: JSON
    binary,     ///< .bgeo: Houdini's binary JSON
    compressed, ///< .bgeo.sc: that in Blosc chunks
};
const char* name_of(Format format);

/// True for names that end in .geo, .bgeo or .bgeo.sc, in any case.
bool has_geometry_extension(const std::filesystem::path& path);

struct ReadGeometry {
    HoudiniGeometry geometry;
    Format format = Format::text;
};

/// Reads any of the three forms, told apart by content. Polygons and tetrahedra, one by one or in
/// runs of the old and the new kind; attributes of numbers (those of 8 and 16 bits are widened to
/// int32 and float) and of strings; unordered groups. Attributes and groups of other kinds are
/// named in HoudiniGeometry::unread; other primitives (curves, volumes, packed ones...) are
/// refused. All counts are held against the bytes that are there before anything is allocated by
/// them, nesting against a limit of 64. Throws ReadError with file, element, value and limit.
ReadGeometry read_geometry(const std::filesystem::path& path);

/// The same for the bytes of a file; `name` opens the messages.
ReadGeometry parse_geometry(const std::string& bytes, const std::string& name);

/// Writes the form of the extension. Nothing in the file tells day or machine: same bytes for the
/// same geometry. The file appears whole or not at all. Throws InvalidOption as require_consistent
/// does, for another extension, and for a value that a form has no way to write (text: numbers that
/// are not finite, strings that are not UTF-8); WriteError.
void write_geometry(const std::filesystem::path& path, const HoudiniGeometry& geometry,
                    OutputSet* with = nullptr);

/// The same to a stream. Precondition: require_consistent.
void write_geometry(std::ostream& out, const HoudiniGeometry& geometry, Format format);

} // namespace vdb_shell::houdini
