// SPDX-License-Identifier: Apache-2.0

// How the readers look at a parsed document: maps by key, values as the type that they have to
// have, and a message that names file, part and value whenever something else is there. Houdini
// writes most maps as flat lists of keys and values in turn; both are the same here. Budget is the
// guard against what a format can spell out of little (constant pages, run lengths, shared
// strings): it grants 64 bytes for each byte of the document and a mebibyte, and refuses beyond.

#include "fields.h"

#include "vdb_shell/io/read_file.h"

namespace vdb_shell::houdini
{

void Where::fail(const std::string& what) const
{
    refuse(file, part.empty() ? what : part + ": " + what);
}

Where Where::inside(const std::string& more) const
{
    return {file, part.empty() ? more : part + ", " + more};
}

void Budget::spend(std::uint64_t bytes, const Where& where)
{
    if (bytes > left_)
        where.fail("it would take " + std::to_string(bytes) +
                   " bytes to spell out; for a file of this size at most " + std::to_string(left_) +
                   " more are granted");
    // Compared before it is subtracted, so the unsigned number cannot wrap to a fortune.
    left_ -= bytes;
}

Fields::Fields(const Value& value, const Where& where) : where_(where)
{
    const Map* map = std::get_if<Map>(&value.data);
    const List* items = map ? &map->items : std::get_if<List>(&value.data);
    if (!items)
        where.fail(describe(value) + " where keys and values are needed");
    if (items->size() % 2 != 0)
        where.fail("a list of " + std::to_string(items->size()) +
                   " where keys and values in turn are needed");
    for (std::size_t i = 0; i < items->size(); i += 2) {
        const std::string& key = text_of((*items)[i], where, "a key");
        // The tree shares its strings, but keys are copied here: in a binary file two bytes can
        // stand for a long key, again and again, and each copy would take memory that the file did
        // not pay for.
        if (key.size() > kLongestKey)
            where.fail("a key of " + std::to_string(key.size()) + " bytes, at most " +
                       std::to_string(kLongestKey) + " are read");
        if (!by_key_.emplace(key, &(*items)[i + 1]).second)
            // JSON does not say which of two equal keys counts, and readers differ; so neither is
            // taken.
            where.fail(vdb_shell::quoted(key) + " is there twice");
        keys_.push_back(&key);
    }
}

const Value* Fields::find(const char* key) const
{
    const auto found = by_key_.find(key);
    return found == by_key_.end() ? nullptr : found->second;
}

/// Files from Houdini have either spelling; the long name is the one that this program writes.
const Value* Fields::find(const char* key, const char* short_key) const
{
    const Value* found = find(key);
    return found ? found : find(short_key);
}

const Value& Fields::at(const char* key) const
{
    const Value* found = find(key);
    if (!found)
        where_.fail("\"" + std::string(key) + "\" is missing");
    return *found;
}

namespace
{

[[noreturn]] void mismatch(const Value& value, const Where& where, const char* what,
                           const char* needed)
{
    where.fail("\"" + std::string(what) + "\" is " + describe(value) + " where " + needed +
               " is needed");
}

} // namespace

const std::string& text_of(const Value& value, const Where& where, const char* what)
{
    if (const Text* text = std::get_if<Text>(&value.data))
        return **text;
    mismatch(value, where, what, "a string");
}

bool flag_of(const Value& value, const Where& where, const char* what)
{
    if (const bool* flag = std::get_if<bool>(&value.data))
        return *flag;
    mismatch(value, where, what, "true or false");
}

/// The limit is the caller's, because only the caller knows what bounds the count: memory is often
/// taken for as many elements right afterwards.
std::size_t count_of(const Value& value, const Where& where, const char* what, std::size_t limit)
{
    const auto* number = std::get_if<std::int64_t>(&value.data);
    if (!number)
        mismatch(value, where, what, "a whole number");
    if (*number < 0 || static_cast<std::uint64_t>(*number) > limit)
        where.fail("\"" + std::string(what) + "\" is " + std::to_string(*number) +
                   ", which is not in [0, " + std::to_string(limit) + "]");
    return static_cast<std::size_t>(*number);
}

const List& list_of(const Value& value, const Where& where, const char* what)
{
    if (const List* list = std::get_if<List>(&value.data))
        return *list;
    mismatch(value, where, what, "a list");
}

/// An empty list has no type in either form, so it passes as a list of numbers. Rows of numbers do
/// not: they are lists of lists.
const std::vector<std::int64_t>& integers_of(const Value& value, const Where& where,
                                             const char* what)
{
    static const std::vector<std::int64_t> none;
    if (is_empty(value))
        return none;
    const auto* integers = std::get_if<Integers>(&value.data);
    if (!integers || integers->width != 0)
        mismatch(value, where, what, "a list of whole numbers");
    return integers->values;
}

/// The binary form packs flags into bits, the text form lists them one by one.
std::vector<bool> flags_of(const Value& value, const Where& where, const char* what)
{
    if (const auto* flags = std::get_if<Booleans>(&value.data))
        return *flags;
    std::vector<bool> flags;
    for (const Value& one : list_of(value, where, what))
        flags.push_back(flag_of(one, where, what));
    return flags;
}

bool is_empty(const Value& value)
{
    const List* list = std::get_if<List>(&value.data);
    return list && list->empty();
}

} // namespace vdb_shell::houdini
