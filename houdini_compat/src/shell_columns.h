// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/houdini/geometry.h"
#include "vdb_shell/io/read_file.h"
#include "vdb_shell/shell/shell_stack.h"

#include "shell_names.h"

#include <cstdint>
#include <string>
#include <vector>

namespace vdb_shell::houdini
{

/// The attributes of one class, by the types that a shell has.
class Columns
{
public:
    Columns(const std::vector<Attribute>& attributes, const char* kind, const std::string& name)
        : attributes_(attributes), kind_(kind), name_(name)
    {
    }
    template <typename T> const T& get(const char* attribute, int size) const
    {
        const Attribute* found = find(attributes_, attribute);
        if (!found)
            fail(attribute, "is missing");
        const T* values = std::get_if<T>(&found->values);
        if (!values || found->size != size)
            fail(attribute,
                 "is not of the type or the size " + std::to_string(size) + " that a shell has");
        return *values;
    }
    const std::vector<std::int32_t>& integers(const char* attribute, int size = 1) const
    {
        return get<std::vector<std::int32_t>>(attribute, size);
    }
    std::vector<openvdb::Vec3s> vectors(const char* attribute) const
    {
        const auto& values = get<std::vector<float>>(attribute, 3);
        std::vector<openvdb::Vec3s> made;
        made.reserve(values.size() / 3);
        for (std::size_t i = 0; i < values.size(); i += 3)
            made.emplace_back(values[i], values[i + 1], values[i + 2]);
        return made;
    }
    const std::string& text(const char* attribute) const
    {
        return get<Strings>(attribute, 1).at(0);
    }
    std::size_t count(const char* attribute, std::size_t limit) const
    {
        const std::int32_t value = integers(attribute)[0];
        if (value < 0 || static_cast<std::size_t>(value) > limit)
            fail(attribute, "is " + std::to_string(value) + ", which is not in [0, " +
                                std::to_string(limit) + "]");
        return static_cast<std::size_t>(value);
    }
    [[noreturn]] void fail(const char* attribute, const std::string& what) const
    {
        refuse(name_, std::string(kind_) + " \"" + attribute + "\" " + what);
    }

private:
    const std::vector<Attribute>& attributes_;
    const char* kind_;
    const std::string& name_;
};

/// What a shell's geometry says of its size.
struct Counts {
    std::size_t vertices = 0, prisms = 0, tets = 0, layers = 1, skin = 0;
    bool tapered = false, posed = false;
    std::size_t triangles() const { return prisms / layers; }
    std::vector<std::size_t> surfaces() const { return shown_surfaces(layers, skin); }
    bool layered() const { return houdini::layered(layers, skin); }
};

/// By surface and vertex: the point there; that of the surface above where the pillar between them
/// is pinned.
using Ids = std::vector<std::vector<std::uint32_t>>;

/// Fills the ends of all pillars, why they end, and the skin. Throws ReadError unless every pillar
/// has its ends, once each.
Ids read_pillars(const HoudiniGeometry& geometry, const Columns& points, const Counts& counts,
                 ShellStack& stack);

} // namespace vdb_shell::houdini
