// SPDX-License-Identifier: Apache-2.0
#include "houdini_compat/fuzz.h"

#include "vdb_shell/core/error.h"
#include "vdb_shell/houdini/polygon_mesh.h"
#include "vdb_shell/houdini/shell_geometry.h"

#include "houdini_compat/geometries.h"
#include "scf.h"
#include "support/shapes.h"

#include <malloc.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <new>
#include <random>

namespace
{

std::atomic<std::int64_t> allocated{0}, most_allocated{0};

void* counted(std::size_t size)
{
    void* const memory = std::malloc(size ? size : 1);
    if (!memory)
        throw std::bad_alloc();
    const auto now = allocated += static_cast<std::int64_t>(malloc_usable_size(memory));
    if (now > most_allocated)
        most_allocated = now;
    return memory;
}

void uncounted(void* memory) noexcept
{
    if (memory)
        allocated -= static_cast<std::int64_t>(malloc_usable_size(memory));
    std::free(memory);
}

} // namespace

// What one input makes the readers take is part of what is tested.
void* operator new(std::size_t size)
{
    return counted(size);
}
void* operator new[](std::size_t size)
{
    return counted(size);
}
void operator delete(void* memory) noexcept
{
    uncounted(memory);
}
void operator delete[](void* memory) noexcept
{
    uncounted(memory);
}
void operator delete(void* memory, std::size_t) noexcept
{
    uncounted(memory);
}
void operator delete[](void* memory, std::size_t) noexcept
{
    uncounted(memory);
}

namespace vdb_shell::test
{
namespace
{

using houdini::Format;
using houdini::HoudiniGeometry;
using Random = std::mt19937_64;

std::size_t below(Random& random, std::size_t limit)
{
    return limit ? static_cast<std::size_t>(random() % limit) : 0;
}

std::string compressed(const std::string& bytes)
{
    std::string result;
    houdini::ScfWriter writer(
        [&result](const char* data, std::size_t size) { result.append(data, size); });
    writer.write(bytes.data(), bytes.size());
    writer.finish();
    return result;
}

/// Forms that other programs write and this one does not.
const char* const kOthersText =
    R"(["fileversion","13.0","hasindex",false,"pointcount",5,"vertexcount",11,"primitivecount",3,
"info",{"bounds":[0,1,0,1,0,1],"time":1e-3},"topology",["pointref",["indices",[0,1,2,3,2,1,0,4,1,3,4]]],
"attributes",["pointattributes",[[["scope","public","type","numeric","name","P","options",{"type":{"type":"string","value":"hpoint"}}],
["size",4,"storage","fpreal32","defaults",["size",4,"storage","fpreal64","values",[0,0,0,1]],"values",["size",4,"storage","fpreal32",
"pagesize",2,"packing",[3,1],"constantpageflags",[[false,true,false],[true,true,true]],"rawpagedata",[0,0,0,1,0,0,1,0,1,0,1,0,0,1,1]]]]]],
"primitives",[[["type","run","runtype","Poly","varyingfields",["vertex"],"uniformfields",{"closed":true}],[[[0,1,2,3]]]],
[["type","Poly"],["vertex",[6,5,4],"closed",true]],[["type","Tetrahedron"],["vertex",[7,8,9,10]]]],
"pointgroups",[[["name","g","type","point"],["selection",["defaults",["size",1,"storage","int64","values",[0]],"unordered",["i8",[0,1,0,1,1]]]]]]])";

std::vector<std::string> seeds(Format format)
{
    const auto shell = houdini::shell_geometry(scaled_shell_file(unit_tetrahedron(), 0.5f, {2}));
    const auto layers = houdini::shell_geometry(
        layered_shell_file(unit_tetrahedron(), {2.0f, 1.5f, 1.0f, 0.5f}, 1, {1, 2, 3}, 1));
    HoudiniGeometry surface;
    const TriangleMesh cube = box({0, 0, 0}, {1, 1, 1});
    surface.points = cube.points.size();
    std::vector<float> p;
    for (const openvdb::Vec3s& point : cube.points)
        p.insert(p.end(), {point[0], point[1], point[2]});
    surface.point_attributes = {{"P", 3, "point", p}};
    for (const openvdb::Vec3I& t : cube.triangles) {
        surface.vertex_point.insert(surface.vertex_point.end(), {t[0], t[2], t[1]});
        surface.primitives.push_back({houdini::PrimitiveType::polygon, 3});
    }
    const HoudiniGeometry others = houdini::parse_geometry(kOthersText, "others").geometry;
    const Format inside = format == Format::compressed ? Format::binary : format;
    std::vector<std::string> made{written(shell, inside), written(surface, inside),
                                  written(rich_geometry(), inside), written(layers, inside)};
    if (format == Format::text)
        made.emplace_back(kOthersText);
    else
        made.push_back(written(others, inside));
    return made;
}

/// One change of a kind that damaged or hostile files have.
void damage(std::string& bytes, const std::vector<std::string>& seeds, Random& random)
{
    static const std::string kWords[] = {
        "-1",     "0",     "1e999",      "2147483648", "-9223372036854775808",
        "\"\"",   "null",  "[",          "]",          "{",
        "}",      "[]",    "true",       "1000000000", "startvertex",
        "tuples", "\"P\"", "4294967295", "boolRLE"};
    const std::size_t at = below(random, bytes.size() + 1);
    const std::size_t size = below(random, std::min<std::size_t>(bytes.size() - at, 40) + 1);
    switch (below(random, 10)) {
    case 0: // a bit
        if (at < bytes.size())
            bytes[at] = static_cast<char>(bytes[at] ^ (1 << below(random, 8)));
        return;
    case 1: // a byte
        if (at < bytes.size())
            bytes[at] = static_cast<char>(random());
        return;
    case 2: // a byte that means something
        if (at < bytes.size())
            bytes[at] =
                "\x00\x7f\x80\xff\xf2\xf4\xf8\xf1[]{}&+'@\x10\x13\x14\x19\x1a"[below(random, 21)];
        return;
    case 3: // cut out
        bytes.erase(at, size);
        return;
    case 4: // said twice
        bytes.insert(at, bytes.substr(at, size));
        return;
    case 5: // an end
        if (below(random, 4) == 0)
            bytes.resize(at);
        return;
    case 6: { // from somewhere else
        const std::string& other = seeds[below(random, seeds.size())];
        bytes.replace(at, size, other.substr(std::min(at, other.size()), size));
        return;
    }
    case 7: // moved
        bytes.insert(below(random, bytes.size() + 1), bytes.substr(at, size));
        return;
    case 8: // a number where a number is
        for (std::size_t i = at; i < bytes.size(); ++i)
            if (bytes[i] >= '0' && bytes[i] <= '9') {
                bytes.replace(i, 1, kWords[below(random, 5)]);
                return;
            }
        return;
    default:
        bytes.insert(at, kWords[below(random, std::size(kWords))]);
    }
}

/// What comes out must go in again, the same.
std::string fault_of_round_trip(const HoudiniGeometry& geometry, Format format)
{
    try {
        houdini::require_consistent(geometry);
        const std::string bytes = written(geometry, format);
        const HoudiniGeometry again = houdini::parse_geometry(bytes, "again").geometry;
        return written(again, format) == bytes ? "" : "what was read is not written the same twice";
    } catch (const InvalidOption&) {
        return ""; // no P, or a value that this form cannot hold
    } catch (const ReadError& error) {
        // A small file can tell of more than a file of its size may (constant pages, runs).
        return std::string("what was written cannot be read: ") + error.what();
    }
}

void read_one(const std::string& bytes, Format format, FuzzResult& result)
{
    HoudiniGeometry geometry;
    try {
        const houdini::ReadGeometry read = houdini::parse_geometry(bytes, "fuzz");
        ++result.read;
        geometry = read.geometry;
        try {
            houdini::polygon_mesh(read, "fuzz");
            ++result.surfaces;
        } catch (const ReadError&) {
        }
        try {
            houdini::shell_of_geometry(geometry, "fuzz");
            ++result.shells;
        } catch (const ReadError&) {
        }
    } catch (const ReadError&) {
        ++result.refused;
        return;
    }
    const std::string fault = fault_of_round_trip(geometry, format);
    if (!fault.empty() && result.wrong.empty())
        result.wrong = fault;
}

} // namespace

FuzzResult fuzz(Format format, std::size_t inputs, std::uint64_t seed)
{
    const std::vector<std::string> whole = seeds(format);
    Random random(seed);
    FuzzResult result;
    for (std::size_t i = 0; i < inputs; ++i) {
        std::string bytes = whole[below(random, whole.size())];
        // Half of the compressed files are damaged inside, half outside.
        const bool outside = format == Format::compressed && i % 2 == 0;
        if (outside)
            bytes = compressed(bytes);
        std::size_t document = bytes.size();
        for (std::size_t changes = 1 + below(random, 4); changes > 0; --changes)
            damage(bytes, whole, random);
        document = std::max(document, bytes.size());
        if (format == Format::compressed && !outside && !bytes.empty())
            bytes = compressed(bytes);
        const std::int64_t before = allocated;
        most_allocated = before;
        const auto start = std::chrono::steady_clock::now();
        try {
            read_one(bytes, format, result);
        } catch (const std::exception& error) {
            if (result.wrong.empty())
                result.wrong = "input " + std::to_string(i) + ": " + error.what();
        }
        const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
        result.slowest_seconds = std::max(result.slowest_seconds, took.count());
        constexpr std::int64_t kBytesPerByte = 64;
        result.most_beyond_document =
            std::max(result.most_beyond_document,
                     most_allocated - before - kBytesPerByte * static_cast<std::int64_t>(document));
        ++result.inputs;
    }
    return result;
}

} // namespace vdb_shell::test
