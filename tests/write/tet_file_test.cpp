// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/core/error.h"
#include "vdb_shell/write/tet_file.h"

#include "support/files.h"
#include "support/shapes.h"
#include "write/hand_made.h"

#include <gtest/gtest.h>

#include <clocale>
#include <cstring>
#include <locale>
#include <sstream>

namespace vdb_shell
{
namespace
{

namespace fs = std::filesystem;
using openvdb::Vec3s;
using test::same_bits;
using test::TemporaryFolder;

/// A shell with coordinates that short decimals cannot hold.
TetMesh awkward_tets()
{
    TetMesh tets = test::hand_made_shell(test::icosphere(0.1, 1), 1.0 / 3.0, {4}).tets;
    tets.points[0] = {1e-42f, -3.4e38f, -0.0f};
    tets.points[1] = {0.1f, 16777217.0f, 1.0f / 3.0f};
    return tets;
}

/// Words of the text after the line `title`.
std::istringstream after(const std::string& text, const std::string& title)
{
    const std::size_t at = text.find(title + "\n");
    EXPECT_NE(at, std::string::npos) << title;
    std::istringstream words(text.substr(at + title.size() + 1));
    words.imbue(std::locale::classic());
    return words;
}

/// Three numbers as a program reads doubles; each must be a float32 exactly.
Vec3s exact_point(std::istream& words)
{
    Vec3s point;
    for (int axis = 0; axis < 3; ++axis) {
        std::string word;
        words >> word;
        const double value = std::strtod(word.c_str(), nullptr);
        point[axis] = float(value);
        EXPECT_EQ(double(point[axis]), value) << word;
        EXPECT_EQ(std::strtof(word.c_str(), nullptr), point[axis]) << word;
    }
    return point;
}

std::vector<openvdb::Vec4I> tets_from(std::istream& words, std::size_t count, std::uint32_t base,
                                      int before, int behind)
{
    std::vector<openvdb::Vec4I> tets(count);
    std::string ignored;
    for (openvdb::Vec4I& tet : tets) {
        for (int i = 0; i < before; ++i)
            words >> ignored;
        for (int corner = 0; corner < 4; ++corner) {
            words >> tet[corner];
            tet[corner] -= base;
        }
        for (int i = 0; i < behind; ++i)
            words >> ignored;
    }
    EXPECT_TRUE(bool(words));
    return tets;
}

TEST(TetFile, TetGenHoldsTheExactNumbers)
{
    const TemporaryFolder folder;
    const TetMesh tets = awkward_tets();
    for (const char* name : {"a.node", "b.ele"}) {
        write_tets(folder / name, tets);
        const fs::path node = (folder / name).replace_extension(".node");
        const fs::path ele = (folder / name).replace_extension(".ele");
        std::istringstream nodes =
            after(test::read_bytes(node), "# index x y z source_vertex layer");
        std::size_t count = 0, dimension = 0, attributes = 0, markers = 0;
        nodes >> count >> dimension >> attributes >> markers;
        EXPECT_EQ(count, tets.points.size());
        EXPECT_EQ(dimension, 3u);
        EXPECT_EQ(attributes, 2u);
        std::vector<Vec3s> points;
        for (std::size_t i = 0; i < count; ++i) {
            std::size_t index = 0, vertex = 0, layer = 0;
            nodes >> index;
            points.push_back(exact_point(nodes));
            nodes >> vertex >> layer;
            ASSERT_EQ(index, i);
            EXPECT_EQ(vertex, tets.source_vertex[i]);
            EXPECT_EQ(layer, tets.layer[i]);
        }
        EXPECT_TRUE(same_bits(points, tets.points));
        std::istringstream words = after(test::read_bytes(ele), "# index a b c d prism");
        words >> count >> dimension >> attributes;
        EXPECT_EQ(count, tets.tets.size());
        EXPECT_TRUE(same_bits(tets_from(words, count, 0, 1, 1), tets.tets));
    }
}

TEST(TetFile, MeditHoldsTheExactNumbers)
{
    const TemporaryFolder folder;
    const TetMesh tets = awkward_tets();
    write_tets(folder / "a.mesh", tets);
    const std::string text = test::read_bytes(folder / "a.mesh");
    std::istringstream words = after(text, "Vertices");
    std::size_t count = 0;
    words >> count;
    ASSERT_EQ(count, tets.points.size());
    std::vector<Vec3s> points;
    for (std::size_t i = 0; i < count; ++i) {
        points.push_back(exact_point(words));
        int layer = -1;
        words >> layer;
        EXPECT_EQ(layer, tets.layer[i]);
    }
    EXPECT_TRUE(same_bits(points, tets.points));
    words = after(text, "Tetrahedra");
    words >> count;
    ASSERT_EQ(count, tets.tets.size());
    EXPECT_TRUE(same_bits(tets_from(words, count, 1, 0, 1), tets.tets));
}

TEST(TetFile, GmshHoldsTheExactNumbers)
{
    const TemporaryFolder folder;
    const TetMesh tets = awkward_tets();
    write_tets(folder / "a.msh", tets);
    const std::string text = test::read_bytes(folder / "a.msh");
    EXPECT_EQ(text.rfind("$MeshFormat\n4.1 0 8\n$EndMeshFormat\n", 0), 0u);
    std::istringstream words = after(text, "$Nodes");
    std::string ignored;
    for (int i = 0; i < 8; ++i)
        words >> ignored;
    for (std::size_t i = 0; i < tets.points.size(); ++i) {
        std::size_t tag = 0;
        words >> tag;
        ASSERT_EQ(tag, i + 1);
    }
    std::vector<Vec3s> points;
    for (std::size_t i = 0; i < tets.points.size(); ++i)
        points.push_back(exact_point(words));
    EXPECT_TRUE(same_bits(points, tets.points));
    words = after(text, "$Elements");
    for (int i = 0; i < 8; ++i)
        words >> ignored;
    EXPECT_TRUE(same_bits(tets_from(words, tets.tets.size(), 1, 1, 0), tets.tets));
}

/// The bytes of a base-64 array of the .vtu, without its length.
std::string vtu_array(const std::string& text, const std::string& name)
{
    const std::size_t header = text.find("Name=\"" + name + "\"");
    EXPECT_NE(header, std::string::npos) << name;
    const std::size_t begin = text.find('\n', header) + 1;
    const std::string digits = text.substr(begin, text.find('\n', begin) - begin);
    const std::string alphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const auto decode = [&](const std::string& part) {
        std::string bytes;
        for (std::size_t i = 0; i + 3 < part.size(); i += 4) {
            std::uint32_t group = 0;
            int padding = 0;
            for (std::size_t j = 0; j < 4; ++j) {
                padding += part[i + j] == '=';
                group = group * 64 +
                        (part[i + j] == '=' ? 0u : std::uint32_t(alphabet.find(part[i + j])));
            }
            for (int j = 0; j < 3 - padding; ++j)
                bytes += char((group >> (16 - 8 * j)) & 255u);
        }
        return bytes;
    };
    constexpr std::size_t kLengthDigits = 12; // eight bytes
    const std::string length = decode(digits.substr(0, kLengthDigits));
    const std::string bytes = decode(digits.substr(kLengthDigits));
    std::uint64_t stated = 0;
    std::memcpy(&stated, length.data(), sizeof stated);
    EXPECT_EQ(stated, bytes.size()) << name;
    return bytes;
}

template <typename T> std::vector<T> values_of(const std::string& bytes)
{
    std::vector<T> values(bytes.size() / sizeof(T));
    std::memcpy(values.data(), bytes.data(), bytes.size());
    return values;
}

TEST(TetFile, VtuHoldsTheVeryBytes)
{
    const TemporaryFolder folder;
    const TetMesh tets = awkward_tets();
    write_tets(folder / "a.vtu", tets);
    const std::string text = test::read_bytes(folder / "a.vtu");
    EXPECT_TRUE(same_bits(values_of<Vec3s>(vtu_array(text, "Points")), tets.points));
    EXPECT_TRUE(
        same_bits(values_of<std::uint32_t>(vtu_array(text, "source_vertex")), tets.source_vertex));
    EXPECT_TRUE(same_bits(values_of<std::uint8_t>(vtu_array(text, "layer")), tets.layer));
    EXPECT_TRUE(same_bits(values_of<std::uint32_t>(vtu_array(text, "prism")), tets.prism));
    const auto corners = values_of<std::int64_t>(vtu_array(text, "connectivity"));
    ASSERT_EQ(corners.size(), 4 * tets.tets.size());
    for (std::size_t i = 0; i < corners.size(); ++i)
        EXPECT_EQ(corners[i], tets.tets[i / 4][int(i % 4)]);
    const auto types = values_of<std::uint8_t>(vtu_array(text, "types"));
    EXPECT_EQ(types, std::vector<std::uint8_t>(tets.tets.size(), 10));
}

TEST(TetFile, VtuHoldsTheFlagsOfCertifiedTets)
{
    const TemporaryFolder folder;
    const TetMesh tets = test::hand_made_shell(test::icosphere(0.1, 1), 0.5).tets;
    std::vector<std::uint8_t> certified(tets.tets.size(), 1);
    certified[5] = certified[17] = 0;
    write_tets(folder / "a.vtu", tets, certified);
    const std::string text = test::read_bytes(folder / "a.vtu");
    EXPECT_EQ(values_of<std::uint8_t>(vtu_array(text, "certified")), certified);
    certified.pop_back();
    EXPECT_THROW(write_tets(folder / "a.vtu", tets, certified), InvalidOption);
}

TEST(TetFile, VtuHasPlacesAtRestAndVelocitiesInTheCoordinatesOfThePoints)
{
    const TemporaryFolder folder;
    const TetMesh tets = test::hand_made_shell(test::icosphere(0.1, 1), 0.5).tets;
    Placement placement;
    placement.origin = {1000, -2000, 0.1};
    placement.unit = 4;
    PointExtras extras;
    extras.rest = tets.points;
    extras.velocity.assign(tets.points.size(), Vec3s(1, 0.5f, -2));
    write_tets(folder / "a.vtu", tets, {}, placement, extras);
    const std::string text = test::read_bytes(folder / "a.vtu");
    // The pose is that at rest.
    const auto points = values_of<openvdb::Vec3d>(vtu_array(text, "Points"));
    ASSERT_EQ(points.size(), tets.points.size());
    EXPECT_EQ(points[3], placement.in_file(tets.points[3]));
    EXPECT_EQ(values_of<openvdb::Vec3d>(vtu_array(text, "rest")), points);
    for (const Vec3s& v : values_of<Vec3s>(vtu_array(text, "v")))
        EXPECT_EQ(v, Vec3s(4, 2, -8));
}

/// Numbers as in German: a decimal comma and grouped thousands.
struct German : std::numpunct<char> {
    char do_decimal_point() const override { return ','; }
    char do_thousands_sep() const override { return '.'; }
    std::string do_grouping() const override { return "\3"; }
};

TEST(TetFile, SameBytesInAnyLocale)
{
    const TemporaryFolder folder;
    const TetMesh tets = test::hand_made_shell(test::icosphere(0.1, 4), 0.5).tets;
    for (const std::string& extension : tet_file_extensions()) {
        write_tets(folder / ("a" + extension), tets);
        const std::locale before =
            std::locale::global(std::locale(std::locale::classic(), new German));
        write_tets(folder / ("b" + extension), tets);
        std::locale::global(before);
        EXPECT_EQ(test::read_bytes(folder / ("a" + extension)),
                  test::read_bytes(folder / ("b" + extension)))
            << extension;
    }
}

TEST(TetFile, WritesAnEmptyMesh)
{
    const TemporaryFolder folder;
    for (const std::string& extension : tet_file_extensions()) {
        write_tets(folder / ("a" + extension), TetMesh{});
        EXPECT_GT(fs::file_size(folder / ("a" + extension)), 0u) << extension;
    }
}

TEST(TetFile, RefusesUnknownExtensionsAndMissingFolders)
{
    const TemporaryFolder folder;
    try {
        write_tets(folder / "a.obj", TetMesh{});
        FAIL();
    } catch (const InvalidOption& error) {
        EXPECT_NE(std::string(error.what()).find(".obj"), std::string::npos);
        EXPECT_NE(std::string(error.what()).find(".msh"), std::string::npos);
    }
    for (const std::string& extension : tet_file_extensions())
        EXPECT_THROW(write_tets(folder / ("none/a" + extension), TetMesh{}), WriteError);
    EXPECT_TRUE(fs::is_empty(folder.path()));
}

TEST(TetFile, TetGenFilesAreWrittenBothOrNone)
{
    const TemporaryFolder folder;
    test::write_bytes(folder / "a.ele", "old");
    fs::create_directory(folder / "a.node");
    EXPECT_THROW(write_tets(folder / "a.ele", awkward_tets()), WriteError);
    EXPECT_EQ(test::read_bytes(folder / "a.ele"), "old");
    fs::remove(folder / "a.node");
    fs::remove(folder / "a.ele");
    fs::create_directory(folder / "a.ele");
    EXPECT_THROW(write_tets(folder / "a.node", awkward_tets()), WriteError);
    EXPECT_FALSE(fs::exists(folder / "a.node"));
}

} // namespace
} // namespace vdb_shell
