// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/houdini/shell_geometry.h"
#include "vdb_shell/pipeline.h"
#include "vdb_shell/write/verify_file.h"

#include "houdini_compat/geometries.h"
#include "support/files.h"

#include <gtest/gtest.h>

#include <string>

namespace vdb_shell::test
{

/// Bit for bit, the grids aside.
inline void expect_same_shell(const ShellFile& found, const ShellFile& file)
{
    ASSERT_EQ(found.stack.layers.size(), file.stack.layers.size());
    EXPECT_EQ(found.stack.skin, file.stack.skin);
    for (std::size_t k = 0; k < file.stack.layers.size(); ++k) {
        const PrismShell &layer = found.stack.layers[k], &expected = file.stack.layers[k];
        EXPECT_TRUE(same_values(layer.outer, expected.outer)) << k;
        EXPECT_TRUE(same_values(layer.inner, expected.inner)) << k;
        EXPECT_EQ(layer.triangles, expected.triangles) << k;
        EXPECT_EQ(layer.stop, expected.stop) << k;
        EXPECT_EQ(found.stack.splits[k].order, file.stack.splits[k].order) << k;
        EXPECT_EQ(found.stack.splits[k].ripples, file.stack.splits[k].ripples) << k;
    }
    EXPECT_TRUE(same_values(found.tets.points, file.tets.points));
    EXPECT_EQ(found.tets.tets, file.tets.tets);
    EXPECT_EQ(found.tets.prism, file.tets.prism);
    EXPECT_EQ(found.tets.prism_layer, file.tets.prism_layer);
    EXPECT_EQ(found.tets.source_vertex, file.tets.source_vertex);
    EXPECT_EQ(found.tets.layer, file.tets.layer);
    EXPECT_EQ(found.parameters_json, file.parameters_json);
    EXPECT_EQ(found.report_json, file.report_json);
}

/// In each of the three forms the shell comes back, and gives the same bytes again.
inline void expect_round_trips(const ShellFile& file)
{
    const houdini::HoudiniGeometry geometry = houdini::shell_geometry(file);
    EXPECT_NO_THROW(houdini::require_consistent(geometry));
    for (const houdini::Format format : kFormats) {
        const std::string bytes = written(geometry, format);
        const houdini::HoudiniGeometry read = houdini::parse_geometry(bytes, "x").geometry;
        EXPECT_TRUE(same_geometry(read, geometry)) << houdini::name_of(format);
        const ShellFile back = houdini::shell_of_geometry(read, "x");
        expect_same_shell(back, file);
        EXPECT_EQ(written(houdini::shell_geometry(back), format), bytes)
            << houdini::name_of(format);
    }
}

/// The file of a shell that was built as the options say.
inline ShellFile file_of_built(const ShellOptions& options, const TriangleMesh& mesh)
{
    const ShellResult built = build_shell(mesh, options);
    return {nullptr,
            nullptr,
            built.stack,
            built.tets,
            options_json(options),
            report_json(built.report, false)};
}

/// In files of all three forms the shell comes back, and all that can be checked of it holds.
inline void expect_verified_files(const TemporaryFolder& folder, const ShellFile& file)
{
    for (const char* name : {"s.geo", "s.bgeo", "s.bgeo.sc"}) {
        houdini::write_shell_geometry(folder / name, file);
        const ShellFile read = houdini::read_shell_geometry(folder / name);
        expect_same_shell(read, file);
        const auto findings = verify_shell(read);
        EXPECT_EQ(findings.size(), 7u);
        for (const Verification& finding : findings)
            EXPECT_TRUE(finding.holds) << finding.what << ": " << finding.detail;
    }
}

} // namespace vdb_shell::test
