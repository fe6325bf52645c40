// SPDX-License-Identifier: Apache-2.0

// Writes the attributes of a geometry into a document: in pages in the binary form and in lists in
// the text form, as Houdini has them. Precondition: require_consistent, so that the values of an
// attribute fill whole tuples.

#include "attributes_write.h"

#include <type_traits>
#include <variant>

namespace vdb_shell::houdini
{
namespace
{

/// The number of elements in a page; it matters to readers only where pages are constant, and none
/// is written so.
constexpr int kPageSize = 1024;

/// The four types that Values holds; narrower storages are read but never written.
template <typename T> constexpr const char* storage_of()
{
    if constexpr (std::is_same_v<T, std::int32_t>)
        return "int32";
    else if constexpr (std::is_same_v<T, std::int64_t>)
        return "int64";
    else if constexpr (std::is_same_v<T, float>)
        return "fpreal32";
    else
        return "fpreal64";
}

/// The size of the tuples, their storage and the values. Pages without flags hold all tuples one
/// after the other, so the vector is written as it is.
template <typename T>
void write_column(DocumentWriter& out, const char* key, std::size_t size,
                  const std::vector<T>& values)
{
    out.text(key);
    out.open_list();
    key_integer(out, "size", size);
    key_text(out, "storage", storage_of<T>());
    if (out.paged()) {
        key_integer(out, "pagesize", kPageSize);
        out.text("rawpagedata");
        out.numbers(values.data(), values.size());
    } else if (size == 1) {
        out.text("arrays");
        out.open_list();
        out.numbers(values.data(), values.size());
        out.close_list();
    } else {
        out.text("tuples");
        out.open_list();
        for (std::size_t i = 0; i < values.size(); i += size)
            out.numbers(values.data() + i, size);
        out.close_list();
    }
    out.close_list();
}

template <typename T>
void write_values(DocumentWriter& out, std::size_t size, const std::vector<T>& values)
{
    key_integer(out, "size", size);
    key_text(out, "storage", storage_of<T>());
    // What elements get that are made later in Houdini.
    out.text("defaults");
    out.open_list();
    key_integer(out, "size", 1);
    key_text(out, "storage", std::is_integral_v<T> ? "int64" : "fpreal64");
    out.text("values");
    out.open_list();
    if (std::is_integral_v<T>)
        out.integer(0);
    else
        out.real(0);
    out.close_list();
    out.close_list();
    write_column(out, "values", size, values);
}

/// The texts once, in a table, and for each component the number of its text; -1 stands for the
/// empty string.
void write_values(DocumentWriter& out, std::size_t size, const Strings& strings)
{
    key_integer(out, "size", size);
    key_text(out, "storage", "int32");
    out.text("strings");
    out.open_list();
    for (const std::string& string : strings.table)
        out.text(string);
    out.close_list();
    write_column(out, "indices", size, strings.index);
}

/// Two lists: what the attribute is, and what it holds. The option "type" tells Houdini what a
/// vector means, a point or a normal for instance, so that transforms treat it as that.
void write_attribute(DocumentWriter& out, const Attribute& attribute)
{
    out.new_line();
    out.open_list();
    out.open_list();
    key_text(out, "scope", "public");
    key_text(out, "type", std::holds_alternative<Strings>(attribute.values) ? "string" : "numeric");
    key_text(out, "name", attribute.name);
    out.text("options");
    out.open_map();
    if (!attribute.meaning.empty()) {
        out.text("type");
        out.open_map();
        key_text(out, "type", "string");
        key_text(out, "value", attribute.meaning);
        out.close_map();
    }
    out.close_map();
    out.close_list();
    out.open_list();
    const auto size = static_cast<std::size_t>(attribute.size);
    std::visit([&](const auto& values) { write_values(out, size, values); }, attribute.values);
    out.close_list();
    out.close_list();
}

/// An empty class is left out; readers take a missing key for none.
void write_class(DocumentWriter& out, const char* key, const std::vector<Attribute>& attributes)
{
    if (attributes.empty())
        return;
    out.new_line();
    out.text(key);
    out.open_list();
    for (const Attribute& attribute : attributes)
        write_attribute(out, attribute);
    out.close_list();
}

} // namespace

void write_attributes(DocumentWriter& out, const HoudiniGeometry& geometry)
{
    out.new_line();
    out.text("attributes");
    out.open_list();
    write_class(out, "vertexattributes", geometry.vertex_attributes);
    write_class(out, "pointattributes", geometry.point_attributes);
    write_class(out, "primitiveattributes", geometry.primitive_attributes);
    write_class(out, "globalattributes", geometry.detail_attributes);
    out.close_list();
}

} // namespace vdb_shell::houdini
