// SPDX-License-Identifier: Apache-2.0

// Words to a line for a shell, and a line to words. Between single quotes a shell reads every
// character as itself, so that is how each word is written whose characters are not all harmless.

#include "command/shell_words.h"

#include "vdb_shell/core/error.h"

#include <cctype>

namespace vdb_shell::command
{
namespace
{

bool is_harmless(char c)
{
    static const std::string signs = "_-./=,:+@%";
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || signs.find(c) != std::string::npos;
}

class LineReader
{
public:
    LineReader(const std::string& line, const std::string& place) : line_(line), place_(place) {}

    std::vector<std::string> read()
    {
        for (; at_ < line_.size(); ++at_)
            take(line_[at_]);
        end_word();
        return std::move(words_);
    }

private:
    void take(char c)
    {
        if (c == ' ' || c == '\t' || c == '\r') {
            end_word();
            return;
        }
        // A word may be empty, as '' is: it counts from its first character on, and not by its
        // length.
        in_word_ = true;
        if (c == '\'' || c == '"')
            take_quoted(c);
        else if (c == '\\' && at_ + 1 < line_.size())
            word_ += line_[++at_];
        else
            word_ += c;
    }

    /// Between double quotes a backslash has its meaning before these four only.
    void take_quoted(char quote)
    {
        const std::size_t begin = at_++;
        for (; at_ < line_.size() && line_[at_] != quote; ++at_) {
            const char next = at_ + 1 < line_.size() ? line_[at_ + 1] : '\0';
            const bool escapes = quote == '"' && line_[at_] == '\\' &&
                                 (next == '"' || next == '\\' || next == '$' || next == '`');
            // A backslash before anything else stays, as in a shell.
            word_ += line_[escapes ? ++at_ : at_];
        }
        if (at_ >= line_.size())
            throw InvalidOption(place_ + ": the quote at character " + std::to_string(begin + 1) +
                                " does not end");
    }

    void end_word()
    {
        if (in_word_)
            words_.push_back(std::move(word_));
        word_.clear();
        in_word_ = false;
    }

    const std::string& line_;
    const std::string& place_;
    std::size_t at_ = 0;
    bool in_word_ = false;
    std::string word_;
    std::vector<std::string> words_;
};

} // namespace

std::string quoted(const std::string& word)
{
    bool harmless = !word.empty();
    for (const char c : word)
        harmless = harmless && is_harmless(c);
    if (harmless)
        return word;
    std::string text = "'";
    for (const char c : word)
        // Between single quotes nothing stands for a single quote: the quotes end, a quote with a
        // backslash follows, and they begin again.
        text += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return text + "'";
}

std::vector<std::string> split_words(const std::string& line, const std::string& place)
{
    return LineReader(line, place).read();
}

} // namespace vdb_shell::command
