// SPDX-License-Identifier: Apache-2.0

// Reads Houdini's binary JSON into a tree. The format is a mark, then values, each a byte of kind
// and what that kind asks for; docs/houdini.md has the table, which was made from public facts and
// held against files that Houdini wrote. The input is not trusted: no length is believed before the
// bytes for it are seen to be there, so the memory taken is a bounded multiple of the size of the
// file, and every fault is told with the byte at which it was met. Nesting is not recursion here:
// the parts go to TreeBuilder one by one, so a deep file cannot overflow the stack.

#include "json_read.h"

#include "binary_kinds.h"
#include "vdb_shell/io/read_file.h"

#include <openvdb/Types.h>

#include <algorithm>
#include <cstring>
#include <string_view>
#include <unordered_map>

namespace vdb_shell::houdini
{
namespace
{

/// Reads the document part by part. Every length is held against the bytes that are left before
/// memory is taken for it.
class Parser
{
public:
    Parser(const std::string& name, const std::string& bytes)
        : name_(name), bytes_(bytes), tree_(name)
    {
        const std::string_view mark = std::string_view(bytes).substr(0, kBinaryMark.size());
        if (mark != kBinaryMark && mark != kSwappedMark)
            refuse(name, "it does not begin with the mark of binary JSON");
        // The file's byte order shows in its mark, the machine's in the first byte of a 1. Numbers
        // are turned round if the two differ.
        const std::uint16_t one = 1;
        const bool little_host = *reinterpret_cast<const unsigned char*>(&one) == 1;
        swap_ = (mark == kBinaryMark) != little_host;
        at_ = mark.size();
    }

    Value parse()
    {
        while (!tree_.complete())
            take_part();
        // Bytes behind the end mean that a length was damaged, so what was read before is not to be
        // trusted either.
        if (at_ != bytes_.size())
            fail(std::to_string(bytes_.size() - at_) + " bytes follow the end of the document");
        return tree_.take();
    }

private:
    [[noreturn]] void fail(const std::string& what) const
    {
        refuse(name_, "byte " + std::to_string(at_) + ": " + what);
    }

    std::size_t left() const { return bytes_.size() - at_; }

    /// Before anything is allocated: `count` elements of `size` bytes must be there. It divides
    /// instead of multiplying, because the product of a damaged count could wrap.
    void require_bytes(std::uint64_t count, std::size_t size, const char* what) const
    {
        if (count > left() / size)
            fail(std::string(what) + " of " + std::to_string(count) + " elements of " +
                 std::to_string(size) + " bytes, but only " + std::to_string(left()) +
                 " bytes are left");
    }

    template <typename T> T number()
    {
        require_bytes(1, sizeof(T), "a number");
        // Copied by bytes: numbers stand at any address, and reading one through a pointer to its
        // type would be undefined.
        char raw[sizeof(T)];
        std::memcpy(raw, bytes_.data() + at_, sizeof(T));
        if (swap_)
            std::reverse(raw, raw + sizeof(T));
        at_ += sizeof(T);
        T value;
        std::memcpy(&value, raw, sizeof(T));
        return value;
    }

    double half()
    {
        openvdb::math::half value;
        value.setBits(number<std::uint16_t>());
        return static_cast<double>(static_cast<float>(value));
    }

    /// A byte, or a byte that says how many of the following bytes are the length.
    std::uint64_t length()
    {
        const auto first = number<std::uint8_t>();
        if (first < kLengths)
            return first;
        if (first == kLength16)
            return number<std::uint16_t>();
        if (first == kLength32)
            return number<std::uint32_t>();
        if (first == kLength64)
            return number<std::uint64_t>();
        // Back to the byte that is wrong, which the message names.
        --at_;
        fail("a length of the unknown kind " + std::to_string(first));
    }

    Text text()
    {
        const std::uint64_t size = length();
        require_bytes(size, 1, "a string");
        auto made =
            std::make_shared<const std::string>(bytes_, at_, static_cast<std::size_t>(size));
        at_ += static_cast<std::size_t>(size);
        return made;
    }

    /// Strings that come often are defined once and then named by a number. The text is shared, not
    /// copied: two bytes can stand for a megabyte, and a file could repeat them at will.
    Text token()
    {
        const std::uint64_t id = length();
        const auto found = tokens_.find(id);
        if (found == tokens_.end())
            fail("the token " + std::to_string(id) + " is not defined");
        return found->second;
    }

    template <typename Stored, typename Wide> Value array(std::uint64_t count)
    {
        require_bytes(count, sizeof(Stored), "an array");
        Numbers<Wide> numbers;
        numbers.values.reserve(static_cast<std::size_t>(count));
        for (std::uint64_t i = 0; i < count; ++i)
            numbers.values.push_back(static_cast<Wide>(number<Stored>()));
        // An empty array becomes an empty list: the text form cannot tell the two apart, and
        // readers of the tree should see the same from both forms.
        return count ? Value{std::move(numbers)} : Value{List{}};
    }

    Value halves(std::uint64_t count)
    {
        require_bytes(count, sizeof(std::uint16_t), "an array");
        Reals numbers;
        numbers.values.reserve(static_cast<std::size_t>(count));
        for (std::uint64_t i = 0; i < count; ++i)
            numbers.values.push_back(half());
        return count ? Value{std::move(numbers)} : Value{List{}};
    }

    /// A bit each, in words of 32. The lowest bit of a word comes first. Rounding the number of
    /// words up is done without adding to the count, which could wrap.
    Value flags(std::uint64_t count)
    {
        constexpr unsigned kBits = 32;
        require_bytes(count / kBits + (count % kBits != 0), sizeof(std::uint32_t), "an array");
        Booleans made;
        made.reserve(static_cast<std::size_t>(count));
        std::uint32_t word = 0;
        for (std::uint64_t i = 0; i < count; ++i) {
            if (i % kBits == 0)
                word = number<std::uint32_t>();
            made.push_back((word >> (i % kBits)) & 1u);
        }
        return {std::move(made)};
    }

    Value texts(std::uint64_t count)
    {
        // Each text has a length of one byte at least, so a count beyond the bytes that are left is
        // false.
        require_bytes(count, 1, "an array");
        List made;
        for (std::uint64_t i = 0; i < count; ++i)
            made.push_back({text()});
        return {std::move(made)};
    }

    /// An array of one kind of value, whose kind is said once.
    Value uniform()
    {
        const auto kind = static_cast<Kind>(number<std::uint8_t>());
        const std::uint64_t count = length();
        switch (kind) {
        case Kind::boolean:
            return flags(count);
        case Kind::int8:
            return array<std::int8_t, std::int64_t>(count);
        case Kind::int16:
            return array<std::int16_t, std::int64_t>(count);
        case Kind::int32:
            return array<std::int32_t, std::int64_t>(count);
        case Kind::int64:
            return array<std::int64_t, std::int64_t>(count);
        case Kind::uint8:
            return array<std::uint8_t, std::int64_t>(count);
        case Kind::uint16:
            return array<std::uint16_t, std::int64_t>(count);
        case Kind::real16:
            return halves(count);
        case Kind::real32:
            return array<float, double>(count);
        case Kind::real64:
            return array<double, double>(count);
        case Kind::text:
            return texts(count);
        default:
            fail("an array of the unknown kind " + std::to_string(static_cast<int>(kind)));
        }
    }

    // Integers of all widths become int64 and reals become double, which hold each of them exactly;
    // what the attribute is stored as is said elsewhere in the document.
    void take_number(Kind kind)
    {
        switch (kind) {
        case Kind::int8:
            return tree_.integer(number<std::int8_t>());
        case Kind::int16:
            return tree_.integer(number<std::int16_t>());
        case Kind::int32:
            return tree_.integer(number<std::int32_t>());
        case Kind::int64:
            return tree_.integer(number<std::int64_t>());
        case Kind::uint8:
            return tree_.integer(number<std::uint8_t>());
        case Kind::uint16:
            return tree_.integer(number<std::uint16_t>());
        case Kind::real16:
            return tree_.real(half());
        case Kind::real32:
            return tree_.real(static_cast<double>(number<float>()));
        case Kind::real64:
            return tree_.real(number<double>());
        default:
            --at_;
            fail("a value of the unknown kind " + std::to_string(static_cast<int>(kind)));
        }
    }

    // Only a reference is a value. A definition and its removal stand between values without being
    // one, even between a key and its value.
    void take_token(Kind kind)
    {
        if (kind == Kind::token_ref)
            return tree_.add({token()});
        const std::uint64_t id = length();
        if (kind == Kind::token_undef)
            tokens_.erase(id);
        else
            tokens_[id] = text();
    }

    void take_part()
    {
        const auto kind = static_cast<Kind>(number<std::uint8_t>());
        switch (kind) {
        case Kind::list_begin:
            return tree_.open_list();
        case Kind::list_end:
            return tree_.close_list();
        case Kind::map_begin:
            return tree_.open_map();
        case Kind::map_end:
            return tree_.close_map();
        case Kind::token_def:
        case Kind::token_ref:
        case Kind::token_undef:
            return take_token(kind);
        case Kind::text:
            return tree_.add({text()});
        case Kind::null:
            return tree_.add({});
        case Kind::no:
        case Kind::yes:
            return tree_.add({kind == Kind::yes});
        case Kind::boolean:
            return tree_.add({number<std::uint8_t>() != 0});
        case Kind::uniform:
            return tree_.add(uniform());
        default:
            return take_number(kind);
        }
    }

    const std::string& name_;
    const std::string& bytes_;
    TreeBuilder tree_;
    std::unordered_map<std::uint64_t, Text> tokens_;
    std::size_t at_ = 0;
    bool swap_ = false;
};

} // namespace

Value read_json_binary(const std::string& name, const std::string& bytes)
{
    return Parser(name, bytes).parse();
}

} // namespace vdb_shell::houdini
