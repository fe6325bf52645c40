// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/Types.h>

#include <cstdint>
#include <vector>

namespace vdb_shell
{

/// exact::triangles_touch for many pairs of one surface: most that have a corner in common lie in a
/// fan that is seen at once to be embedded. Keeps references.
class TriangleContacts
{
public:
    TriangleContacts(const std::vector<openvdb::Vec3s>& points,
                     const std::vector<openvdb::Vec3I>& triangles);

    /// Whether the two touch anywhere but in the corners and edges that they share by index. Exact.
    /// Precondition: neither is degenerate.
    bool touch(std::uint32_t first, std::uint32_t second) const;

private:
    const std::vector<openvdb::Vec3s>& points_;
    const std::vector<openvdb::Vec3I>& triangles_;
    std::vector<std::uint8_t> embedded_; ///< by vertex: its fan is, for certain
};

} // namespace vdb_shell
