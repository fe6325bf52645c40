// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/core/error.h"
#include "vdb_shell/options/section.h"
#include "vdb_shell/pipeline.h"
#include "vdb_shell/write/view.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <optional>
#include <set>
#include <sstream>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>

// What holds for every option of the pipeline, those of tomorrow included.

namespace vdb_shell::test
{
namespace
{

/// The options of all stages, the repair's among them.
struct Described {
    ShellOptions options;
    OptionSections sections;

    Described()
    {
        options.repair.emplace();
        sections = describe(options);
    }

    template <typename Act> void for_each(const Act& act)
    {
        for (OptionSection& section : sections)
            for (Option& option : section.options)
                act(path_of(section, option), option);
    }
};

/// An allowed value that is not the one there is.
OptionValue another_value(const Option& option)
{
    if (option.kind == OptionKind::flag)
        return !std::get<bool>(option.get());
    if (option.kind == OptionKind::choice)
        return option.choices.back() == std::get<std::string>(option.get()) ? option.choices.front()
                                                                            : option.choices.back();
    if (option.kind == OptionKind::integer)
        return std::int64_t(7);
    if (option.kind == OptionKind::count)
        return std::uint64_t(1234567);
    for (const double number : {0.3125, 0.625, 4.5})
        if (option.range.holds(number) && OptionValue(number) != option.get())
            return number;
    return {};
}

TEST(ShellOptions, EveryOptionSurvivesJson)
{
    Described all;
    const std::string defaults = options_json(all.options);
    all.for_each([&](const std::string& path, Option& option) {
        const OptionValue value = another_value(option);
        assign(option, value, path);
        EXPECT_EQ(option.get(), value) << path;
    });
    const std::string json = options_json(all.options);
    EXPECT_EQ(options_json(options_from_json(json)), json);
    // Not one of the stored ones is as before.
    const auto before = nlohmann::json::parse(defaults), after = nlohmann::json::parse(json);
    all.for_each([&](const std::string& path, const Option& option) {
        std::string pointer = "/" + path;
        if (pointer.find('.') != std::string::npos)
            pointer.replace(pointer.find('.'), 1, "/");
        const nlohmann::json::json_pointer where(pointer);
        EXPECT_EQ(after.contains(where), option.stored) << path;
        if (option.stored) {
            EXPECT_NE(after.at(where), before.at(where)) << path;
        }
    });
}

TEST(ShellOptions, DefaultsAreSensible)
{
    EXPECT_NO_THROW(require_sensible(ShellOptions{}));
    EXPECT_EQ(options_json(options_from_json("{}")), options_json(ShellOptions{}));
}

TEST(ShellOptions, NoRuleForDiagonalsIsTakenWhereGrowthChoosesThem)
{
    ShellOptions options;
    options.split.rule = SplitRule::vertex_index;
    EXPECT_NO_THROW(require_sensible(options)) << "twelve tets";
    options.grow.method = Method::thickest;
    EXPECT_THROW(require_sensible(options), InvalidOption);
    options.grow.method = Method::certified;
    options.grow.prism_test = PrismTest::chosen_tets;
    EXPECT_THROW(require_sensible(options), InvalidOption);
    options.grow.method = Method::raw;
    EXPECT_NO_THROW(require_sensible(options)) << "nothing grows";
    options.grow.method = Method::thickest;
    options.split.rule = SplitRule::length_descending;
    EXPECT_NO_THROW(require_sensible(options));
}

TEST(ShellOptions, EveryValueOutOfRangeIsRefusedByFlagByKeyAndByField)
{
    std::size_t bounds = 0;
    const auto expect_refused = [&](const std::string& path, Option& option, double value) {
        const std::string text = text_of(value);
        const auto expect_names = [&](const std::string& name, const auto& act) {
            try {
                act();
                ADD_FAILURE() << name << " accepted " << text;
            } catch (const InvalidOption& error) {
                EXPECT_EQ(std::string(error.what()).rfind(name + " is " + text + ", must be", 0),
                          0u)
                    << error.what();
            }
        };
        ++bounds;
        expect_names("--flag", [&] { assign_text(option, text, "--flag"); });
        const std::size_t point = path.find('.');
        if (point == std::string::npos || value != std::floor(value))
            return;
        const std::string json = "{\"" + path.substr(0, point) + "\": {\"" +
                                 path.substr(point + 1) + "\": " + text + "}}";
        expect_names("a.json: " + path, [&] { options_from_json(json, {}, "a.json"); });
        if (option.kind == OptionKind::count)
            return; // a field without a sign cannot have the value
        Described broken;
        broken.for_each([&](const std::string& other, Option& same) {
            if (other != path)
                return;
            if (same.kind == OptionKind::integer)
                same.set(std::int64_t(value));
            else
                same.set(value);
        });
        expect_names(path.substr(0, point) + ": " + path.substr(point + 1),
                     [&] { require_sensible(broken.options); });
    };
    Described all;
    all.for_each([&](const std::string& path, Option& option) {
        if (option.range.low)
            expect_refused(path, option, *option.range.low - (option.range.low_excluded ? 0 : 1));
        if (option.range.high)
            expect_refused(path, option, *option.range.high + (option.range.high_excluded ? 0 : 1));
        if (option.kind == OptionKind::count)
            expect_refused(path, option, -1);
    });
    EXPECT_GT(bounds, 40u);
}

/// Bounds are shown with six digits, and who types one of these is within.
TEST(ShellOptions, EveryBoundIsTakenAsItIsShown)
{
    std::size_t bounds = 0;
    const auto expect_taken = [&](Option& option, double bound) {
        std::ostringstream shown;
        shown << bound;
        EXPECT_NE(option.range.text().find(shown.str()), std::string::npos) << option.range.text();
        EXPECT_NO_THROW(assign_text(option, shown.str(), option.flag));
        ++bounds;
    };
    const auto expect_bounds_taken = [&](Option& option) {
        if (option.range.low && !option.range.low_excluded)
            expect_taken(option, *option.range.low);
        if (option.range.high && !option.range.high_excluded)
            expect_taken(option, *option.range.high);
    };
    Described all;
    all.for_each([&](const std::string&, Option& option) { expect_bounds_taken(option); });
    ViewOptions view;
    for (Option& option : describe(view))
        expect_bounds_taken(option);
    EXPECT_GT(bounds, 40u);
}

TEST(ShellOptions, EveryLengthIsRescaled)
{
    Described all;
    std::size_t lengths = 0;
    all.for_each([&](const std::string& path, Option& option) {
        // Who writes an option's help says what it is measured in.
        EXPECT_EQ(option.unit == Unit::world_length,
                  option.help.find("world units") != std::string::npos)
            << path;
        if (option.unit == Unit::world_length)
            option.set(4.0);
    });
    divide_lengths(all.sections, 8);
    all.for_each([&](const std::string& path, const Option& option) {
        if (option.unit != Unit::world_length)
            return;
        EXPECT_EQ(option.get(), OptionValue(0.5)) << path;
        ++lengths;
    });
    EXPECT_EQ(all.options.decimate.tolerance, 0.5);
    EXPECT_EQ(all.options.repair->weld_tolerance, 0.5);
    EXPECT_GE(lengths, 8u);
}

TEST(ShellOptions, FlagsAndPathsAreDistinct)
{
    Described all;
    std::set<std::string> flags, paths;
    all.for_each([&](const std::string& path, const Option& option) {
        EXPECT_TRUE(paths.insert(path).second) << path;
        EXPECT_TRUE(option.flag.empty() || flags.insert(option.flag).second) << option.flag;
        EXPECT_FALSE(option.help.empty() || option.group.empty()) << path;
    });
    all.for_each([&](const std::string& path, const Option& option) {
        // Of what is needed the first flag; files are the command's own.
        const std::string needed = option.needs.substr(0, option.needs.find(' '));
        for (const std::string& other : {needed, option.excludes})
            EXPECT_TRUE(other.empty() || other == "--repair" || flags.count(other)) << path;
    });
}

TEST(ShellOptions, UnknownKeysAndWrongKindsAreNamed)
{
    const auto said = [](const std::string& json) -> std::string {
        try {
            options_from_json(json, {}, "a.json");
        } catch (const Error& error) {
            return error.what();
        }
        return "accepted";
    };
    EXPECT_EQ(said(R"({"grow": {"metod": "raw"}})"),
              "a.json: grow.metod is no option; near it: method");
    EXPECT_EQ(said(R"({"grown": {}})"), "a.json: grown is no option; near it: grow");
    EXPECT_EQ(said(R"({"side": "up"})"),
              "a.json: side is up, must be one of inward, outward, both");
    EXPECT_EQ(said(R"({"grow": {"flips": 1}})"), "a.json: grow.flips is 1, must be true or false");
    EXPECT_EQ(said(R"({"grow": 3})"), "a.json: grow is 3, must be an object");
    EXPECT_EQ(said(R"({"layers": {"layers": 2.5}})"),
              "a.json: layers.layers is 2.5, must be a whole number, 0 to 250");
    EXPECT_EQ(said(R"({"layers": {"layers": null}})"),
              "a.json: layers.layers is null, must be a whole number, 0 to 250");
    EXPECT_NE(said("[1]"), "accepted");
    EXPECT_NE(said("{"), "accepted");
}

TEST(ShellOptions, ASectionThatIsAskedForComesAndGoes)
{
    const ShellOptions enabled = options_from_json(R"({"repair": {"sliver_height": 0.5}})");
    ASSERT_TRUE(enabled.repair);
    EXPECT_EQ(enabled.repair->sliver_height, 0.5);
    EXPECT_TRUE(options_from_json(R"({"repair": {}})").repair);
    EXPECT_FALSE(options_from_json(R"({"repair": null})", enabled).repair);
    EXPECT_EQ(options_from_json("{}", enabled).repair->sliver_height, 0.5);
}

/// Stands for a value of any type that a field can have; an optional takes it for its value.
struct Anything {
    template <typename T, typename = std::enable_if_t<!std::is_constructible_v<T, std::nullopt_t>>>
    operator T() const;
};

template <typename T, typename Values, typename = void> struct Holds : std::false_type {
};
template <typename T, typename... Values>
struct Holds<T, std::tuple<Values...>, std::void_t<decltype(T{std::declval<Values>()...})>>
    : std::true_type {
};

template <typename T, typename... Values> constexpr std::size_t fields_of()
{
    if constexpr (Holds<T, std::tuple<Values..., Anything>>::value)
        return fields_of<T, Values..., Anything>();
    else
        return sizeof...(Values);
}

/// All fields but `apart`, which are no options of a user's.
template <typename T> void expect_all_described(const char* name, std::size_t apart = 0)
{
    T options;
    EXPECT_EQ(describe(options).size() + apart, fields_of<T>())
        << name << " has a field that is not described";
}

TEST(ShellOptions, EveryFieldIsDescribed)
{
    expect_all_described<CheckOptions>("CheckOptions");
    expect_all_described<ContourOptions>("ContourOptions");
    expect_all_described<CoverageOptions>("CoverageOptions");
    expect_all_described<DecimateOptions>("DecimateOptions");
    expect_all_described<DirectionOptions>("DirectionOptions");
    // The schedule is for those who change growth: every other number, none of which bears on
    // validity (growth/schedule.h).
    expect_all_described<GrowOptions>("GrowOptions", 1);
    expect_all_described<LayerOptions>("LayerOptions");
    expect_all_described<LevelSetOptions>("LevelSetOptions");
    expect_all_described<LimitOptions>("LimitOptions");
    expect_all_described<LineStepOptions>("LineStepOptions");
    expect_all_described<RefineOptions>("RefineOptions");
    expect_all_described<RemeshOptions>("RemeshOptions");
    expect_all_described<RepairOptions>("RepairOptions");
    expect_all_described<RetriangulateOptions>("RetriangulateOptions");
    expect_all_described<ScaleOptions>("ScaleOptions");
    expect_all_described<SmoothOptions>("SmoothOptions");
    expect_all_described<SplitOptions>("SplitOptions");
    expect_all_described<SubdivideOptions>("SubdivideOptions");
    expect_all_described<WrapOptions>("WrapOptions");
    ShellOptions options;
    EXPECT_EQ(describe(options).size(), fields_of<ShellOptions>());
}

} // namespace
} // namespace vdb_shell::test
