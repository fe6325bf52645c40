// SPDX-License-Identifier: Apache-2.0
#include "fuzz/targets.h"

#include "vdb_shell/core/error.h"
#include "vdb_shell/houdini/polygon_mesh.h"
#include "vdb_shell/houdini/shell_geometry.h"

#include "houdini_compat/geometries.h"

namespace vdb_shell::fuzz
{
namespace
{

void require_comes_back(const houdini::HoudiniGeometry& geometry, houdini::Format format)
{
    std::string written;
    try {
        houdini::require_consistent(geometry);
        written = test::written(geometry, format);
    } catch (const InvalidOption&) {
        return; // no P, or a value that this form cannot hold
    }
    const houdini::HoudiniGeometry again = houdini::parse_geometry(written, "again").geometry;
    require(test::written(again, format) == written, "what was read is not written the same twice");
}

} // namespace

void houdini(std::string_view bytes)
{
    houdini::ReadGeometry read;
    try {
        read = houdini::parse_geometry(std::string(bytes), "fuzz");
    } catch (const ReadError&) {
        return;
    }
    try {
        houdini::polygon_mesh(read, "fuzz");
    } catch (const ReadError&) {
    }
    try {
        houdini::shell_of_geometry(read.geometry, "fuzz");
    } catch (const ReadError&) {
    }
    require_comes_back(read.geometry, read.format);
}

} // namespace vdb_shell::fuzz
