// SPDX-License-Identifier: Apache-2.0

// Two guards of every format that holds a whole shell. require_consistent throws unless stack and
// tets fit together as make_tets leaves them; the writers call it, so that no file is made which
// the reader would refuse, and the readers call it on what a file gave. checksum_of is a number for
// all arrays of the shell: 64-bit FNV-1a (Fowler, Noll and Vo), which finds damage and mix-ups but
// stops nobody who forges a file. Both compare bits and not values, as -0 and 0 are different
// floats in a file.

#include "vdb_shell/core/error.h"
#include "vdb_shell/shell/shared_points.h"

#include "write/point_grids.h"

#include <array>
#include <cmath>
#include <cstring>
#include <limits>

namespace vdb_shell
{
namespace
{

using openvdb::Vec3s;

[[noreturn]] void refuse(const std::string& what)
{
    throw InvalidOption("the shell cannot be written: " + what);
}

void require(bool holds, const char* what, std::size_t index)
{
    if (!holds)
        refuse(std::string(what) + " (index " + std::to_string(index) + ")");
}

void require_size(std::size_t found, std::size_t expected, const char* what)
{
    if (found != expected)
        refuse(std::string(what) + " has " + std::to_string(found) + " entries, expected " +
               std::to_string(expected));
}

void require_finite(const std::vector<Vec3s>& points, const char* what)
{
    for (std::size_t i = 0; i < points.size(); ++i)
        require(std::isfinite(points[i][0]) && std::isfinite(points[i][1]) &&
                    std::isfinite(points[i][2]),
                what, i);
}

/// Three values below 3 that set three different bits are each there once.
bool is_permutation(const std::array<std::uint8_t, 3>& order)
{
    unsigned seen = 0;
    for (const std::uint8_t corner : order)
        seen |= corner < 3 ? 1u << corner : 0u;
    return seen == 7u;
}

void require_sizes(const ShellStack& stack, const TetMesh& tets)
{
    if (stack.layers.empty() || stack.layers.size() > ShellStack::kMostLayers)
        refuse("it has " + std::to_string(stack.layers.size()) + " layers, expected 1 to " +
               std::to_string(ShellStack::kMostLayers));
    require_size(stack.splits.size(), stack.layers.size(), "splits");
    require(stack.skin <= stack.layers.size(), "the skin is no surface of the stack", stack.skin);
    const std::size_t vertices = stack.surface(0).size(), triangles = stack.triangles().size();
    for (std::size_t k = 0; k < stack.layers.size(); ++k) {
        const PrismShell& layer = stack.layers[k];
        require_size(layer.outer.size(), vertices, "outer");
        require_size(layer.inner.size(), vertices, "inner");
        require_size(layer.stop.size(), vertices, "stop");
        require_size(layer.triangles.size(), triangles, "triangles");
        require_size(stack.splits[k].order.size(), triangles, "split.order");
    }
    require_size(tets.source_vertex.size(), tets.points.size(), "source_vertex");
    require_size(tets.layer.size(), tets.points.size(), "layer");
    require_size(tets.prism.size(), tets.tets.size(), "tets.prism");
    require_size(tets.prism_layer.size(), tets.tets.size(), "tets.prism_layer");
    // The product bounds the number of points: a surface has at most one for each vertex. After
    // this test all counts can be cast to int32.
    constexpr std::size_t kMost = std::numeric_limits<std::int32_t>::max();
    for (const std::size_t count :
         {stack.surfaces() * vertices, tets.tets.size(), stack.layers.size() * triangles})
        require(count <= kMost, "more elements than int32 can number", count);
}

/// What the layers have in common is the same in all: the surface between two of them, triangles,
/// and on each side of the skin the reasons.
void require_layers_fit(const ShellStack& stack)
{
    for (std::size_t k = 1; k < stack.layers.size(); ++k) {
        const PrismShell &above = stack.layers[k - 1], &layer = stack.layers[k];
        for (std::size_t t = 0; t < layer.triangles.size(); ++t)
            require(layer.triangles[t] == above.triangles[t],
                    "a layer's triangle is not that of the layer above", t);
        for (std::size_t v = 0; v < layer.outer.size(); ++v) {
            require(same_bits(above.inner[v], layer.outer[v]),
                    "a layer does not begin where the one above ends", v);
            // A pinned pillar is one whose ends are equal as numbers. The files store one point for
            // both ends, so ends that differ in the sign of a zero could not be read back.
            require(!above.pinned(v) || !layer.pinned(v) ||
                        same_bits(layer.outer[v], layer.inner[v]),
                    "a pinned pillar's ends differ in the sign of a zero", v);
            // Above the skin the pillars grew outwards, below it inwards; only there may the reason
            // change.
            require(k == stack.skin || above.stop[v] == layer.stop[v],
                    "a pillar has two reasons to end on one side of the skin", v);
        }
    }
}

/// Every point of the tets is an end of a pillar, the first of those that share it, and no end is
/// there twice.
void require_points(const ShellStack& stack, const TetMesh& tets,
                    const std::vector<std::uint32_t>& first)
{
    const std::size_t vertices = stack.surface(0).size();
    std::vector<std::vector<bool>> seen(stack.surfaces(),
                                        std::vector<bool>(stack.surface(0).size(), false));
    for (std::size_t i = 0; i < tets.points.size(); ++i) {
        const std::uint32_t v = tets.source_vertex[i];
        const std::size_t k = tets.layer[i];
        require(v < vertices && k < stack.surfaces() && first[k * vertices + v] == k * vertices + v,
                "a point of the tets belongs to no end of a pillar", i);
        require(same_bits(stack.surface(k)[v], tets.points[i]),
                "a point of the tets is not where its pillar ends", i);
        require(!seen[k][v], "a point of the tets is there twice", i);
        seen[k][v] = true;
    }
}

/// Of a tapered stack, where equal points are one. Tets and files have the bits of the first.
void require_shared_bits(const ShellStack& stack, const std::vector<std::uint32_t>& first)
{
    const std::size_t vertices = stack.surface(0).size();
    const auto at = [&](std::size_t place) {
        return stack.surface(place / vertices)[place % vertices];
    };
    for (std::size_t place = 0; place < first.size(); ++place)
        require(same_bits(at(place), at(first[place])),
                "points that pillars share differ in the sign of a zero", place % vertices);
}

void require_layer(const PrismShell& layer, const PrismSplit& split)
{
    require_finite(layer.outer, "an outer coordinate is not finite");
    require_finite(layer.inner, "an inner coordinate is not finite");
    for (std::size_t p = 0; p < layer.triangles.size(); ++p) {
        for (int corner = 0; corner < 3; ++corner)
            require(layer.triangles[p][corner] < layer.outer.size(),
                    "a triangle's vertex is out of range", p);
        require(is_permutation(split.order[p]), "a split order is no permutation of 0, 1, 2", p);
    }
    for (std::size_t v = 0; v < layer.stop.size(); ++v)
        require(int(layer.stop[v]) < kStopReasonCount, "a stop reason is out of range", v);
}

/// The constants are the offset basis and the prime of the 64-bit variant. Bytes are taken as they
/// lie in memory, so the number is the same on machines of the same byte order.
class Fnv1a
{
public:
    template <typename T> void add(const std::vector<T>& values)
    {
        // The length comes first, or moving an element from the end of one array to the start of
        // the next would go unnoticed.
        const std::uint64_t count = values.size();
        add_bytes(&count, sizeof count);
        add_bytes(values.data(), values.size() * sizeof(T));
    }
    std::string hex() const
    {
        static constexpr char kDigits[] = "0123456789abcdef";
        std::string text(16, '0');
        for (std::size_t i = 0; i < 16; ++i)
            text[i] = kDigits[(hash_ >> (60 - 4 * i)) & 15u];
        return text;
    }

private:
    void add_bytes(const void* data, std::size_t size)
    {
        const auto* bytes = static_cast<const unsigned char*>(data);
        for (std::size_t i = 0; i < size; ++i)
            hash_ = (hash_ ^ bytes[i]) * 1099511628211ull;
    }
    std::uint64_t hash_ = 14695981039346656037ull;
};

} // namespace

bool same_bits(const Vec3s& a, const Vec3s& b)
{
    // The bits matter here: values that compare equal need not have the same ones.
    const auto bits = [](const Vec3s& vector) {
        std::array<std::uint32_t, 3> words;
        std::memcpy(words.data(), vector.asPointer(), sizeof(words));
        return words;
    };
    return bits(a) == bits(b);
}

void require_consistent(const ShellStack& stack, const TetMesh& tets)
{
    // Sizes are tested first: all later tests index one array by the length of another.
    require_sizes(stack, tets);
    for (std::size_t k = 0; k < stack.layers.size(); ++k)
        require_layer(stack.layers[k], stack.splits[k]);
    require_layers_fit(stack);
    const std::vector<std::uint32_t> first = first_places(stack);
    if (stack.tapered)
        require_shared_bits(stack, first);
    require_points(stack, tets, first);
    for (std::size_t t = 0; t < tets.tets.size(); ++t) {
        for (int corner = 0; corner < 4; ++corner)
            require(tets.tets[t][corner] < tets.points.size(), "a tet's point is out of range", t);
        require(tets.prism[t] < stack.triangles().size() &&
                    tets.prism_layer[t] < stack.layers.size(),
                "a tet's prism is out of range", t);
    }
}

void require_consistent_core(const ShellStack& stack, const TetMesh& tets, const CoreTets& core)
{
    require_size(core.source_vertex.size(), core.points.size(), "the core's list of vertices");
    require_finite(core.points, "a point of the core is not finite");
    // Only below the surface is there a void to fill.
    require(core.tets.empty() || stack.skin == 0, "a core within a shell outside the surface", 0);
    const std::size_t points = tets.points.size() + core.points.size();
    const auto most = std::size_t(std::numeric_limits<std::int32_t>::max());
    // Ids of the core's points go on behind those of all surfaces' points.
    const std::size_t ids = stack.surfaces() * stack.surface(0).size() + core.points.size();
    require(ids <= most && core.tets.size() <= most, "more of the core than 32 bits number", 0);
    for (std::size_t t = 0; t < core.tets.size(); ++t)
        for (int corner = 0; corner < 4; ++corner)
            require(core.tets[t][corner] < points, "a point of the core's tet is out of range", t);
    for (std::size_t i = 0; i < core.points.size(); ++i)
        require(core.source_vertex[i] == CoreTets::kNoVertex ||
                    core.source_vertex[i] < stack.surface(0).size(),
                "a vertex of the core is out of range", i);
}

std::string checksum_of(const ShellStack& stack, const TetMesh& tets, const CoreTets& core)
{
    Fnv1a hash;
    // The order of the arrays is part of the format: another order gives another number, and all
    // files written so far would be refused.
    for (std::size_t k = 0; k < stack.surfaces(); ++k)
        hash.add(stack.surface(k));
    hash.add(stack.triangles());
    for (const PrismShell& layer : stack.layers)
        hash.add(layer.stop);
    for (const PrismSplit& split : stack.splits)
        hash.add(split.order);
    hash.add(tets.source_vertex);
    hash.add(tets.layer);
    hash.add(tets.tets);
    hash.add(tets.prism);
    // A single layer's checksum is that of files of schema 1.
    if (stack.layers.size() > 1 || stack.skin > 0) {
        hash.add(tets.prism_layer);
        hash.add(std::vector<std::uint64_t>{stack.skin});
    }
    // Only where it is set, for the same reason.
    if (stack.tapered)
        hash.add(std::vector<std::uint8_t>{1});
    if (!core.empty()) {
        hash.add(core.points);
        hash.add(core.source_vertex);
        hash.add(core.tets);
    }
    return hash.hex();
}

} // namespace vdb_shell
