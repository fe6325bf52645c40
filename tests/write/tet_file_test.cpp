// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/core/error.h"
#include "vdb_shell/write/tet_file.h"

#include "support/files.h"
#include "support/filled.h"
#include "support/shapes.h"
#include "vdb_shell/layers/cut_layers.h"
#include "write/hand_made.h"
#include "write/tet_boundary.h"

#include <gtest/gtest.h>

#include <array>
#include <clocale>
#include <cmath>
#include <cstring>
#include <locale>
#include <map>
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

TEST(TetFile, TetGenHasTheBoundaryAndWhatItsTrianglesAre)
{
    const TemporaryFolder folder;
    const TetMesh tets = awkward_tets();
    write_tets(folder / "a.ele", tets);
    std::istringstream words = after(test::read_bytes(folder / "a.face"), "# index a b c boundary");
    std::size_t count = 0, markers = 0;
    words >> count >> markers;
    const std::vector<BoundaryTriangle> boundary = boundary_of(tets);
    ASSERT_EQ(count, boundary.size());
    EXPECT_EQ(markers, 1u);
    for (std::size_t i = 0; i < count; ++i) {
        std::size_t index = 0;
        openvdb::Vec3I corners;
        int marker = 0;
        words >> index >> corners[0] >> corners[1] >> corners[2] >> marker;
        ASSERT_TRUE(bool(words));
        EXPECT_EQ(index, i);
        EXPECT_EQ(corners, boundary[i].corners);
        EXPECT_EQ(marker, int(boundary[i].boundary));
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
    words = after(text, "Triangles");
    words >> count;
    std::vector<BoundaryTriangle> triangles = boundary_of(tets);
    ASSERT_EQ(count, triangles.size());
    for (const BoundaryTriangle& triangle : triangles) {
        for (int k = 0; k < 3; ++k) {
            std::uint32_t corner = 0;
            words >> corner;
            EXPECT_EQ(corner, triangle.corners[k] + 1);
        }
        int reference = 0;
        words >> reference;
        EXPECT_EQ(reference, int(triangle.boundary));
    }
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

/// Of a .msh: by physical name how many elements its group has.
std::map<std::string, std::size_t> elements_by_name(const std::string& text)
{
    std::map<std::array<int, 2>, std::string> name_of;
    std::istringstream names = after(text, "$PhysicalNames");
    std::size_t count = 0;
    names >> count;
    for (std::size_t i = 0; i < count; ++i) {
        std::array<int, 2> group{};
        std::string name;
        names >> group[0] >> group[1] >> name;
        name_of[group] = name;
    }
    std::map<std::string, std::size_t> elements;
    std::istringstream words = after(text, "$Elements");
    std::size_t blocks = 0, all = 0, least = 0, most = 0, next = 1;
    words >> blocks >> all >> least >> most;
    for (std::size_t block = 0; block < blocks; ++block) {
        std::array<int, 2> entity{};
        int kind = 0;
        std::size_t size = 0;
        words >> entity[0] >> entity[1] >> kind >> size;
        EXPECT_EQ(kind, entity[0] == 2 ? 2 : 4) << "triangles are kind 2, tets kind 4";
        // Entities have the physical group of their number.
        elements[name_of.at(entity)] += size;
        std::string line;
        std::getline(words, line);
        for (std::size_t i = 0; i < size; ++i, ++next) {
            std::getline(words, line);
            EXPECT_EQ(line.rfind(std::to_string(next) + " ", 0), 0u) << line;
        }
    }
    EXPECT_EQ(next, all + 1);
    EXPECT_EQ(most, all);
    // Readers take the data in the order of the elements.
    std::istringstream data = after(text, "$ElementData\n1\n\"prism\"\n1\n0\n3\n0\n1");
    std::size_t values = 0;
    data >> values;
    EXPECT_EQ(values, all);
    return elements;
}

TEST(TetFile, GmshNamesWhatSolversPutConditionsOn)
{
    using Counts = std::map<std::string, std::size_t>;
    const TemporaryFolder folder;
    const auto written = [&](const TetMesh& tets) {
        write_tets(folder / "a.msh", tets);
        return elements_by_name(test::read_bytes(folder / "a.msh"));
    };
    const ShellStack ball = test::hollow_ball();
    const TetMesh shell = make_tets(ball);
    const std::size_t n = ball.triangles().size();
    EXPECT_EQ(written(shell), (Counts{{"\"shell\"", 3 * n}, {"\"outer\"", n}, {"\"inner\"", n}}));
    const CoreTets core = test::cone_core(ball, shell, {0, 0, 0});
    EXPECT_EQ(written(joined_tets(shell, core)),
              (Counts{{"\"shell\"", 3 * n}, {"\"core\"", n}, {"\"outer\"", n}, {"\"inner\"", n}}));
    LayerOptions two;
    two.layers = 2;
    EXPECT_EQ(
        written(make_tets(cut_layers(ball, two, PrismTest::twelve_tets).stack)),
        (Counts{
            {"\"layer_0\"", 3 * n}, {"\"layer_1\"", 3 * n}, {"\"outer\"", n}, {"\"inner\"", n}}));
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

TEST(TetFile, VtuHasTheMeanRatioOfEachTet)
{
    const TemporaryFolder folder;
    // Regular; the half of a cube's corner; the first one turned over.
    TetMesh tets;
    tets.points = {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1},
                   {0, 0, 0}, {1, 0, 0},   {0, 1, 0},   {0, 0, 1}};
    tets.tets = {{0, 2, 1, 3}, {4, 5, 6, 7}, {0, 1, 2, 3}};
    tets.source_vertex = {0, 1, 2, 3, 4, 5, 6, 7};
    tets.layer.assign(8, 0);
    tets.prism = {0, 1, 2};
    tets.prism_layer = {0, 0, 0};
    write_tets(folder / "a.vtu", tets);
    const auto ratio =
        values_of<float>(vtu_array(test::read_bytes(folder / "a.vtu"), "mean_ratio"));
    ASSERT_EQ(ratio.size(), 3u);
    const float sign = ratio[0] > 0 ? 1.0f : -1.0f;
    EXPECT_NEAR(sign * ratio[0], 1, 1e-6);
    EXPECT_EQ(ratio[2], -ratio[0]);
    // 12 (1/2)^(2/3) over squares of edges that sum up to 9.
    EXPECT_NEAR(ratio[1], 12 * std::cbrt(0.25) / 9, 1e-6);
}

TEST(TetFile, VtuHasThicknessAndStopReasonOfThePillarsInTheUnitOfThePoints)
{
    const TemporaryFolder folder;
    const test::HandMade made = test::hand_made_shell(test::icosphere(1, 1), 0.25, {4});
    ShellStack stack = one_layer(made.shell, made.split);
    stack.layers.back().stop[4] = StopReason::pinned;
    stack.layers.back().stop[7] = StopReason::inner_contact;
    Placement placement;
    placement.unit = 4;
    PointExtras extras;
    extras.pillars = pillar_values(stack, made.tets, made.tets.points.size());
    write_tets(folder / "a.vtu", made.tets, {}, placement, extras);
    const std::string text = test::read_bytes(folder / "a.vtu");
    const auto thickness = values_of<float>(vtu_array(text, "thickness"));
    const auto stop = values_of<std::int32_t>(vtu_array(text, "stop_reason"));
    ASSERT_EQ(thickness.size(), made.tets.points.size());
    ASSERT_EQ(stop.size(), made.tets.points.size());
    for (std::size_t p = 0; p < thickness.size(); ++p) {
        const std::uint32_t v = made.tets.source_vertex[p];
        const double length =
            (openvdb::Vec3d(stack.surface(1)[v]) - openvdb::Vec3d(stack.surface(0)[v])).length();
        EXPECT_NEAR(thickness[p], 4 * length, 1e-6);
        EXPECT_EQ(stop[p], int(stack.layers.back().stop[v]));
    }
    extras.pillars.thickness.pop_back();
    EXPECT_THROW(write_tets(folder / "b.vtu", made.tets, {}, {}, extras), InvalidOption);
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

TEST(TetFile, TetGenFilesAreWrittenAllOrNone)
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
    EXPECT_FALSE(fs::exists(folder / "a.face"));
}

} // namespace
} // namespace vdb_shell
