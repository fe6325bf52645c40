// SPDX-License-Identifier: Apache-2.0
#include "options/shown_text.h"
#include "vdb_shell/core/error.h"
#include "vdb_shell/options/option.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <optional>
#include <string>

namespace vdb_shell::test
{

enum class Colour { red, green };
static const NameTable<Colour>& names(Colour)
{
    static const NameTable<Colour> table{{"red", Colour::red}, {"green", Colour::green}};
    return table;
}

namespace
{

struct Fields {
    double length = 3;
    std::optional<double> depth;
    double share = 0.5;
    int rounds = 2;
    std::uint64_t most = 5;
    bool wanted = true;
    Colour colour = Colour::red;
};

OptionList describe(Fields& f)
{
    return in_group(
        "Group",
        {option("length", f.length, "--length", "").in(Unit::world_length),
         option("depth", f.depth, "--depth", "").in(Unit::world_length).within(above(0)),
         option("share", f.share, "--share", "").in(Unit::share).within(at_least(0).below(1)),
         option("rounds", f.rounds, "--rounds", "").within(at_least(1)),
         option("most", f.most, "--most", ""), option("wanted", f.wanted, "--wanted", ""),
         option("colour", f.colour, "--colour", "")});
}

/// What is said of the text as a value of the flag; "accepted" if nothing.
std::string said_of(const std::string& flag, const std::string& text)
{
    Fields fields;
    OptionList options = describe(fields);
    try {
        assign_text(*find_by_flag(options, flag), text, flag);
    } catch (const InvalidOption& error) {
        return error.what();
    }
    return "accepted";
}

TEST(Option, RangesAreInWords)
{
    EXPECT_EQ(at_least(1).at_most(250).text(), "1 to 250");
    EXPECT_EQ(above(0).text(), "above 0");
    EXPECT_EQ(above(0).at_most(1).text(), "above 0 and at most 1");
    EXPECT_EQ(at_least(0).below(1).text(), "0 or more and less than 1");
    EXPECT_EQ(Range().text(), "");
}

TEST(Option, RangesHoldTheirBoundsUnlessExcluded)
{
    EXPECT_TRUE(at_least(0).holds(0) && at_least(0).at_most(1).holds(1));
    EXPECT_FALSE(above(0).holds(0) || at_least(0).below(1).holds(1));
    for (const double never : {double(NAN), double(INFINITY), -double(INFINITY)})
        EXPECT_FALSE(Range().holds(never) || at_least(0).holds(never)) << never;
}

TEST(Option, TextIsTakenForWhatItSays)
{
    Fields fields;
    OptionList options = describe(fields);
    for (const auto& [flag, text] : {std::pair<std::string, std::string>{"--length", "1e-3"},
                                     {"--depth", "2"},
                                     {"--rounds", "7"},
                                     {"--most", "18446744073709551615"},
                                     {"--wanted", "false"},
                                     {"--colour", "green"}})
        assign_text(*find_by_flag(options, flag), text, flag);
    EXPECT_EQ(fields.length, 1e-3);
    EXPECT_EQ(fields.depth, 2.0);
    EXPECT_EQ(fields.rounds, 7);
    EXPECT_EQ(fields.most, UINT64_MAX);
    EXPECT_FALSE(fields.wanted);
    EXPECT_EQ(fields.colour, Colour::green);
}

TEST(Option, WhatIsImpossibleIsRefusedByTheNameGiven)
{
    EXPECT_EQ(said_of("--depth", "-1"), "--depth is -1, must be above 0");
    EXPECT_EQ(said_of("--share", "1"), "--share is 1, must be 0 or more and less than 1");
    EXPECT_EQ(said_of("--rounds", "0"), "--rounds is 0, must be 1 or more");
    EXPECT_EQ(said_of("--rounds", "1.5"), "--rounds is 1.5, must be a whole number, 1 or more");
    EXPECT_EQ(said_of("--most", "-1"), "--most is -1, must be a whole number, 0 or more");
    EXPECT_EQ(said_of("--length", "nan"), "--length is nan, must be a finite number");
    EXPECT_EQ(said_of("--length", "3x"), "--length is 3x, must be a finite number");
    EXPECT_EQ(said_of("--length", ""), "--length is , must be a finite number");
    EXPECT_EQ(said_of("--colour", "blue"), "--colour is blue, must be one of red, green");
    for (const char* large : {"2147483648", "99999999999999999999"})
        EXPECT_EQ(said_of("--rounds", large), std::string("--rounds is ") + large +
                                                  ", must be 1 or more and at most 2147483647");
    EXPECT_EQ(said_of("--most", "18446744073709551616"),
              "--most is 18446744073709551616, must be at most 18446744073709551615");
    for (const char* none : {"inf", "0,1"})
        EXPECT_EQ(said_of("--depth", none),
                  std::string("--depth is ") + none + ", must be a finite number, above 0");
    // A message goes to a terminal, and a value may be a whole file.
    EXPECT_EQ(said_of("--colour", "\x1b[2J"), "--colour is ?[2J, must be one of red, green");
    EXPECT_LT(said_of("--colour", std::string(400000, 'x')).size(), 200u);
}

TEST(Option, ARefusedValueLeavesTheFieldAlone)
{
    Fields fields;
    OptionList options = describe(fields);
    EXPECT_THROW(assign(*find_by_flag(options, "--share"), 2.0, "x"), InvalidOption);
    EXPECT_THROW(assign(*find_by_flag(options, "--most"), std::int64_t(-1), "x"), InvalidOption);
    EXPECT_THROW(assign(*find_by_flag(options, "--most"), OptionValue(), "x"), InvalidOption);
    EXPECT_EQ(fields.share, 0.5);
    EXPECT_EQ(fields.most, 5u);
}

TEST(Option, WholeNumbersMayHaveAPoint)
{
    Fields fields;
    OptionList options = describe(fields);
    assign(*find_by_flag(options, "--rounds"), 7.0, "x");
    assign(*find_by_flag(options, "--most"), 9.0, "x");
    EXPECT_EQ(fields.rounds, 7);
    EXPECT_EQ(fields.most, 9u);
    for (const double none : {7.5, 1e300, double(NAN), double(INFINITY)})
        EXPECT_THROW(assign(*find_by_flag(options, "--rounds"), none, "x"), InvalidOption) << none;
    EXPECT_THROW(assign(*find_by_flag(options, "--most"), -1.0, "x"), InvalidOption);
    EXPECT_EQ(fields.rounds, 7);
}

TEST(Option, TextOfFilesIsCutWhereACharacterEnds)
{
    EXPECT_EQ(shown("caf\xc3\xa9\x1b\x7f\n\xc2\x9b"), "caf\xc3\xa9????");
    EXPECT_EQ(shown_lines("a\nb\t"), "a\nb?");
    EXPECT_EQ(shown_in_part("abc", 3), "abc");
    EXPECT_EQ(shown_in_part("ab\xe2\x82\xac-", 4), "ab...");
    EXPECT_EQ(shown_in_part("ab\xe2\x82\xac-", 5), "ab\xe2\x82\xac...");
}

TEST(Option, FieldsSetInTheProgramAreRefusedByTheirOwnNames)
{
    Fields fields;
    fields.depth = NAN;
    try {
        require_in_range(fields, "stage");
        FAIL() << "nothing was refused";
    } catch (const InvalidOption& error) {
        EXPECT_STREQ(error.what(), "stage: depth is nan, must be finite and above 0");
    }
    fields.depth.reset();
    EXPECT_NO_THROW(require_in_range(fields, "stage"));
}

TEST(Option, LengthsAreDividedAndNothingElse)
{
    Fields fields;
    fields.depth = 5;
    OptionList options = describe(fields);
    divide_lengths(options, 4);
    EXPECT_EQ(fields.length, 0.75);
    EXPECT_EQ(fields.depth, 1.25);
    EXPECT_EQ(fields.share, 0.5);
    EXPECT_EQ(fields.rounds, 2);
    fields.depth.reset();
    divide_lengths(options, 4);
    EXPECT_FALSE(fields.depth);
}

} // namespace
} // namespace vdb_shell::test
