// SPDX-License-Identifier: Apache-2.0

// JSON of files that anybody may have written. The parser itself takes any depth, but copies and
// texts of what it makes are recursive, and a file of some hundred kilobytes would overflow the
// stack. So depth is refused while the text is parsed. Everything that is said of the text is cut,
// because the parser quotes the word at which it stopped, however long it is.

#include "options/parse_json.h"

#include "options/shown_text.h"
#include "vdb_shell/core/error.h"

#include <nlohmann/json.hpp>

namespace vdb_shell
{
namespace
{

template <typename Json>
Json parsed(const std::string& text, const std::string& name, const std::string& otherwise)
{
    const auto hold_depth = [&](int depth, typename Json::parse_event_t event, Json&) {
        const bool begins =
            event == Json::parse_event_t::array_start || event == Json::parse_event_t::object_start;
        // The outermost has the depth 0.
        if (begins && depth >= kDeepestJson)
            throw ReadError(name + ": its JSON has more than " + std::to_string(kDeepestJson) +
                            " arrays and objects inside each other");
        return true;
    };
    constexpr std::size_t kMostOfReason = 200;
    try {
        return Json::parse(text, hold_depth);
        // Numbers that no double holds are another error of the parser's than bad syntax.
    } catch (const typename Json::exception& error) {
        throw ReadError(name + ": " + otherwise + ": " +
                        shown_in_part(error.what(), kMostOfReason));
    }
}

} // namespace

nlohmann::ordered_json parse_json(const std::string& text, const std::string& name,
                                  const std::string& otherwise)
{
    return parsed<nlohmann::ordered_json>(text, name, otherwise);
}

nlohmann::json parse_json_if_any(const std::string& text)
{
    try {
        return parsed<nlohmann::json>(text, "", "");
    } catch (const ReadError&) {
        return nlohmann::json(nlohmann::json::value_t::discarded);
    }
}

} // namespace vdb_shell
