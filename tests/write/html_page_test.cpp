// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/write/html_page.h"

#include "support/files.h"
#include "support/filled.h"
#include "support/tapered.h"
#include "vdb_shell/core/error.h"
#include "vdb_shell/layers/cut_layers.h"
#include "vdb_shell/shell/quality.h"
#include "write/hand_made.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <zlib.h>

#include <cstdint>

// Pages are taken apart here by what their own script does, written anew. That a browser shows them
// is seen by tests/external/html_page.py.

namespace vdb_shell
{
namespace
{

using openvdb::Vec3d;
using openvdb::Vec3s;

std::string from_base64(const std::string& text)
{
    static const std::string digits =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string bytes;
    std::uint32_t group = 0, bits = 0;
    for (const char c : text) {
        if (c == '=')
            break;
        group = (group << 6) | std::uint32_t(digits.find(c));
        bits += 6;
        if (bits >= 8)
            bytes += char((group >> (bits -= 8)) & 255U);
    }
    return bytes;
}

std::string inflated(std::string bytes)
{
    z_stream stream{};
    EXPECT_EQ(inflateInit2(&stream, -15), Z_OK);
    stream.next_in = reinterpret_cast<Bytef*>(bytes.data());
    stream.avail_in = uInt(bytes.size());
    std::string out(std::size_t(1) << 22, '\0');
    stream.next_out = reinterpret_cast<Bytef*>(out.data());
    stream.avail_out = uInt(out.size());
    EXPECT_EQ(inflate(&stream, Z_FINISH), Z_STREAM_END);
    out.resize(stream.total_out);
    inflateEnd(&stream);
    return out;
}

struct Block {
    nlohmann::json about;
    std::map<std::string, std::vector<std::uint32_t>> arrays;
};

Block block_of(const std::string& page, const std::string& id)
{
    const std::string open = "<script type=\"text/plain\" id=\"" + id + "\">";
    const std::size_t begin = page.find(open) + open.size();
    const std::string bytes =
        inflated(from_base64(page.substr(begin, page.find("</script>", begin) - begin)));
    const auto byte = [&](std::size_t i) { return std::uint32_t(std::uint8_t(bytes.at(i))); };
    const std::size_t length = byte(0) | byte(1) << 8 | byte(2) << 16 | byte(3) << 24;
    Block block{nlohmann::json::parse(bytes.substr(4, length)), {}};
    std::size_t at = 4 + length;
    for (const nlohmann::json& array : block.about["arrays"]) {
        const std::size_t size = array[1], count = array[2], stride = array[3];
        std::vector<std::uint32_t>& values = block.arrays[array[0]];
        for (std::size_t i = 0; i < count; ++i) {
            std::uint32_t value = i < stride ? 0 : values[i - stride];
            for (std::size_t k = 0; k < size; ++k)
                value += byte(at + k * count + i) << (8 * k);
            values.push_back(size == 4 ? value : value & ((1U << (8 * size)) - 1));
        }
        at += size * count;
    }
    EXPECT_EQ(at, bytes.size());
    return block;
}

std::string page_of(const std::vector<ShellFile>& frames,
                    std::size_t most_prisms = HtmlPage::kMostShownPrisms)
{
    const test::TemporaryFolder folder;
    HtmlPage page(most_prisms);
    for (std::size_t f = 0; f < frames.size(); ++f)
        page.add("frame " + std::to_string(f), frames[f]);
    page.write(folder / "p.html");
    return test::read_bytes(folder / "p.html");
}

Vec3d place(const Block& page, const Block& frame, std::size_t f, std::size_t point)
{
    Vec3d p;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double low = page.about["frames"][f]["low"][axis],
                     high = page.about["frames"][f]["high"][axis];
        p[int(axis)] =
            low + (high - low) * frame.arrays.at("positions")[3 * point + axis] / 65535.0;
    }
    return p;
}

ShellFile page_file_of(const ShellStack& stack)
{
    ShellFile file;
    file.stack = stack;
    file.tets = make_tets(stack);
    file.report_json = file.parameters_json = "{}";
    return file;
}

ShellFile ball()
{
    const auto made = test::hand_made_shell(test::icosphere(1.0, 2), 0.6, {3, 11});
    return page_file_of(one_layer(made.shell, made.split));
}

ShellStack three_layers()
{
    const auto made = test::hand_made_shell(test::icosphere(1.0, 1), 0.4, {5});
    LayerOptions options;
    options.layers = 3;
    return cut_layers(one_layer(made.shell, made.split), options, PrismTest::twelve_tets).stack;
}

/// Half a step of 65535 along the longest side, and what doubles lose.
double step_of(const ShellFile& file)
{
    const Bounds box = bounds_of(file.stack.surface(0));
    return 0.51 * diagonal_of(box) / 65535;
}

/// Each tet, triangle and pillar is where the shell has it.
void expect_shows(const std::string& text, const ShellFile& file, std::size_t f = 0)
{
    const Block page = block_of(text, "page"), shell = block_of(text, "shell"),
                frame = block_of(text, "frame" + std::to_string(f));
    const TetMesh tets = joined_tets(file.tets, file.core);
    const auto& corners = shell.arrays.at("tets");
    ASSERT_EQ(corners.size(), 4 * tets.tets.size());
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const Vec3d wanted(tets.points[tets.tets[i / 4][int(i % 4)]]);
        EXPECT_LT((place(page, frame, f, corners[i]) - wanted).length(), step_of(file)) << i;
    }
    const std::size_t vertices = file.stack.surface(0).size();
    const auto& surfaces = shell.arrays.at("surfaces");
    ASSERT_EQ(surfaces.size(), file.stack.surfaces() * vertices);
    for (std::size_t i = 0; i < surfaces.size(); ++i)
        EXPECT_LT((place(page, frame, f, surfaces[i]) -
                   Vec3d(file.stack.surface(i / vertices)[i % vertices]))
                      .length(),
                  step_of(file));
    for (std::size_t v = 0; v < vertices; ++v)
        EXPECT_NEAR(frame.arrays.at("thickness")[v] / 65535.0 *
                        page.about["frames"][f]["thickest"].get<double>(),
                    thickness_of(file.stack, v), 1e-4);
}

TEST(HtmlPage, HoldsTheShellToSixteenBits)
{
    expect_shows(page_of({ball()}), ball());
}

TEST(HtmlPage, HoldsLayersSharedPointsAndCores)
{
    for (const std::size_t skin : {0U, 1U, 3U}) {
        ShellFile file = page_file_of(three_layers());
        file.stack.skin = skin;
        expect_shows(page_of({file}), file);
    }
    for (const ShellStack& stack : {test::pinched_rod(), test::layers_to_a_point()})
        expect_shows(page_of({page_file_of(stack)}), page_file_of(stack));
    ShellFile filled = page_file_of(test::hollow_ball());
    filled.core = test::cone_core(filled.stack, filled.tets, Vec3s(0.01f, 0.02f, 0.03f));
    expect_shows(page_of({filled}), filled);
    EXPECT_EQ(block_of(page_of({filled}), "shell").about["core_tets"], filled.core.tets.size());
}

TEST(HtmlPage, CountsPinsStopsAndAngles)
{
    ShellFile file = ball();
    const std::size_t vertices = file.stack.surface(0).size();
    file.stack.layers[0].stop.assign(vertices, StopReason::prism);
    file.stack.layers[0].stop[3] = StopReason::pinned;
    const std::string text = page_of({file});
    const Block shell = block_of(text, "shell"), frame = block_of(text, "frame0");
    EXPECT_EQ(shell.about["pinned"], 2);
    EXPECT_EQ(shell.about["stops"][int(StopReason::prism)],
              nlohmann::json({"prism", vertices - 1}));
    EXPECT_EQ(shell.arrays.at("stop")[3], std::uint32_t(StopReason::pinned));
    std::size_t tets = 0, pillars = 0;
    for (const std::size_t count : frame.about["angles"])
        tets += count;
    for (const std::size_t count : frame.about["thickness"])
        pillars += count;
    EXPECT_EQ(tets, file.tets.tets.size());
    EXPECT_EQ(pillars, vertices);
    EXPECT_EQ(frame.about["thickness"][0], 2); // the pinned ones; the others are .4 long
    for (std::size_t t = 0; t < tets; ++t)
        EXPECT_NEAR(frame.arrays.at("angles")[t] / 255.0 * 70.5288,
                    shape_of(file.tets, t).min_dihedral_radians * 180 / M_PI, 0.14);
}

TEST(HtmlPage, NoNameIsATag)
{
    ShellFile file = ball();
    const std::string evil = "</script><script>alert(1)</script><!--";
    file.report_json = "{\"source\":\"" + evil + "\"}";
    file.parameters_json = evil + "\xff\xfe";
    HtmlPage page;
    page.add(evil + "\xff", file);
    const test::TemporaryFolder folder;
    page.write(folder / "p.html");
    const std::string text = test::read_bytes(folder / "p.html");
    EXPECT_EQ(text.find("alert(1)"), std::string::npos);
    std::size_t scripts = 0;
    for (std::size_t at = text.find("<script"); at != std::string::npos;
         at = text.find("<script", at + 1))
        ++scripts;
    EXPECT_EQ(scripts, 4U); // three of data and one that runs
    EXPECT_EQ(block_of(text, "frame0").about["report"], file.report_json);
}

TEST(HtmlPage, AsksForNothingElseAndIsSmall)
{
    const std::string text = page_of({ball()});
    std::string rest = text;
    for (const char* id : {"page", "shell", "frame0"}) {
        const std::size_t at = rest.find(std::string("id=\"") + id + "\">");
        rest.erase(at, rest.find("</script>", at) - at);
    }
    EXPECT_LE(rest.size(), 100000U);
    EXPECT_THAT(rest, testing::HasSubstr("default-src 'none'"));
    // The name of SVG's elements is no address that is asked.
    const std::string svg = "http://www.w3.org/2000/svg";
    ASSERT_NE(rest.find(svg), std::string::npos);
    rest.erase(rest.find(svg), svg.size());
    for (const char* word : {"http:", "https:", "src=", "@import", "url(", "fetch(", "XMLHttp"})
        EXPECT_EQ(rest.find(word), std::string::npos) << word;
}

TEST(HtmlPage, SameBytesAgain)
{
    EXPECT_EQ(page_of({ball(), ball()}), page_of({ball(), ball()}));
}

std::string refusal_of(HtmlPage& page, const std::string& label, const ShellFile& file)
{
    try {
        page.add(label, file);
    } catch (const Error& error) {
        return error.what();
    }
    return "";
}

TEST(HtmlPage, FramesAreOfOneShell)
{
    ShellFile moved = ball();
    for (PrismShell& layer : moved.stack.layers)
        for (std::vector<Vec3s>* points : {&layer.outer, &layer.inner})
            for (Vec3s& p : *points)
                p = Vec3s(3 * p[1] + 1, -p[0], p[2]);
    moved.tets = make_tets(moved.stack);
    const std::string text = page_of({ball(), moved});
    expect_shows(text, ball(), 0);
    expect_shows(text, moved, 1);

    HtmlPage page;
    page.add("a.vdb", ball());
    EXPECT_THAT(refusal_of(page, "b.vdb", page_file_of(three_layers())),
                testing::AllOf(testing::HasSubstr("b.vdb"), testing::HasSubstr("a.vdb")));
    EXPECT_THROW(page.add("b.vdb", page_file_of(three_layers())), GeometryError);
    EXPECT_THROW(HtmlPage().write("p.html"), InvalidOption);
    ShellFile broken = ball();
    broken.tets.tets.front()[0] = 1000000;
    EXPECT_THAT(refusal_of(page, "c.vdb", broken), testing::HasSubstr("c.vdb"));
}

TEST(HtmlPage, OfManyPrismsSomePillarsAreDrawn)
{
    const auto made = test::hand_made_shell(test::icosphere(1.0, 4), 0.5);
    const ShellFile file = page_file_of(one_layer(made.shell, made.split));
    const std::string text = page_of({file}, 1000);
    const Block page = block_of(text, "page"), shell = block_of(text, "shell"),
                frame = block_of(text, "frame0");
    EXPECT_EQ(shell.about["coarser"], true);
    EXPECT_EQ(shell.about["tets"], file.tets.tets.size());
    const auto& from = shell.arrays.at("from");
    EXPECT_LE(shell.arrays.at("triangles").size(), 3 * 1000U);
    EXPECT_GE(shell.arrays.at("triangles").size(), 3 * 900U);
    ASSERT_EQ(shell.arrays.at("surfaces").size(), 2 * from.size());
    for (std::size_t i = 0; i < 2 * from.size(); ++i)
        EXPECT_LT((place(page, frame, 0, shell.arrays.at("surfaces")[i]) -
                   Vec3d(file.stack.surface(i / from.size())[from[i % from.size()]]))
                      .length(),
                  step_of(file));
    std::size_t tets = 0;
    for (const std::size_t count : frame.about["angles"])
        tets += count;
    EXPECT_EQ(tets, file.tets.tets.size());
}

} // namespace
} // namespace vdb_shell
