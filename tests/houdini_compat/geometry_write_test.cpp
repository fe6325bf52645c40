// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/houdini/geometry_file.h"

#include "vdb_shell/core/error.h"

#include "houdini_compat/geometries.h"
#include "support/files.h"

#include <gtest/gtest.h>

#include <limits>

namespace vdb_shell::houdini
{
namespace
{

using test::rich_geometry;
using test::written;

TEST(GeometryWrite, RefusesWhatCannotBeWritten)
{
    const test::TemporaryFolder folder;
    const auto refuses = [&](const HoudiniGeometry& geometry, const char* name, const char* word) {
        try {
            write_geometry(folder / name, geometry);
            ADD_FAILURE() << "was written, expected: " << word;
        } catch (const InvalidOption& error) {
            EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << error.what();
        }
        EXPECT_FALSE(std::filesystem::exists(folder / name));
    };
    refuses(rich_geometry(), "x.obj", ".bgeo.sc");
    HoudiniGeometry broken = rich_geometry();
    broken.vertex_point[3] = 7;
    refuses(broken, "x.geo", "vertex 3 is at point 7 of 7");
    broken = rich_geometry();
    broken.primitives[0].vertices = 3;
    refuses(broken, "x.geo", "primitive 0 is a tetrahedron of 3");
    broken = rich_geometry();
    std::get<std::vector<float>>(broken.point_attributes[0].values)[4] =
        std::numeric_limits<float>::infinity();
    refuses(broken, "x.bgeo", "point 1 is not finite");
    broken = rich_geometry();
    std::get<std::vector<double>>(broken.vertex_attributes[0].values)[0] =
        std::numeric_limits<double>::quiet_NaN();
    refuses(broken, "x.geo", "cannot be written as text");
    broken = rich_geometry();
    std::get<Strings>(broken.point_attributes[2].values).table[0] = "\xff";
    refuses(broken, "x.geo", "UTF-8");
    broken = rich_geometry();
    broken.point_groups.push_back({"a b", std::vector<bool>(7)});
    refuses(broken, "x.bgeo.sc", "\"a b\"");
    broken = rich_geometry();
    broken.primitive_groups.push_back(broken.primitive_groups[0]);
    refuses(broken, "x.geo", "twice");
    broken = rich_geometry();
    broken.point_attributes.erase(broken.point_attributes.begin());
    refuses(broken, "x.geo", "P of three floats");
}

TEST(GeometryWrite, WritesByExtension)
{
    const test::TemporaryFolder folder;
    for (const auto& [name, format] :
         {std::pair("a.geo", Format::text), std::pair("a.BGEO", Format::binary),
          std::pair("a.b.bgeo.sc", Format::compressed)}) {
        EXPECT_TRUE(has_geometry_extension(folder / name));
        write_geometry(folder / name, rich_geometry());
        EXPECT_EQ(test::read_bytes(folder / name), written(rich_geometry(), format));
        EXPECT_EQ(read_geometry(folder / name).format, format);
    }
    EXPECT_FALSE(has_geometry_extension("a.sc"));
    EXPECT_THROW(read_geometry(folder / "none.geo"), ReadError);
}

} // namespace
} // namespace vdb_shell::houdini
