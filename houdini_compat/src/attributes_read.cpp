// SPDX-License-Identifier: Apache-2.0

// Reads the attributes of one class of elements into tuples, whatever layout the file has them in.
// The order of the tests bounds the memory: sizes and pages by constants, numbers of values by what
// is in the file, and what constant pages spell out by the budget. Attributes of kinds that have no
// place in HoudiniGeometry are named as unread; a fault in one that has a place refuses the file,
// because half an attribute would look like a whole one.

#include "geometry_parts.h"

#include "vdb_shell/io/read_file.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

namespace vdb_shell::houdini
{
namespace
{

// Attributes come in three layouts: a list for each element ("tuples"), a list for each component
// ("arrays"), and pages ("rawpagedata"), in which a value that fills a page is stored once. All are
// unfolded here into one vector, tuple after tuple.

// Far beyond what Houdini writes, and small enough for products of them not to overflow 64 bits.
constexpr std::size_t kMostSize = 1 << 16, kMostPageSize = 1 << 24;

/// A number of a file as the type in which it is kept. The tree has all integers as int64 and all
/// reals as double; a value that this type cannot hold means damage, and is refused rather than cut
/// off.
template <typename T> T converted(std::int64_t value, std::size_t at, const Where& where)
{
    if constexpr (std::is_integral_v<T>) {
        if (value < std::numeric_limits<T>::min() || value > std::numeric_limits<T>::max())
            where.fail("value " + std::to_string(at) + " is " + std::to_string(value) +
                       ", beyond its storage");
    }
    return static_cast<T>(value);
}

template <typename T> T converted(double value, std::size_t at, const Where& where)
{
    if constexpr (std::is_integral_v<T>)
        where.fail("value " + std::to_string(at) + " is " + std::to_string(value) +
                   " where whole numbers are stored");
    // NaN and infinity pass, if they were stored as such: they are left to those that need the
    // values. A finite number that becomes infinite by the conversion is refused.
    if (std::is_same_v<T, float> && std::isfinite(value) &&
        !std::isfinite(static_cast<float>(value)))
        where.fail("value " + std::to_string(at) + " is " + std::to_string(value) +
                   ", beyond its storage");
    return static_cast<T>(value);
}

/// How a column's values are to be laid out.
struct Shape {
    std::size_t elements = 0;
    std::size_t size = 1;
    std::size_t count() const { return elements * size; }
};

/// Rows of equal length: either one list of `size` numbers for each element, or one list of
/// `elements` numbers for each component. The second is transposed.
template <typename T, typename Stored>
std::vector<T> from_rows(const Numbers<Stored>& rows, const Shape& shape, bool tuples,
                         const Where& where)
{
    const std::size_t width = tuples ? shape.size : shape.elements;
    const std::size_t found = rows.width ? rows.values.size() / rows.width : 0;
    const std::size_t wanted = tuples ? shape.elements : shape.size;
    if (rows.width != width || found != wanted)
        where.fail(std::to_string(found) + " lists of " + std::to_string(rows.width) +
                   " numbers where " + std::to_string(wanted) + " lists of " +
                   std::to_string(width) + " are needed");
    std::vector<T> values;
    values.reserve(shape.count());
    for (std::size_t i = 0; i < shape.count(); ++i) {
        // Value i is component i % size of element i / size.
        const std::size_t from = tuples ? i : i % shape.size * shape.elements + i / shape.size;
        values.push_back(converted<T>(rows.values[from], i, where));
    }
    return values;
}

/// How pages are cut up. A tuple may be stored as several subvectors of these widths one after the
/// other within each page. Each subvector has a flag for each page, or no flags at all, which says
/// that one value stands for the whole page.
struct Paging {
    std::size_t page_size = 0;
    std::vector<std::size_t> widths;
    std::vector<std::vector<bool>> constant;
};

Paging read_paging(const Fields& fields, const Shape& shape, const Where& where)
{
    Paging paging;
    paging.page_size = count_of(fields.at("pagesize"), where, "pagesize", kMostPageSize);
    if (paging.page_size == 0)
        where.fail("\"pagesize\" is 0");
    if (const Value* packing = fields.find("packing")) {
        std::size_t sum = 0;
        for (const std::int64_t width : integers_of(*packing, where, "packing")) {
            // Compared with what is left of the tuple, so neither the sum nor a negative width can
            // wrap.
            if (width < 1 || static_cast<std::uint64_t>(width) > shape.size - sum)
                where.fail("\"packing\" has " + std::to_string(width) + " in tuples of " +
                           std::to_string(shape.size));
            paging.widths.push_back(static_cast<std::size_t>(width));
            sum += paging.widths.back();
        }
        if (sum != shape.size)
            where.fail("\"packing\" adds up to " + std::to_string(sum) + " in tuples of " +
                       std::to_string(shape.size));
    } else {
        paging.widths.push_back(shape.size);
    }
    paging.constant.resize(paging.widths.size());
    if (const Value* flags = fields.find("constantpageflags")) {
        const List& lists = list_of(*flags, where, "constantpageflags");
        if (lists.size() != paging.widths.size())
            where.fail("\"constantpageflags\" has " + std::to_string(lists.size()) + " lists for " +
                       std::to_string(paging.widths.size()) + " subvectors");
        // Rounded up: the last page may be shorter than the others.
        const std::size_t pages = (shape.elements + paging.page_size - 1) / paging.page_size;
        for (std::size_t k = 0; k < lists.size(); ++k) {
            paging.constant[k] = flags_of(lists[k], where, "constantpageflags");
            if (!paging.constant[k].empty() && paging.constant[k].size() != pages)
                where.fail("\"constantpageflags\" has " +
                           std::to_string(paging.constant[k].size()) + " flags for " +
                           std::to_string(pages) + " pages");
        }
    }
    return paging;
}

/// How many numbers the pages hold.
std::uint64_t stored_numbers(const Paging& paging, const Shape& shape)
{
    std::uint64_t sum = 0;
    for (std::size_t k = 0; k < paging.widths.size(); ++k) {
        std::uint64_t rows = shape.elements;
        for (std::size_t page = 0; page < paging.constant[k].size(); ++page)
            if (paging.constant[k][page])
                // A constant page keeps one row instead of all that it stands for.
                rows -= std::min(paging.page_size, shape.elements - page * paging.page_size) - 1;
        sum += rows * paging.widths[k];
    }
    return sum;
}

template <typename T, typename Stored>
std::vector<T> from_pages(const std::vector<Stored>& raw, const Shape& shape, const Paging& paging,
                          const Where& where)
{
    if (raw.size() != stored_numbers(paging, shape))
        where.fail("\"rawpagedata\" has " + std::to_string(raw.size()) + " numbers where " +
                   std::to_string(stored_numbers(paging, shape)) + " are needed for " +
                   std::to_string(shape.elements) + " tuples of " + std::to_string(shape.size));
    // The number of stored values has been compared before this line, so no index below leaves
    // `raw`.
    std::vector<T> values(shape.count());
    std::size_t next = 0;
    for (std::size_t begin = 0, page = 0; begin < shape.elements;
         begin += paging.page_size, ++page) {
        const std::size_t end = std::min(begin + paging.page_size, shape.elements);
        for (std::size_t k = 0, offset = 0; k < paging.widths.size();
             offset += paging.widths[k++]) {
            const std::size_t width = paging.widths[k];
            const bool constant = !paging.constant[k].empty() && paging.constant[k][page];
            for (std::size_t e = begin; e < end; ++e)
                for (std::size_t i = 0; i < width; ++i)
                    values[e * shape.size + offset + i] = converted<T>(
                        raw[next + (constant ? 0 : (e - begin) * width) + i], next + i, where);
            next += constant ? width : (end - begin) * width;
        }
    }
    return values;
}

/// Calls use(numbers) with the Integers or Reals behind `value`. An empty list has no type and
/// passes as no integers; what then lacks numbers is found by the count.
template <typename Use>
auto with_numbers(const Value& value, const Where& where, const char* what, const Use& use)
{
    if (const auto* integers = std::get_if<Integers>(&value.data))
        return use(*integers);
    static const Integers none;
    if (is_empty(value))
        return use(none);
    if (const auto* reals = std::get_if<Reals>(&value.data))
        return use(*reals);
    where.fail("\"" + std::string(what) + "\" is " + describe(value) + " where numbers are needed");
}

/// Whether `value` is made of lists that are all empty: rows without numbers.
bool has_no_numbers(const Value& value)
{
    const List* list = std::get_if<List>(&value.data);
    return list && std::all_of(list->begin(), list->end(), is_empty);
}

template <typename T>
std::vector<T> read_column(const Value& value, const Shape& shape, const Where& where,
                           Budget& budget)
{
    const Fields fields(value, where);
    if (count_of(fields.at("size"), where, "size", kMostSize) != shape.size)
        where.fail("the values' \"size\" is " + describe(fields.at("size")) +
                   ", the attribute's is " + std::to_string(shape.size));
    for (const char* key : {"tuples", "arrays"})
        if (const Value* rows = fields.find(key)) {
            // Components without elements are lists that are all empty, which are no rows of
            // numbers in the tree.
            if (shape.elements == 0 && has_no_numbers(*rows))
                return {};
            return with_numbers(*rows, where, key, [&](const auto& numbers) {
                return from_rows<T>(numbers, shape, key[0] == 't', where);
            });
        }
    const Value& raw = fields.at("rawpagedata");
    const Paging paging = read_paging(fields, shape, where);
    return with_numbers(raw, where, "rawpagedata", [&](const auto& numbers) {
        if (numbers.width != 0)
            where.fail("\"rawpagedata\" is " + describe(raw) + " where numbers are needed");
        // Constant pages alone make the result larger than what was stored. Anything else has been
        // paid for by the size of the file.
        if (numbers.values.size() < shape.count())
            budget.spend(shape.count() * sizeof(T), where);
        return from_pages<T>(numbers.values, shape, paging, where);
    });
}

/// Narrow storages are widened: half floats to float, small integers to int32. Nothing is lost, and
/// the rest of the program has four types to deal with instead of nine.
Values read_numeric(const Fields& data, const Shape& shape, const Where& where, Budget& budget)
{
    const std::string& storage = text_of(data.at("storage"), where, "storage");
    const Value& values = data.at("values");
    if (storage == "fpreal32" || storage == "fpreal16")
        return read_column<float>(values, shape, where, budget);
    if (storage == "fpreal64")
        return read_column<double>(values, shape, where, budget);
    if (storage == "int64")
        return read_column<std::int64_t>(values, shape, where, budget);
    for (const char* small : {"int32", "int16", "int8", "uint8", "uint16"})
        if (storage == small)
            return read_column<std::int32_t>(values, shape, where, budget);
    where.fail("the storage " + vdb_shell::quoted(storage) + " is unknown");
}

Strings read_strings(const Fields& data, const Shape& shape, const Where& where, Budget& budget)
{
    Strings strings;
    for (const Value& one : list_of(data.at("strings"), where, "strings")) {
        const std::string& text = text_of(one, where, "strings");
        // The table copies its texts, while a binary file can name one long text many times at two
        // bytes each.
        budget.spend(text.size(), where);
        strings.table.push_back(text);
    }
    strings.index = read_column<std::int32_t>(data.at("indices"), shape, where, budget);
    for (std::size_t i = 0; i < strings.index.size(); ++i)
        if (strings.index[i] < -1 ||
            strings.index[i] >= static_cast<std::int64_t>(strings.table.size()))
            where.fail("value " + std::to_string(i) + " is string " +
                       std::to_string(strings.index[i]) + " of " +
                       std::to_string(strings.table.size()));
    return strings;
}

/// options.type.value, where it is.
std::string meaning_of(const Fields& head, const Where& where)
{
    const Value* options = head.find("options");
    if (!options)
        return {};
    const Fields all(*options, where);
    const Value* type = all.find("type");
    if (!type)
        return {};
    return text_of(Fields(*type, where).at("value"), where, "value");
}

} // namespace

std::vector<Attribute> read_attributes(const Value& value, std::size_t elements, const Where& where,
                                       const char* kind, Budget& budget,
                                       std::vector<std::string>& unread)
{
    std::vector<Attribute> attributes;
    std::set<std::string> seen;
    if (is_empty(value))
        return attributes;
    for (const Value& entry : list_of(value, where, kind)) {
        const List& parts = list_of(entry, where.inside(kind), "attribute");
        if (parts.size() != 2)
            where.inside(kind).fail("an attribute of " + std::to_string(parts.size()) +
                                    " parts where 2 are needed");
        const Fields head(parts[0], where.inside(kind));
        Attribute attribute;
        attribute.name = text_of(head.at("name"), where.inside(kind), "name");
        const std::string title = std::string(kind) + " " + vdb_shell::quoted(attribute.name);
        const Where inside = where.inside(title);
        const std::string& type = text_of(head.at("type"), inside, "type");
        // Before the test for equal names: what is not read cannot clash with what is.
        if (type != "numeric" && type != "string") {
            unread.push_back(title + " of type " + vdb_shell::quoted(type));
            continue;
        }
        if (!seen.insert(attribute.name).second)
            inside.fail("it is there twice");
        const Fields data(parts[1], inside);
        const std::size_t size = count_of(data.at("size"), inside, "size", kMostSize);
        // Houdini has attributes without components.
        if (size == 0) {
            unread.push_back(title + " of size 0");
            continue;
        }
        attribute.size = static_cast<int>(size);
        attribute.meaning = meaning_of(head, inside);
        budget.spend(attribute.meaning.size(), inside);
        const Shape shape{elements, size};
        if (type == "numeric")
            attribute.values = read_numeric(data, shape, inside, budget);
        else
            attribute.values = read_strings(data, shape, inside, budget);
        attributes.push_back(std::move(attribute));
    }
    return attributes;
}

} // namespace vdb_shell::houdini
