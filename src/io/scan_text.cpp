// SPDX-License-Identifier: Apache-2.0

// Numbers, words and lines of text files, the same for all formats. Numbers are parsed by
// std::from_chars: it does not look at the locale, it rounds correctly, and it takes all of a word
// or tells where it stopped. It also takes "nan" and "inf", has one error for too large and too
// small, and takes no plus sign; each of these is seen to below. A number too small for float32 is
// 0; one too large is refused, because infinity would spread through all that is computed from it.
// Words are views into the file's bytes, nothing is copied.

#include "io/scan_text.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>

namespace vdb_shell
{
namespace
{

/// Space, or one of \t \n \v \f \r, which follow each other.
bool is_blank(char c)
{
    return c == ' ' || (c >= '\t' && c <= '\r');
}

[[noreturn]] void refuse_infinite(const std::string& name, const Place& place,
                                  const std::string& value)
{
    refuse(name, place.text() + ": the coordinate " + value + " is not finite in float32 (limit " +
                     "3.4028235e38" + ")");
}

bool names_no_finite_number(std::string_view word)
{
    if (!word.empty() && (word[0] == '-' || word[0] == '+'))
        word.remove_prefix(1);
    // Three letters are enough, so "infinity" and "nan(0x7fffff)" are found too.
    const std::string_view start = word.substr(0, 3);
    return equal_ignoring_case(start, "nan") || equal_ignoring_case(start, "inf");
}

/// from_chars says "out of range" for what is too large and for what is too small to be a float.
bool is_tiny(std::string_view digits)
{
    double value = 0;
    const auto parsed = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    // If the number is beyond a double too, the sign of its exponent tells on which side.
    if (parsed.ec == std::errc())
        return std::abs(value) < 1.0;
    return digits.find("e-") != digits.npos || digits.find("E-") != digits.npos;
}

} // namespace

std::string Place::text() const
{
    return std::string(what) + " " + std::to_string(index) +
           (line == 0 ? "" : " (line " + std::to_string(line) + ")");
}

float parse_coordinate(const std::string& name, const Place& place, std::string_view word)
{
    if (names_no_finite_number(word))
        refuse_infinite(name, place, quoted(word));
    // std::from_chars takes no plus sign, which other programs write.
    std::string_view digits = word;
    if (digits.size() > 1 && digits[0] == '+' && digits[1] != '-')
        digits.remove_prefix(1);
    float value = 0;
    const char* const end = digits.data() + digits.size();
    const auto parsed = std::from_chars(digits.data(), end, value);
    if (parsed.ec == std::errc::invalid_argument || parsed.ptr != end)
        refuse(name, place.text() + ": " + quoted(word) + " is not a number");
    if (parsed.ec == std::errc::result_out_of_range) {
        if (!is_tiny(digits))
            refuse_infinite(name, place, quoted(word));
        // The sign stays, as correct rounding has it.
        return digits[0] == '-' ? -0.0F : 0.0F;
    }
    return value;
}

float checked_coordinate(const std::string& name, const Place& place, double value)
{
    // The first double that rounds to infinity: halfway between the largest float and the next
    // power of two, where a tie goes to the even neighbour, which is that power. Written so that
    // the test also refuses what is not a number.
    constexpr double kLimit = 0x1.ffffffp127;
    if (!(std::abs(value) < kLimit))
        refuse_infinite(name, place, std::to_string(value));
    return static_cast<float>(value);
}

std::int64_t parse_integer(const std::string& name, const Place& place, std::string_view word)
{
    std::string_view digits = word;
    if (digits.size() > 1 && digits[0] == '+' && digits[1] != '-')
        digits.remove_prefix(1);
    std::int64_t value = 0;
    const char* const end = digits.data() + digits.size();
    const auto parsed = std::from_chars(digits.data(), end, value);
    if (parsed.ec != std::errc() || parsed.ptr != end)
        refuse(name, place.text() + ": " + quoted(word) + " is not a whole number");
    return value;
}

namespace
{

/// The first place from `begin` on where is_end(character) holds; the size where none is.
/// std::string_view's own search calls a function for every character.
template <typename IsEnd>
std::size_t find_end(std::string_view text, std::size_t begin, const IsEnd& is_end)
{
    while (begin < text.size() && !is_end(text[begin]))
        ++begin;
    return begin;
}

} // namespace

bool Lines::next(std::string_view& line)
{
    if (text_.empty())
        return false;
    const std::size_t end = find_end(text_, 0, [](char c) { return c == '\n' || c == '\r'; });
    line = text_.substr(0, end);
    // Files from different systems are joined, so each line may end in its own way.
    const bool crlf = text_.substr(end, 2) == "\r\n";
    text_.remove_prefix(std::min(end + (crlf ? 2 : 1), text_.size()));
    ++number_;
    return true;
}

std::string_view cut_word(std::string_view& text)
{
    const std::size_t begin = find_end(text, 0, [](char c) { return !is_blank(c); });
    const std::size_t end = find_end(text, begin, is_blank);
    const std::string_view word = text.substr(begin, end - begin);
    text.remove_prefix(end);
    return word;
}

std::string_view without_byte_order_mark(std::string_view text)
{
    constexpr std::string_view kMark = "\xEF\xBB\xBF";
    return text.substr(0, kMark.size()) == kMark ? text.substr(kMark.size()) : text;
}

bool equal_ignoring_case(std::string_view a, std::string_view b)
{
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](unsigned char x, unsigned char y) {
        return std::tolower(x) == std::tolower(y);
    });
}

} // namespace vdb_shell
