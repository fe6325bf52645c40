// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/core/words.h"
#include "vdb_shell/options/name_table.h"

#include <filesystem>
#include <optional>
#include <string>

namespace vdb_shell
{

/// The files of triangle surfaces that are both read and written here.
enum class MeshFormat { obj, ply, off, stl };

/// By extension.
inline const NameTable<MeshFormat>& names(MeshFormat)
{
    static const NameTable<MeshFormat> table{{".obj", MeshFormat::obj},
                                             {".ply", MeshFormat::ply},
                                             {".off", MeshFormat::off},
                                             {".stl", MeshFormat::stl}};
    return table;
}

/// By the extension, in any case of letters. The extension decides and not the first bytes, as OBJ
/// has no mark to be known by.
inline std::optional<MeshFormat> mesh_format_of(const std::filesystem::path& path)
{
    const std::string extension = lower_case_extension(path);
    for (const auto& [known, format] : names(MeshFormat{}))
        if (extension == known)
            return format;
    return std::nullopt;
}

/// What is to be said of a path that has none of them.
inline std::string no_mesh_format(const std::filesystem::path& path)
{
    std::string text =
        "the extension \"" + lower_case_extension(path) + "\" is none of the mesh formats ";
    const char* between = "";
    for (const auto& [known, format] : names(MeshFormat{})) {
        text += between + known;
        between = ", ";
    }
    return text;
}

} // namespace vdb_shell
