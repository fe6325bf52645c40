// SPDX-License-Identifier: Apache-2.0

// Builds the tree of a document while it is parsed, for both forms. The point is memory: a list of
// numbers becomes one vector as it grows, and a list of equally long lists of numbers becomes one
// vector with a width, so a million positions are one block and not a million lists. A list that
// turns out to be mixed is spelt out into single values, once. A trap: whole numbers and reals in
// one list all become doubles, which is exact for whole numbers up to 2^53 only.

#include "value.h"

#include "vdb_shell/io/read_file.h"

#include <utility>

namespace vdb_shell::houdini
{
namespace
{

/// The list behind `value`, each element a value of its own again. It happens at most once for each
/// list: afterwards the list is general and stays so, and the time stays linear.
List& spelt_out(Value& value)
{
    const auto spell = [](const auto& numbers) {
        using Element = typename std::decay_t<decltype(numbers.values)>::value_type;
        List list;
        if (numbers.width == 0) {
            for (const Element number : numbers.values)
                list.push_back({number});
            return list;
        }
        for (std::size_t begin = 0; begin < numbers.values.size(); begin += numbers.width) {
            const auto first = numbers.values.begin() + static_cast<std::ptrdiff_t>(begin);
            list.push_back(
                {Numbers<Element>{{first, first + static_cast<std::ptrdiff_t>(numbers.width)}, 0}});
        }
        return list;
    };
    if (const auto* integers = std::get_if<Integers>(&value.data))
        value.data = spell(*integers);
    else if (const auto* reals = std::get_if<Reals>(&value.data))
        value.data = spell(*reals);
    else if (const auto* flags = std::get_if<Booleans>(&value.data)) {
        List list;
        for (const bool flag : *flags)
            list.push_back({flag});
        value.data = std::move(list);
    }
    return std::get<List>(value.data);
}

bool is_empty_list(const Value& value)
{
    const List* list = std::get_if<List>(&value.data);
    return list && list->empty();
}

/// Text has "1" for the real 1, so a list of reals may begin with whole numbers; the list becomes
/// one of reals when the first point is met.
Reals& as_reals(Value& value)
{
    if (const auto* integers = std::get_if<Integers>(&value.data))
        value.data = Reals{{integers->values.begin(), integers->values.end()}, integers->width};
    return std::get<Reals>(value.data);
}

template <typename T> Numbers<T>* numbers_of_width(Value& value, std::size_t width)
{
    auto* numbers = std::get_if<Numbers<T>>(&value.data);
    return numbers && numbers->width == width ? numbers : nullptr;
}

/// The first number decides the kind of an empty list, the later ones may widen it.
void append_integer(Value& list, std::int64_t value)
{
    if (is_empty_list(list))
        list.data = Integers{{value}, 0};
    else if (auto* integers = numbers_of_width<std::int64_t>(list, 0))
        integers->values.push_back(value);
    else if (auto* reals = numbers_of_width<double>(list, 0))
        reals->values.push_back(static_cast<double>(value));
    else
        spelt_out(list).push_back({value});
}

void append_real(Value& list, double value)
{
    if (is_empty_list(list))
        list.data = Reals{{value}, 0};
    else if (numbers_of_width<std::int64_t>(list, 0) || numbers_of_width<double>(list, 0))
        as_reals(list).values.push_back(value);
    else
        spelt_out(list).push_back({value});
}

/// A finished list as the next element of another.
void append_list(Value& list, Value element)
{
    const auto* integers = numbers_of_width<std::int64_t>(element, 0);
    const auto* reals = numbers_of_width<double>(element, 0);
    // Only a list of plain numbers can be a row, and only if it is as long as the rows before it.
    // An empty list is no row, as it has no type.
    const std::size_t width = integers ? integers->values.size() : reals ? reals->values.size() : 0;
    const bool fits = is_empty_list(list) || numbers_of_width<std::int64_t>(list, width) ||
                      numbers_of_width<double>(list, width);
    if (width == 0 || !fits) {
        spelt_out(list).push_back(std::move(element));
        return;
    }
    // The first row: its vector is taken over as it is, and the width tells from now on that it
    // stands for rows.
    if (is_empty_list(list)) {
        list = std::move(element);
        std::visit(
            [width](auto& held) {
                if constexpr (std::is_same_v<std::decay_t<decltype(held)>, Integers> ||
                              std::is_same_v<std::decay_t<decltype(held)>, Reals>)
                    held.width = width;
            },
            list.data);
        return;
    }
    if (auto* held = std::get_if<Integers>(&list.data); held && integers) {
        held->values.insert(held->values.end(), integers->values.begin(), integers->values.end());
        return;
    }
    // One of the two has reals, so both become reals.
    Reals& held = as_reals(list);
    if (integers)
        held.values.insert(held.values.end(), integers->values.begin(), integers->values.end());
    else
        held.values.insert(held.values.end(), reals->values.begin(), reals->values.end());
}

} // namespace

void TreeBuilder::finish(Value value)
{
    if (open_.empty()) {
        if (complete_)
            refuse(name_, "the document goes on after its end");
        root_ = std::move(value);
        complete_ = true;
        return;
    }
    Value& into = open_.back();
    // Keys and values stand in turn; Fields finds out whether they pair up and each key is a text.
    if (Map* map = std::get_if<Map>(&into.data))
        map->items.push_back(std::move(value));
    else
        append_list(into, std::move(value));
}

void TreeBuilder::add(Value value)
{
    // Keys and values of maps are not compacted, since both stand in one list of items.
    const bool in_list = !open_.empty() && !std::holds_alternative<Map>(open_.back().data);
    if (const auto* number = std::get_if<std::int64_t>(&value.data); in_list && number)
        append_integer(open_.back(), *number);
    else if (const auto* real = std::get_if<double>(&value.data); in_list && real)
        append_real(open_.back(), *real);
    else
        finish(std::move(value));
}

void TreeBuilder::integer(std::int64_t value)
{
    add({value});
}

void TreeBuilder::real(double value)
{
    add({value});
}

void TreeBuilder::open(Value container)
{
    // Destroying the tree is recursive, so its depth has to be bounded before it is built.
    if (open_.size() == kDeepest)
        refuse(name_, "its arrays are nested more than " + std::to_string(kDeepest) + " deep");
    if (complete_)
        refuse(name_, "the document goes on after its end");
    open_.push_back(std::move(container));
}

void TreeBuilder::open_list()
{
    open({List{}});
}

void TreeBuilder::open_map()
{
    open({Map{}});
}

/// Binary documents have separate marks for the ends of lists and maps, which can disagree with
/// what is open; the text parser has made sure of it already.
void TreeBuilder::close(bool map)
{
    if (open_.empty() || std::holds_alternative<Map>(open_.back().data) != map)
        refuse(name_, std::string("the end of a ") + (map ? "map" : "list") +
                          " stands where none is open");
    Value done = std::move(open_.back());
    open_.pop_back();
    finish(std::move(done));
}

void TreeBuilder::close_list()
{
    close(false);
}

void TreeBuilder::close_map()
{
    close(true);
}

namespace
{

struct Describe {
    std::string operator()(std::monostate) const { return "null"; }
    std::string operator()(bool flag) const { return flag ? "true" : "false"; }
    std::string operator()(std::int64_t number) const
    {
        return "the number " + std::to_string(number);
    }
    std::string operator()(double number) const { return "the number " + std::to_string(number); }
    std::string operator()(const Text& text) const { return vdb_shell::quoted(*text); }
    std::string operator()(const List& list) const
    {
        return "a list of " + std::to_string(list.size());
    }
    std::string operator()(const Map&) const { return "a map"; }
    std::string operator()(const Booleans& flags) const
    {
        return "a list of " + std::to_string(flags.size()) + " flags";
    }
    template <typename T> std::string operator()(const Numbers<T>& numbers) const
    {
        const std::string count = std::to_string(
            numbers.width ? numbers.values.size() / numbers.width : numbers.values.size());
        return "a list of " + count +
               (numbers.width ? " lists of " + std::to_string(numbers.width) + " numbers"
                              : std::string(" numbers"));
    }
};

} // namespace

std::string describe(const Value& value)
{
    return std::visit(Describe{}, value.data);
}

} // namespace vdb_shell::houdini
