// SPDX-License-Identifier: Apache-2.0

// Takes what a user writes for frames and names of files; leaves numbers and names. People come
// from several programs, so every one of their ways to write a range and a token is understood
// where no two of them contradict each other. A step is written with x or with a colon: OpenCue
// reads the colon as another order of all frames, Slurm and Open Job Description as a step, which
// is what it is here.

#include "command/frames.h"

#include "vdb_shell/core/error.h"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <unordered_set>
#include <utility>

namespace vdb_shell::command
{
namespace
{

/// More are a slip of the finger: at a tenth of a second each they are a day.
constexpr std::size_t kMostFrames = 1000000;
/// Nine digits, so that no sum of two frames leaves an int.
constexpr std::int64_t kLargestFrame = 999999999;

bool is_digit(char c)
{
    return c >= '0' && c <= '9';
}

/// Goes through the text from left to right; blanks between the parts are passed over.
class RangeReader
{
public:
    RangeReader(const std::string& text, const std::string& flag) : text_(text), flag_(flag) {}

    FrameList read()
    {
        do
            read_part();
        while (take(","));
        if (place_ < text_.size())
            refuse("expected \",\", \"-\", \"x\" or \":\"");
        return std::move(list_);
    }

private:
    [[noreturn]] void refuse(const std::string& why) const
    {
        const std::string where = place_ < text_.size()
                                      ? "at character " + std::to_string(place_ + 1) + ", \"" +
                                            text_.substr(place_) + "\", "
                                      : "at its end ";
        throw InvalidOption(flag_ + " is \"" + text_ + "\": " + where + why);
    }

    void pass_blanks()
    {
        while (place_ < text_.size() && text_[place_] == ' ')
            ++place_;
    }

    bool take(const char* one_of)
    {
        pass_blanks();
        const std::string known = one_of;
        if (place_ >= text_.size() || known.find(text_[place_]) == std::string::npos)
            return false;
        ++place_;
        return true;
    }

    int read_number(const char* what)
    {
        pass_blanks();
        const std::size_t begin = place_;
        std::int64_t value = 0;
        const char* first = text_.data() + begin;
        const auto [end, error] = std::from_chars(first, text_.data() + text_.size(), value);
        if (error == std::errc::invalid_argument)
            refuse(std::string("expected ") + what);
        if (error != std::errc() || value > kLargestFrame || value < -kLargestFrame)
            refuse("frames and steps have at most nine digits");
        place_ = begin + std::size_t(end - first);
        return static_cast<int>(value);
    }

    void read_part()
    {
        const int first = read_number("the number of a frame");
        if (!take("-"))
            return add(first);
        const int last = read_number("the last frame of the range");
        int step = last < first ? -1 : 1;
        pass_blanks();
        const std::size_t begin = place_;
        if (take("x:")) {
            // Messages name the step from its sign on, so the place goes back there. When it is
            // found right it is read once more, to get behind it.
            const int given = read_number("a step");
            place_ = begin;
            if (given == 0)
                refuse("a step of 0 never ends");
            if (given < 0 && last > first)
                refuse("a step downwards does not lead from " + std::to_string(first) + " to " +
                       std::to_string(last));
            // The two ends of the range say which way it goes: 10-1x3 and 10-1x-3 are the same.
            step *= std::abs(given);
            take("x:");
            read_number("a step");
        }
        for (int frame = first; step > 0 ? frame <= last : frame >= last; frame += step)
            add(frame);
    }

    void add(int frame)
    {
        // Left out and noted, as the outputs of the two would be the same files.
        if (!known_.insert(frame).second) {
            if (told_.insert(frame).second)
                list_.repeated.push_back(frame);
            return;
        }
        if (list_.frames.size() == kMostFrames)
            refuse("more than a million frames");
        list_.frames.push_back(frame);
    }

    const std::string& text_;
    const std::string& flag_;
    std::size_t place_ = 0;
    FrameList list_;
    std::unordered_set<int> known_, told_;
};

struct Token {
    std::size_t begin = 0, length = 0;
    int width = 0; ///< digits, at least
};

/// Digits from there on; -1 where there are none, or more than three.
int digits_at(const std::string& text, std::size_t& at)
{
    const std::size_t begin = at;
    while (at < text.size() && is_digit(text[at]))
        ++at;
    constexpr std::size_t kMostDigits = 3;
    if (at == begin || at - begin > kMostDigits)
        return -1;
    return std::atoi(text.substr(begin, at - begin).c_str());
}

/// %d and %04d. What fills up with blanks is no name of a file.
std::optional<Token> printf_token(const std::string& text, std::size_t begin)
{
    std::size_t at = begin + 1;
    int width = 0;
    if (at < text.size() && text[at] == '0')
        width = digits_at(text, at);
    if (width < 0 || at >= text.size() || text[at] != 'd')
        return std::nullopt;
    return Token{begin, at + 1 - begin, width};
}

/// $F, $F4, ${F4}; $FF and $FEND are other variables.
std::optional<Token> variable_token(const std::string& text, std::size_t begin)
{
    const bool braces = text.compare(begin + 1, 1, "{") == 0;
    std::size_t at = begin + (braces ? 2 : 1);
    if (at >= text.size() || text[at] != 'F')
        return std::nullopt;
    const int width = std::max(digits_at(text, ++at), 0);
    const char next = at < text.size() ? text[at] : '\0';
    if (braces)
        return next == '}' ? std::optional(Token{begin, at + 1 - begin, width}) : std::nullopt;
    const bool longer_name =
        next == '_' || (next >= 'a' && next <= 'z') || (next >= 'A' && next <= 'Z');
    return longer_name ? std::nullopt : std::optional(Token{begin, at - begin, width});
}

/// The first token at `from` or behind it. All ways to write one are looked for, and none can be
/// read as another.
std::optional<Token> next_token(const std::string& path, std::size_t from)
{
    // Folders may well be named after people and places: me@there, take#2.
    const std::size_t slash = path.rfind('/');
    const std::size_t name = slash == std::string::npos ? 0 : slash + 1;
    for (std::size_t at = from; at < path.size(); ++at) {
        const char c = path[at];
        std::optional<Token> token;
        if (c == '%')
            token = printf_token(path, at);
        else if (c == '$')
            token = variable_token(path, at);
        else if ((c == '#' || c == '@') && at >= name) {
            const std::size_t end = std::min(path.find_first_not_of(c, at), path.size());
            token = Token{at, end - at, static_cast<int>(end - at)};
        }
        if (token)
            return token;
    }
    return std::nullopt;
}

/// A minus counts as one of the digits, as for printf.
std::string padded(int frame, int width)
{
    std::string digits = std::to_string(std::abs(frame));
    const std::size_t wanted = std::size_t(std::max(width - (frame < 0 ? 1 : 0), 0));
    if (digits.size() < wanted)
        digits.insert(0, wanted - digits.size(), '0');
    return (frame < 0 ? "-" : "") + digits;
}

} // namespace

FrameList parse_frames(const std::string& text, const std::string& flag)
{
    return RangeReader(text, flag).read();
}

/// From left to right, each part as long as it goes. So the text is the same for the same list,
/// which names of files rely on (farm_openjd.cpp).
std::string frames_text(const std::vector<int>& frames)
{
    std::string text;
    for (std::size_t begin = 0; begin < frames.size();) {
        std::size_t end = begin + 1;
        const int step = end < frames.size() ? frames[end] - frames[begin] : 0;
        // A frame and itself are no range: "5-5x0" would be refused.
        while (step != 0 && end < frames.size() && frames[end] - frames[end - 1] == step)
            ++end;
        // Two of them are a range only where they are neighbours: "1-2", but "1,9".
        if (end - begin == 2 && std::abs(step) != 1)
            --end;
        text += (text.empty() ? "" : ",") + std::to_string(frames[begin]);
        if (end - begin > 1)
            text += "-" + std::to_string(frames[end - 1]);
        if (end - begin > 1 && std::abs(step) != 1)
            text += "x" + std::to_string(step);
        begin = end;
    }
    return text;
}

std::string frame_token(const std::string& path)
{
    const std::optional<Token> token = next_token(path, 0);
    return token ? path.substr(token->begin, token->length) : "";
}

std::string with_frame(const std::string& path, int frame)
{
    std::string name;
    std::size_t done = 0;
    while (const std::optional<Token> token = next_token(path, done)) {
        name += path.substr(done, token->begin - done) + padded(frame, token->width);
        done = token->begin + token->length;
    }
    return name + path.substr(done);
}

} // namespace vdb_shell::command
