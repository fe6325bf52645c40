// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/point_grid_instances.h"
#include "vdb_shell/core/error.h"

#include <openvdb/points/AttributeArray.h>

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

namespace vdb_shell
{

/// Reads the rows of one grid of a file that is not trusted, keyed by their `id`. Throws ReadError
/// that names file, grid, attribute and row.
class PointGridReader
{
    using AttributeArray = openvdb::points::AttributeArray;
    template <typename T> using AttributeHandle = openvdb::points::AttributeHandle<T>;
    using PointDataGrid = openvdb::points::PointDataGrid;
    using Leaf = openvdb::points::PointDataTree::LeafNodeType;

public:
    PointGridReader(const PointDataGrid& grid, std::int64_t count, const std::string& file)
        : grid_(grid), count_(std::size_t(count)),
          where_(file + ": grid \"" + grid.getName() + "\"")
    {
        // Counted before anything is allocated: the metadata may claim any number.
        std::uint64_t rows = 0;
        for (auto leaf = grid.tree().cbeginLeaf(); leaf; ++leaf)
            rows += array<std::int32_t>(*leaf, "id", 1).size();
        if (rows != count_)
            fail("holds " + std::to_string(rows) + " points, the metadata says " +
                 std::to_string(count_));
        // As many rows as ids, each in range and none twice: so each id is there exactly once, and
        // the arrays that are filled below have no gaps.
        std::vector<bool> seen(count_, false);
        for_each_row<std::int32_t>("id", 1, [&](std::size_t id, openvdb::Index, std::int32_t) {
            if (seen[id])
                fail("attribute \"id\": " + std::to_string(id) + " appears twice");
            seen[id] = true;
        });
    }

    /// set(id, element, value) for every row; ids are in range. Arrays of a damaged leaf may have
    /// different lengths, so the lengths are compared leaf by leaf before a row is read.
    template <typename T, typename Set>
    void for_each_row(const std::string& name, openvdb::Index stride, const Set& set) const
    {
        for (auto leaf = grid_.tree().cbeginLeaf(); leaf; ++leaf) {
            const AttributeArray& ids = array<std::int32_t>(*leaf, "id", 1);
            const AttributeArray& values = array<T>(*leaf, name, stride);
            if (values.size() != ids.size())
                fail("attribute \"" + name + "\" has " + std::to_string(values.size()) +
                     " rows where \"id\" has " + std::to_string(ids.size()));
            const AttributeHandle<std::int32_t> id(ids);
            const AttributeHandle<T> value(values);
            for (openvdb::Index row = 0; row < ids.size(); ++row) {
                const std::size_t index = in_range(id.get(row), count_, "id", row);
                for (openvdb::Index element = 0; element < stride; ++element)
                    set(index, element, value.get(row, element));
            }
        }
    }

    /// The value as an index below `limit`, or ReadError. It comes as 64 bits, which hold every
    /// int32 of a file and, for `tet_point`, one more than that.
    std::uint32_t in_range(std::int64_t value, std::size_t limit, const char* attribute,
                           std::size_t row) const
    {
        if (value < 0 || std::uint64_t(value) >= limit)
            fail(std::string("attribute \"") + attribute + "\" of " + std::to_string(row) +
                 ": value " + std::to_string(value) + " is not in [0, " + std::to_string(limit) +
                 ")");
        return std::uint32_t(value);
    }

    template <typename Set>
    void indices(const char* name, openvdb::Index stride, std::size_t limit, const Set& set) const
    {
        for_each_row<std::int32_t>(name, stride,
                                   [&](std::size_t id, openvdb::Index element, std::int32_t value) {
                                       set(id, element, in_range(value, limit, name, id));
                                   });
    }

    void positions(const char* name, std::vector<openvdb::Vec3s>& out) const
    {
        out.resize(count_);
        for_each_row<openvdb::Vec3s>(
            name, 1, [&](std::size_t id, openvdb::Index, const openvdb::Vec3s& value) {
                if (!std::isfinite(value[0]) || !std::isfinite(value[1]) ||
                    !std::isfinite(value[2]))
                    fail(std::string("attribute \"") + name + "\" of " + std::to_string(id) +
                         " is not finite");
                out[id] = value;
            });
    }

    [[noreturn]] void fail(const std::string& what) const { throw ReadError(where_ + ": " + what); }

private:
    template <typename T>
    const AttributeArray& array(const Leaf& leaf, const std::string& name,
                                openvdb::Index stride) const
    {
        // It is looked up in each leaf: those of a damaged file need not all have the same
        // attributes.
        const AttributeArray* found = leaf.attributeSet().getConst(name);
        if (!found)
            fail("attribute \"" + name + "\" is missing");
        if (!found->hasValueType<T>())
            fail("attribute \"" + name + "\" has type " + found->type().first + ", expected " +
                 openvdb::typeNameAsString<T>());
        if (found->stride() != stride || !found->hasConstantStride())
            fail("attribute \"" + name + "\" has stride " + std::to_string(found->stride()) +
                 ", expected " + std::to_string(stride));
        return *found;
    }

    const PointDataGrid& grid_;
    std::size_t count_;
    std::string where_;
};

} // namespace vdb_shell
