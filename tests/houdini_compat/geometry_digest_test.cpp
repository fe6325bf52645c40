// SPDX-License-Identifier: Apache-2.0
#include "geometry_digest.h"

#include "vdb_shell/core/error.h"
#include "vdb_shell/houdini/geometry_file.h"
#include "vdb_shell/houdini/shell_geometry.h"

#include "shell_names.h"
#include "support/files.h"
#include "support/shapes.h"
#include "write/hand_made.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace vdb_shell::houdini
{
namespace
{

HoudiniGeometry small_geometry()
{
    return shell_geometry(
        test::hand_made_file(test::hand_made_shell(test::icosphere(1.0, 1), 0.6, {3}), 0.3));
}

std::string complaint(const HoudiniGeometry& geometry)
{
    try {
        require_digests(geometry, "a.geo");
    } catch (const ReadError& error) {
        return error.what();
    }
    return {};
}

void change(std::vector<std::int32_t>& values)
{
    values.back() ^= 1;
}
void change(std::vector<std::int64_t>& values)
{
    values.back() ^= 1;
}
template <typename Real> void change(std::vector<Real>& values)
{
    values.back() += Real(0.125);
}
void change(Strings& strings)
{
    strings.table.emplace_back("another");
    strings.index.back() = std::int32_t(strings.table.size()) - 1;
}

TEST(GeometryDigests, HoldInAllThreeFormsOfTheFile)
{
    const test::TemporaryFolder folder;
    for (const char* name : {"a.geo", "a.bgeo", "a.bgeo.sc"}) {
        write_geometry(folder / name, small_geometry());
        EXPECT_GT(read_shell_geometry(folder / name).digests, 25u) << name;
    }
}

TEST(GeometryDigests, NameEveryAttributeThatChanges)
{
    const HoudiniGeometry sound = small_geometry();
    EXPECT_EQ(complaint(sound), "");
    for (auto attributes :
         {&HoudiniGeometry::point_attributes, &HoudiniGeometry::primitive_attributes,
          &HoudiniGeometry::detail_attributes})
        for (std::size_t i = 0; i < (sound.*attributes).size(); ++i) {
            HoudiniGeometry changed = sound;
            Attribute& attribute = (changed.*attributes)[i];
            if (attribute.name == kDigests)
                continue;
            std::visit([](auto& values) { change(values); }, attribute.values);
            const std::string text = complaint(changed);
            EXPECT_NE(text.find(attribute.name + "\" is not what was written"), std::string::npos)
                << attribute.name << ": " << text;
        }
}

TEST(GeometryDigests, NameGroupsPrimitivesAndWhatIsMissing)
{
    const HoudiniGeometry sound = small_geometry();
    HoudiniGeometry changed = sound;
    changed.point_groups.at(0).members.flip();
    EXPECT_NE(complaint(changed).find("point_group " + changed.point_groups[0].name),
              std::string::npos);
    changed = sound;
    std::swap(changed.vertex_point.at(0), changed.vertex_point.at(1));
    EXPECT_NE(complaint(changed).find("geometry primitives"), std::string::npos);
    changed = sound;
    changed.point_attributes.pop_back();
    EXPECT_NE(complaint(changed).find("is missing"), std::string::npos);
    changed = sound;
    changed.detail_attributes.push_back({"somebody_elses", 1, "", std::vector<double>{1.0}});
    EXPECT_EQ(complaint(changed), "");
}

TEST(GeometryDigests, AreMissed)
{
    HoudiniGeometry geometry = small_geometry();
    ASSERT_EQ(geometry.detail_attributes.back().name, kDigests);
    geometry.detail_attributes.back().name[3] ^= 1; // as a flipped bit does
    EXPECT_NE(complaint(geometry).find("\"vdb_shell_digests\" is missing"), std::string::npos)
        << complaint(geometry);
}

TEST(GeometryDigests, OlderGeometryHasNone)
{
    HoudiniGeometry geometry = small_geometry();
    geometry.detail_attributes.resize(geometry.detail_attributes.size() - 2);
    EXPECT_EQ(require_digests(geometry, "a.geo"), 0u);
    EXPECT_EQ(shell_of_geometry(geometry, "a.geo").digests, 0u);
}

} // namespace
} // namespace vdb_shell::houdini
