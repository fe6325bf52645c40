// SPDX-License-Identifier: Apache-2.0

// Reads JSON text into the same tree as the binary form. The grammar is that of nlohmann's parser,
// by its interface of events: its own tree would have a tagged value for each number and a vector
// of its own for each position, and positions are most of the file. Errors are told with line and
// column, which this interface does not give.

#include "json_read.h"

#include "vdb_shell/io/read_file.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <limits>
#include <string_view>

namespace vdb_shell::houdini
{
namespace
{

using nlohmann::json;

/// Takes the document part by part as nlohmann's parser meets them: no tree of its is ever made.
class Receiver
{
public:
    Receiver(const std::string& name, const std::string& bytes)
        : name_(name), bytes_(bytes), tree_(name)
    {
    }
    bool null() { return add({}); }
    bool boolean(bool value) { return add({value}); }
    bool number_integer(std::int64_t value) { return add({value}); }
    bool number_unsigned(std::uint64_t value)
    {
        // All integers of the tree are signed, as are all that Houdini stores; wrapping one into a
        // negative number would pass for an index.
        constexpr std::uint64_t kMost = std::numeric_limits<std::int64_t>::max();
        if (value > kMost)
            refuse(name_, "the number " + std::to_string(value) + " is beyond 64 signed bits");
        return add({static_cast<std::int64_t>(value)});
    }
    bool number_float(double value, const std::string&) { return add({value}); }
    bool string(std::string& value) { return add({std::make_shared<const std::string>(value)}); }
    // No text can bring this event: it is for the binary formats of the library.
    bool binary(json::binary_t&) { return false; }
    bool start_object(std::size_t)
    {
        tree_.open_map();
        return true;
    }
    bool key(std::string& value) { return string(value); }
    bool end_object()
    {
        tree_.close_map();
        return true;
    }
    bool start_array(std::size_t)
    {
        tree_.open_list();
        return true;
    }
    bool end_array()
    {
        tree_.close_list();
        return true;
    }
    template <typename Problem>
    bool parse_error(std::size_t at, const std::string& read, const Problem& problem)
    {
        // The library's text opens with a number of its own, which means nothing to users, and ends
        // in what the parser expected, which does.
        const std::string_view what = problem.what();
        const std::size_t colon = what.find(": ");
        refuse(name_, place(at) + ": " +
                          std::string(what.substr(colon == what.npos ? 0 : colon + 2)) + " (at " +
                          vdb_shell::quoted(read) + ")");
    }
    Value take() { return tree_.take(); }

private:
    bool add(Value value)
    {
        tree_.add(std::move(value));
        return true;
    }
    // The position is counted only when there is an error, so sound files pay nothing for it. The
    // parser counts bytes from 1, and so do columns here.
    std::string place(std::size_t at) const
    {
        const std::string_view before = std::string_view(bytes_).substr(0, at ? at - 1 : 0);
        const auto lines = std::count(before.begin(), before.end(), '\n');
        const std::size_t start = before.rfind('\n');
        const std::size_t column = start == before.npos ? before.size() : before.size() - start - 1;
        return "line " + std::to_string(lines + 1) + ", column " + std::to_string(column + 1);
    }
    const std::string& name_;
    const std::string& bytes_;
    TreeBuilder tree_;
};

} // namespace

Value read_json_text(const std::string& name, const std::string& bytes)
{
    Receiver receiver(name, bytes);
    json::sax_parse(bytes, &receiver);
    return receiver.take();
}

} // namespace vdb_shell::houdini
