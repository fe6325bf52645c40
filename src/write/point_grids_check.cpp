// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/core/error.h"

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

bool is_permutation(const std::array<std::uint8_t, 3>& order)
{
    unsigned seen = 0;
    for (const std::uint8_t corner : order)
        seen |= corner < 3 ? 1u << corner : 0u;
    return seen == 7u;
}

void require_sizes(const PrismShell& shell, const PrismSplit& split, const TetMesh& tets)
{
    require_size(shell.inner.size(), shell.outer.size(), "inner");
    require_size(shell.stop.size(), shell.outer.size(), "stop");
    require_size(split.order.size(), shell.triangles.size(), "split.order");
    require_size(tets.source_vertex.size(), tets.points.size(), "source_vertex");
    require_size(tets.layer.size(), tets.points.size(), "layer");
    require_size(tets.prism.size(), tets.tets.size(), "tets.prism");
    constexpr std::size_t kMost = std::numeric_limits<std::int32_t>::max();
    for (const std::size_t count :
         {2 * shell.outer.size(), tets.tets.size(), shell.triangles.size()})
        require(count <= kMost, "more elements than int32 can number", count);
}

/// Every point of the tets is an end of a pillar, and no end is there twice.
void require_points(const PrismShell& shell, const TetMesh& tets)
{
    std::array<std::vector<bool>, 2> seen;
    for (std::vector<bool>& layer : seen)
        layer.assign(shell.outer.size(), false);
    for (std::size_t i = 0; i < tets.points.size(); ++i) {
        const std::uint32_t v = tets.source_vertex[i];
        const std::size_t layer = tets.layer[i];
        require(v < shell.outer.size() && layer < 2 && !(layer == 1 && shell.pinned(v)),
                "a point of the tets belongs to no end of a pillar", i);
        const Vec3s& end = layer == 0 ? shell.outer[v] : shell.inner[v];
        require(same_bits(end, tets.points[i]), "a point of the tets is not where its pillar ends",
                i);
        require(!seen[layer][v], "a point of the tets is there twice", i);
        seen[layer][v] = true;
    }
}

class Fnv1a
{
public:
    template <typename T> void add(const std::vector<T>& values)
    {
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
    // The bits are what is asked for: values that compare equal need not have the same ones.
    // NOLINTNEXTLINE(bugprone-suspicious-memory-comparison)
    return std::memcmp(a.asPointer(), b.asPointer(), 3 * sizeof(float)) == 0;
}

void require_consistent(const PrismShell& shell, const PrismSplit& split, const TetMesh& tets)
{
    require_sizes(shell, split, tets);
    require_finite(shell.outer, "an outer coordinate is not finite");
    require_finite(shell.inner, "an inner coordinate is not finite");
    for (std::size_t p = 0; p < shell.triangles.size(); ++p) {
        for (int corner = 0; corner < 3; ++corner)
            require(shell.triangles[p][corner] < shell.outer.size(),
                    "a triangle's vertex is out of range", p);
        require(is_permutation(split.order[p]), "a split order is no permutation of 0, 1, 2", p);
    }
    for (std::size_t v = 0; v < shell.stop.size(); ++v)
        require(int(shell.stop[v]) < kStopReasonCount, "a stop reason is out of range", v);
    require_points(shell, tets);
    for (std::size_t t = 0; t < tets.tets.size(); ++t) {
        for (int corner = 0; corner < 4; ++corner)
            require(tets.tets[t][corner] < tets.points.size(), "a tet's point is out of range", t);
        require(tets.prism[t] < shell.triangles.size(), "a tet's prism is out of range", t);
    }
}

std::string checksum_of(const PrismShell& shell, const PrismSplit& split, const TetMesh& tets)
{
    Fnv1a hash;
    hash.add(shell.outer);
    hash.add(shell.inner);
    hash.add(shell.triangles);
    hash.add(shell.stop);
    hash.add(split.order);
    hash.add(tets.source_vertex);
    hash.add(tets.layer);
    hash.add(tets.tets);
    hash.add(tets.prism);
    return hash.hex();
}

} // namespace vdb_shell
