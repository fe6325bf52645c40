// SPDX-License-Identifier: Apache-2.0
#pragma once

// A JSON document in memory, compact enough for geometry: arrays of numbers are vectors, and equal
// rows of them are one vector. What a damaged file can make this take is a small multiple of its
// own size.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <variant>
#include <vector>

namespace vdb_shell::houdini
{

struct Value;
using List = std::vector<Value>;
/// Keys and values in turn.
struct Map {
    List items;
};
/// `width` 0: the numbers are the array's own elements. Else the array's elements are arrays of
/// `width` numbers, which stand here one after the other.
template <typename T> struct Numbers {
    std::vector<T> values;
    std::size_t width = 0;
};
using Integers = Numbers<std::int64_t>;
using Reals = Numbers<double>;
using Booleans = std::vector<bool>;
/// Shared: a binary document can refer to a long string with two bytes, over and over.
using Text = std::shared_ptr<const std::string>;

struct Value {
    std::variant<std::monostate, bool, std::int64_t, double, Text, List, Map, Integers, Reals,
                 Booleans>
        data;
};

/// In words, for messages: "a list of 3", "the number 7".
std::string describe(const Value& value);

/// Puts a document together from its parts in their order. Throws ReadError "name: ..." for
/// nesting beyond kDeepest and for ends that do not belong to the innermost open container.
class TreeBuilder
{
public:
    static constexpr std::size_t kDeepest = 64;

    explicit TreeBuilder(const std::string& name) : name_(name) {}
    void add(Value value); ///< anything but a container that is still open
    void integer(std::int64_t value);
    void real(double value);
    void open_list();
    void open_map();
    void close_list();
    void close_map();
    /// True when the document is complete: its outermost value has been closed.
    bool complete() const { return complete_; }
    Value take() { return std::move(root_); }

private:
    void open(Value container);
    void close(bool map);
    void finish(Value value);
    std::string name_;
    std::vector<Value> open_;
    Value root_;
    bool complete_ = false;
};

} // namespace vdb_shell::houdini
