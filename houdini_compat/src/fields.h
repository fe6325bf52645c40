// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "value.h"

#include <string>
#include <unordered_map>

namespace vdb_shell::houdini
{

/// What a message is about: the file, and the part of it.
struct Where {
    std::string file;
    std::string part; ///< "" or "point attribute \"P\""
    [[noreturn]] void fail(const std::string& what) const;
    Where inside(const std::string& more) const;
};

/// Memory that a document may take beyond its own size: a constant page, a run or a token spells
/// out what it does not store. Counts bytes; throws when there are too many for the document.
class Budget
{
public:
    static constexpr std::uint64_t kBytesPerByte = 64, kFree = 1 << 20;
    explicit Budget(std::size_t document_size) : left_(kFree + kBytesPerByte * document_size) {}
    void spend(std::uint64_t bytes, const Where& where);

private:
    std::uint64_t left_;
};

/// A map, or the flat list of keys and values in turn by which Houdini writes most maps.
class Fields
{
public:
    static constexpr std::size_t kLongestKey = 1024;
    /// Throws when `value` is no such thing, has a key twice or one that is longer than any.
    Fields(const Value& value, const Where& where);
    const Value* find(const char* key) const; ///< null when it is not there
    const Value& at(const char* key) const;
    /// By its long name or its short one.
    const Value* find(const char* key, const char* short_key) const;
    const std::vector<const std::string*>& keys() const { return keys_; }

private:
    Where where_;
    std::unordered_map<std::string, const Value*> by_key_;
    std::vector<const std::string*> keys_; ///< in their order
};

// The value as what it has to be; each throws, naming `what`, when it is something else.
const std::string& text_of(const Value& value, const Where& where, const char* what);
bool flag_of(const Value& value, const Where& where, const char* what);
/// A whole number in [0, limit].
std::size_t count_of(const Value& value, const Where& where, const char* what, std::size_t limit);
const List& list_of(const Value& value, const Where& where, const char* what);
/// A list of whole numbers; an empty one has no type.
const std::vector<std::int64_t>& integers_of(const Value& value, const Where& where,
                                             const char* what);
/// A list of flags, however it is stored.
std::vector<bool> flags_of(const Value& value, const Where& where, const char* what);
bool is_empty(const Value& value); ///< an empty list

} // namespace vdb_shell::houdini
