// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/houdini/geometry_file.h"

#include "vdb_shell/core/error.h"

#include "houdini_compat/geometries.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace vdb_shell::houdini
{
namespace
{

using test::kFormats;
using test::rich_geometry;
using test::same_geometry;
using test::written;
using namespace std::string_literals;

/// Reading `bytes` fails with a message that names the file and has every one of `words`.
void expect_refusal(const std::string& bytes, const std::vector<std::string>& words)
{
    try {
        parse_geometry(bytes, "some.geo");
        ADD_FAILURE() << "was read, expected: " << words.at(0);
    } catch (const ReadError& error) {
        const std::string message = error.what();
        EXPECT_EQ(message.rfind("some.geo", 0), 0u) << message;
        for (const std::string& word : words)
            EXPECT_NE(message.find(word), std::string::npos) << '"' << word << "\": " << message;
    }
}

std::string replaced(std::string text, const std::string& from, const std::string& to)
{
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

TEST(GeometryFile, EveryFormGivesTheSameGeometryBackBitForBit)
{
    const HoudiniGeometry geometry = rich_geometry();
    for (const Format format : kFormats) {
        const std::string bytes = written(geometry, format);
        const ReadGeometry read = parse_geometry(bytes, "some.geo");
        EXPECT_EQ(read.format, format);
        EXPECT_TRUE(same_geometry(read.geometry, geometry)) << name_of(format);
        EXPECT_TRUE(read.geometry.unread.empty());
        EXPECT_EQ(written(read.geometry, format), bytes) << name_of(format);
    }
}

TEST(GeometryFile, EmptyGeometryToo)
{
    HoudiniGeometry geometry;
    geometry.point_attributes = {{"P", 3, "point", std::vector<float>{}}};
    for (const Format format : kFormats)
        EXPECT_TRUE(
            same_geometry(parse_geometry(written(geometry, format), "some.geo").geometry, geometry))
            << name_of(format);
}

TEST(GeometryFile, MoreThanOneChunkAndPage)
{
    HoudiniGeometry geometry;
    geometry.points = 200000;
    std::vector<float> p;
    for (std::size_t i = 0; i < 3 * geometry.points; ++i)
        p.push_back(1.0f / static_cast<float>(i + 1));
    geometry.point_attributes = {{"P", 3, "point", p}};
    const std::string bytes = written(geometry, Format::compressed);
    // 2.4 MB in chunks of 1 MiB are three chunks: two starts, two sizes.
    EXPECT_EQ(static_cast<unsigned char>(bytes[bytes.size() - 5]), 4 * 8);
    EXPECT_TRUE(same_geometry(parse_geometry(bytes, "some.geo").geometry, geometry));
}

TEST(GeometryFile, TextIsTheDocumentThatHoudiniWrites)
{
    const auto list = nlohmann::json::parse(written(rich_geometry(), Format::text));
    nlohmann::json document;
    for (std::size_t i = 0; i < list.size(); i += 2)
        document[list[i].get<std::string>()] = list[i + 1];
    EXPECT_EQ(document["pointcount"], 7);
    EXPECT_EQ(document["vertexcount"], 11);
    EXPECT_EQ(document["primitivecount"], 3);
    EXPECT_EQ(document["hasindex"], false);
    EXPECT_EQ(document["topology"][1][1].size(), 11u);
    EXPECT_EQ(document["primitives"], nlohmann::json::parse(R"([
        [["type","Tetrahedron_run"],["startvertex",0,"nprimitives",1]],
        [["type","Polygon_run"],["startvertex",4,"nprimitives",2,"nvertices_rle",[3,1,4,1]]]])"));
    EXPECT_EQ(
        document["primitivegroups"][1],
        nlohmann::json::parse(R"([["name","tet"],["selection",["unordered",["i8",[1,0,0]]]]])"));
    const auto& p = document["attributes"][3][0];
    EXPECT_EQ(p[0], nlohmann::json::parse(R"(["scope","public","type","numeric","name","P",
        "options",{"type":{"type":"string","value":"point"}}])"));
    EXPECT_EQ(p[1][3], "fpreal32");
}

/// A document of one list, told in bytes.
std::string binary(const std::string& body)
{
    return "\x7fNSJb"s + "[" + body + "]";
}

std::string token(char id, const std::string& text)
{
    return "+"s + id + static_cast<char>(text.size()) + text + "&" + id;
}

/// Everything before "attributes" for three points and one triangle.
std::string binary_head()
{
    return token(1, "fileversion") + token(2, "18.0") + token(3, "pointcount") + "\x11\x03"s +
           token(4, "vertexcount") + "\x12\x03\x00"s + token(5, "primitivecount") +
           "\x13\x01\x00\x00\x00"s + token(6, "topology") + "[" + token(7, "pointref") + "[" +
           token(8, "indices") + "@\x21\x03\x02\x00\x01"s + "]]" + token(9, "primitives") + "[[[" +
           token(10, "type") + token(11, "p_r") + "][" + token(12, "s_v") + "\x11\x00"s +
           token(14, "n_p") + "\x11\x01"s + token(15, "n_v") + "[\x22\x03\x00]]]]"s;
}

/// P with three components whose values are `stored`.
std::string binary_positions(const std::string& storage, const std::string& stored)
{
    const auto text = [](const std::string& t) { return "'"s + static_cast<char>(t.size()) + t; };
    return text("attributes") + "[" + text("pointattributes") + "[[[" + text("type") +
           text("numeric") + text("name") + text("P") + "][" + text("size") + "\x11\x03"s +
           text("storage") + text(storage) + text("values") + "[" + text("size") + "\x14\x03"s +
           std::string(7, '\0') + text("storage") + text(storage) + stored + "]]]]]";
}

std::string paged(const std::string& array)
{
    return "'\x08pagesize\x12\x00\x04'\x0brawpagedata"s + array;
}

TEST(GeometryFile, BinaryKindsAreThoseOfTheTable)
{
    const std::vector<float> expected{0, 1, 2, -0.5f, 4, 5, 6, 7, 8};
    const std::string halves =
        "@\x18\x09"
        "\x00\x00\x00\x3c\x00\x40\x00\xb8\x00\x44\x00\x45\x00\x46\x00\x47\x00\x48"s;
    std::string doubles = "@\x1a\xf2\x09\x00"s, singles = "@\x19\xf4\x09\x00\x00\x00"s;
    for (const float value : expected) {
        const double wide = static_cast<double>(value);
        doubles.append(reinterpret_cast<const char*>(&wide), sizeof wide);
        singles.append(reinterpret_cast<const char*>(&value), sizeof value);
    }
    for (const auto& [storage, array] :
         {std::pair("fpreal16"s, halves), std::pair("fpreal32"s, doubles),
          std::pair("fpreal32"s, singles)}) {
        const ReadGeometry read =
            parse_geometry(binary(binary_head() + binary_positions(storage, paged(array))), "x");
        EXPECT_EQ(read.geometry.vertex_point, (std::vector<std::uint32_t>{2, 0, 1}));
        EXPECT_EQ(std::get<std::vector<float>>(read.geometry.point_attributes.at(0).values),
                  expected);
    }
}

TEST(GeometryFile, ReadsTheOtherByteOrder)
{
    std::string array = "@\x19\x09"s;
    for (int i = 0; i < 9; ++i)
        array += "\x3f\x80\x00\x00"s;
    std::string bytes = binary(binary_head() + binary_positions("fpreal32", paged(array)));
    bytes.replace(0, 5,
                  "\x7f"
                  "bJSN");
    bytes = replaced(bytes, "\x12\x03\x00"s, "\x12\x00\x03"s);
    bytes = replaced(bytes, "\x13\x01\x00\x00\x00"s, "\x13\x00\x00\x00\x01"s);
    bytes = replaced(bytes, "\x22\x03\x00"s, "\x22\x00\x03"s);
    bytes = replaced(bytes, "\x14\x03"s + std::string(7, '\0'),
                     "\x14"s + std::string(7, '\0') + "\x03");
    bytes = replaced(bytes, "\x12\x00\x04"s, "\x12\x04\x00"s);
    const HoudiniGeometry read = parse_geometry(bytes, "some.geo").geometry;
    EXPECT_EQ(std::get<std::vector<float>>(read.point_attributes.at(0).values),
              std::vector<float>(9, 1.0f));
}

const char* const kTriangle =
    R"(["fileversion","18","pointcount",3,"vertexcount",3,"primitivecount",1,
"topology",["pointref",["indices",[2,1,0]]],
"attributes",["pointattributes",[[["scope","public","type","numeric","name","P","options",{}],
["size",4,"storage","fpreal32","values",["size",4,"storage","fpreal32",
"pagesize",2,"packing",[3,1],"constantpageflags",[[false,true],[true,true]],
"rawpagedata",[0,1,2,3,4,5,1, 6,7,8,1]]]]]],
"primitives",[[["type","Poly"],["vertex",[2,0,1],"closed",true]]]])";

TEST(GeometryFile, ConstantPagesArePackedApart)
{
    const HoudiniGeometry read = parse_geometry(kTriangle, "some.geo").geometry;
    EXPECT_EQ(std::get<std::vector<float>>(read.point_attributes.at(0).values),
              (std::vector<float>{0, 1, 2, 1, 3, 4, 5, 1, 6, 7, 8, 1}));
    // Vertices are numbered in the order of their primitives.
    EXPECT_EQ(read.vertex_point, (std::vector<std::uint32_t>{0, 2, 1}));
}

TEST(GeometryFile, NamesWhatItHasNoPlaceFor)
{
    const std::string extra = replaced(
        kTriangle, "\"attributes\",[",
        R"("edgegroups",[],"attributes",["globalattributes",[[["type","dict","name","d"],[]]],)");
    const HoudiniGeometry read = parse_geometry(extra, "some.geo").geometry;
    EXPECT_EQ(read.unread, (std::vector<std::string>{"detail attribute \"d\" of type \"dict\"",
                                                     "\"edgegroups\""}));
}

TEST(GeometryFile, SaysWhatIsWrong)
{
    const struct {
        const char *from, *to;
        std::vector<std::string> words;
    } kCases[] = {
        {"\"pointcount\",3", "\"pointcount\",2", {"vertex 0", "point 2 of 2"}},
        {"\"pointcount\",3", "\"pointcount\",-1", {"pointcount", "-1", "[0, "}},
        {"\"pointcount\",3", "\"pointcount\",4000000000", {"pointcount", "4000000000", "[0, "}},
        {"\"pointcount\",3", "\"pointcount\",\"3\"", {"pointcount", "\"3\"", "whole number"}},
        {"\"pointcount\",3", "\"pointcount\",3,\"pointcount\",3", {"pointcount", "twice"}},
        {"\"pointcount\",3", "\"points\",3", {"\"pointcount\" is missing"}},
        {"\"vertexcount\",3", "\"vertexcount\",4", {"topology", "3 entries", "4 vertices"}},
        {"\"primitivecount\",1", "\"primitivecount\",2", {"1 primitives", "declares 2"}},
        {"\"primitivecount\",1", "\"primitivecount\",0", {"more primitives than the 0"}},
        {"[2,0,1]", "[2,0,0]", {"primitive 0", "vertex 0", "earlier"}},
        {"[2,0,1]", "[2,0,3]", {"primitive 0", "vertex 3 of 3"}},
        {"[2,0,1]", "[2,0]", {"vertex 1 belongs to no primitive"}},
        {"[2,0,1]", "[]", {"primitive 0", "polygon of 0 vertices"}},
        {"\"closed\",true", "\"closed\",false", {"primitive 0", "open polygon"}},
        {"\"Poly\"", "\"Sphere\"", {"primitive 0", "\"Sphere\"", "closed polygons"}},
        {"\"Poly\"", "\"Tetrahedron\"", {"primitive 0", "tetrahedron of 3"}},
        {"[3,1]", "[3,2]", {"point attribute \"P\"", "packing", "2", "tuples of 4"}},
        {"[3,1]", "[3]", {"point attribute \"P\"", "packing", "3"}},
        {"[true,true]", "[true]", {"constantpageflags", "1 flags for 2 pages"}},
        {"8,1]]", "8]]", {"rawpagedata", "10 numbers where 11"}},
        {"\"pagesize\",2", "\"pagesize\",0", {"pagesize", "0"}},
        {"\"values\",[\"size\",4", "\"values\",[\"size\",3", {"size", "3", "4"}},
        {"\"fpreal32\",\"values\"", "\"fpreal31\",\"values\"", {"storage", "fpreal31"}},
        {"[0,1,2,3", "[0,1,1e39,3", {"point attribute \"P\"", "value 2", "beyond its storage"}},
        {"]]]])", "", {"line 7", "column"}},
        {"[0,1,2,3", "[0,,2,3", {"line 6", "column 18"}},
    };
    for (const auto& one : kCases) {
        if (std::string(one.from) == "]]]])") {
            const std::string text = kTriangle;
            expect_refusal(text.substr(0, text.size() - 4), one.words);
            continue;
        }
        expect_refusal(replaced(kTriangle, one.from, one.to), one.words);
    }
}

TEST(GeometryFile, SaysWhatOtherFilesAre)
{
    expect_refusal("PGEOMETRY V5\nNPoints 8", {"before version 12"});
    expect_refusal("1oeg_bdv\x01\x02", {"vdb_tool"});
    expect_refusal("# OBJ", {"no Houdini geometry", "# OBJ"});
    expect_refusal("", {"no Houdini geometry"});
}

TEST(GeometryFile, EveryCutIsNoticed)
{
    for (const Format format : kFormats) {
        std::string whole = written(rich_geometry(), format);
        if (format == Format::text)
            whole.pop_back(); // the last line's end
        for (std::size_t size = 0; size < whole.size(); ++size)
            EXPECT_THROW(parse_geometry(whole.substr(0, size), "some.geo"), ReadError)
                << name_of(format) << " cut after " << size << " of " << whole.size();
        if (format != Format::text)
            expect_refusal(whole + '\0', {"some.geo"});
    }
}

TEST(GeometryFile, CountsAreHeldAgainstTheBytes)
{
    // Lengths that nothing follows.
    expect_refusal("\x7fNSJb[@\x13\xf8\xff\xff\xff\xff\xff\xff\xff\x7f"s,
                   {"byte", "9223372036854775807 elements of 4 bytes", "only 0 bytes are left"});
    expect_refusal("\x7fNSJb['\xf4\xff\xff\xff\xff"s,
                   {"a string of 4294967295", "0 bytes are left"});
    expect_refusal("\x7fNSJb[@\x10\xf8\xff\xff\xff\xff\xff\xff\xff\xff"s,
                   {"an array", "0 bytes are left"});
    expect_refusal("\x7fNSJb[&\x05"s, {"byte 8", "token 5 is not defined"});
    expect_refusal("\x7fNSJb[\x99"s, {"byte 6", "kind 153"});
    expect_refusal("\x7fNSJb[}"s, {"end of a map"});
    for (const char open : {'[', '{'})
        expect_refusal("\x7fNSJb"s + std::string(100, open), {"more than 64 deep"});
    expect_refusal(std::string(100000, '['), {"more than 64 deep"});
    expect_refusal("[18446744073709551615]", {"18446744073709551615", "64 signed bits"});
}

TEST(GeometryFile, WhatIsSpeltOutIsBoundByTheFilesSize)
{
    // Groups of all of many points, each told in a few bytes.
    const std::size_t points = 100000;
    std::string text =
        R"(["fileversion","18","pointcount",100000,"vertexcount",0,"primitivecount",0,
        "topology",["pointref",["indices",[]]],"primitives",[],"pointgroups",[)";
    for (int i = 0; i < 4000; ++i)
        text += (i ? ",[[\"name\",\"g" : "[[\"name\",\"g") + std::to_string(i) +
                "\"],[\"selection\",[\"unordered\",[\"boolRLE\",[" + std::to_string(points) +
                ",true]]]]]";
    expect_refusal(text + "]]", {"point group", "bytes to spell out"});

    std::string pages = R"(["fileversion","18","pointcount",1000,"vertexcount",0,"primitivecount",0,
        "topology",["pointref",["indices",[]]],"primitives",[],"attributes",["pointattributes",[)";
    for (int i = 0; i < 40; ++i)
        pages += (i ? std::string(",") : std::string()) + "[[\"type\",\"numeric\",\"name\",\"a" +
                 std::to_string(i) +
                 "\"],[\"size\",9999,\"storage\",\"fpreal64\",\"values\",[\"size\",9999,"
                 "\"pagesize\",9999,\"packing\",[" +
                 [] {
                     std::string ones = "1";
                     for (int k = 1; k < 9999; ++k)
                         ones += ",1";
                     return ones;
                 }() +
                 "],\"rawpagedata\",[1]]]]";
    expect_refusal(pages + "]]]", {"point attribute \"a0\"", "bytes to spell out"});
}

TEST(GeometryFile, LongTokensAreNotCopiedWithoutLimit)
{
    // The same text of 100,000 bytes as the meaning of 100 attributes: 10 MB of a file of some 100
    // kB.
    std::string body = "'\x0apointcount\x11\x00'\x0bvertexcount\x11\x00'\x0eprimitivecount\x11\x00"
                       "'\x08topology['\x08pointref['\x07indices[]]]'\x0aprimitives[]"
                       "+\x01\xf4\xa0\x86\x01\x00"s +
                       std::string(100000, 'x') +
                       "'\x0a"
                       "attributes['\x0fpointattributes["s;
    for (char i = 0; i < 100; ++i)
        body += "[['\x04type'\x07numeric'\x04name'\x02"s + static_cast<char>('a' + i / 10) +
                static_cast<char>('a' + i % 10) +
                "'\x07options{'\x04type{'\x05value&\x01}}]['\x04size\x11\x01'\x07storage'\x05int32"
                "'\x06values['\x04size\x11\x01'\x06"
                "arrays[]]]]"s;
    expect_refusal(binary(body + "]]"), {"point attribute \"", "bytes to spell out"});
    expect_refusal(binary("'\xf2\xd0\x07"s + std::string(2000, 'k') + "\x11\x01"),
                   {"a key of 2000 bytes"});
}

TEST(GeometryFile, DamagedContainersAreRefused)
{
    const std::string whole = written(rich_geometry(), Format::compressed);
    const std::size_t size = whole.size();
    const auto with = [&](std::size_t at, const std::string& bytes) {
        return std::string(whole).replace(at, bytes.size(), bytes);
    };
    expect_refusal(with(size - 4, "1fcS"), {"1fcs", "cut short"});
    expect_refusal(with(size - 12, "\x7f"), {"an index of", "do not fit"});
    expect_refusal(with(4, "\x7f"), {"a preamble of", "do not fit"});
    expect_refusal(with(size - 20, std::string(7, '\0') + "\x01"), {"chunk 0", "the index says 1"});
    expect_refusal(with(12 + 12, "\x01"), {"chunk 0", "no Blosc data"});
}

} // namespace
} // namespace vdb_shell::houdini
