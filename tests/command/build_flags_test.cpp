// SPDX-License-Identifier: Apache-2.0
#include "command_fixture.h"
#include "support/shapes.h"

#include "fill/outside_program.h"
#include "vdb_shell/write/vdb_file.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <vector>

// Every flag of `build`, as the command itself lists them, arrives where the written file says what
// the shell was built with.

namespace vdb_shell::test
{
namespace
{

using command::ExitCode;
using nlohmann::json;

/// What is given to a flag, and what its key has to say then.
struct Given {
    std::string words;
    json expected;
};

/// Values that no rule finds, or that no 80 triangles can be built with; with what the flag needs
/// and the list does not tell. Names of files begin with FOLDER.
const std::map<std::string, Given>& chosen_values()
{
    static const std::map<std::string, Given> values{
        {"--resolution", {"--resolution 20", 20}},
        {"--repair", {"--repair", json::object()}}, // without it null, with it its options
        {"--wrap", {"--wrap --wrap-resolution 16", true}},
        {"--wrap-resolution", {"--wrap-resolution 16", 16}},
        {"--decimate-to", {"--decimate-to 60", 60}},
        {"--remesh-to", {"--remesh-to 60", 60}},
        {"--core-distance", {"--core-distance 0.1", 0.1}},
        {"--core", {"--core stitched --taper", "stitched"}},
        {"--stop-test", {"--stop-test distance", "distance"}}, // none wants a thickness
        {"--want-tets", {"--want-tets 100", 100}}};
    return values;
}

/// What a flag needs is told in words; here is the first of what is allowed. Empty where all
/// builds here have it.
const std::map<std::string, std::string>& partners()
{
    static const std::map<std::string, std::string> words{
        {"--output .vdb", ""},
        {"--output .usda", "-o FOLDER/s.usda"},
        {"--output .png", "-o FOLDER/s.png"},
        {"--output .obj .ply .off .stl", "-o FOLDER/inner.obj"},
        {"--picture surface cut-away", "--picture surface -o FOLDER/s.png"},
        {"--turntable", "--turntable 4 --picture surface -o FOLDER/s.png"},
        {"--repair", "--repair"},
        {"--wrap or --mend", "--mend"}, // which wraps only what is broken
        {"--retriangulate", "--retriangulate"},
        {"--decimate-to", "--decimate-to 60"},
        {"--remesh-edge-length or --remesh-to", "--remesh-to 60"},
        {"--core", "--core FOLDER/core.obj"},
        {"--perturb", "--perturb 0.1"},
        {"--stop-test normal start-gradient relative-normal", ""},
        {"--stop-test distance bisection", "--stop-test distance"},
        {"--stop-test bisection", "--stop-test bisection"},
        {"--stop-test relative-normal own-sheet", "--stop-test own-sheet"},
        {"--stop-test own-sheet", "--stop-test own-sheet"},
        {"--method certified", ""},
        {"--method certified thickest", ""},
        {"--refine-rounds", "--refine-rounds 1"},
        {"--layers", "--layers 2"},
        {"--taper", "--taper"},
        {"--core-fill", "--core-fill gmsh"},
        {"--core-fill tetgen", "--core-fill tetgen"},
        {"--split ripple", "--split ripple"}};
    return words;
}

/// How files are read and written is not what the shell was built with, and neither are limits on
/// what the work may cost.
bool is_no_parameter(const std::string& key)
{
    static const std::set<std::string> sections{"read", "vdb", "usd", "surface_file", "picture"};
    static const std::set<std::string> limits{"level_set.max_memory_gib", "core_fill.seconds"};
    return sections.count(key.substr(0, key.find('.'))) > 0 || limits.count(key) > 0;
}

json number_beside(const json& option)
{
    const json& range = option.at("range");
    constexpr double kNone = std::numeric_limits<double>::infinity();
    const bool whole = option.at("type") != "number";
    const double low = range.value("at_least", range.value("above", 0.0));
    const double high = range.value("at_most", range.value("below", kNone));
    const double from = option.at("default").is_null() ? low : option.at("default").get<double>();
    const double step = whole ? 1 : 0.25;
    const double value = from + step < high ? from + step : from - step;
    return whole ? json(std::llround(value)) : json(value);
}

/// A valid value that is not the default.
Given other_value(const json& option)
{
    const std::string flag = option.at("flag"), type = option.at("type");
    const auto chosen = chosen_values().find(flag);
    if (chosen != chosen_values().end())
        return chosen->second;
    if (type == "flag" && option.at("default") == true)
        return {option.at("negation"), false};
    if (type == "flag")
        return {flag, true};
    if (type == "choice") {
        for (const json& choice : option.at("choices"))
            if (choice != option.at("default"))
                return {flag + " " + choice.get<std::string>(), choice};
    } else if (type == "number" || type == "integer" || type == "unsigned") {
        const json value = number_beside(option);
        return {flag + " " + value.dump(), value};
    }
    ADD_FAILURE() << flag << ": no value is known of type " << type;
    return {};
}

json at_key(const json& parameters, std::string key)
{
    for (std::size_t dot = 0; (dot = key.find('.', dot)) != std::string::npos;)
        key[dot] = '/';
    const json::json_pointer pointer("/" + key);
    return parameters.contains(pointer) ? parameters.at(pointer) : json();
}

class BuildFlags : public Command
{
protected:
    json options_of_build()
    {
        return json::parse(run("options --json").out).at("commands").at("build").at("options");
    }

    std::string partner_of(const json& option)
    {
        if (option.at("needs").is_null())
            return "";
        const auto known = partners().find(option.at("needs"));
        if (known != partners().end())
            return known->second;
        ADD_FAILURE() << "needs " << option.at("needs") << ", of which no example is known";
        return "";
    }

    /// Those of a build with these words.
    json parameters_of(std::string words)
    {
        for (std::size_t at; (at = words.find("FOLDER")) != std::string::npos;)
            words.replace(at, 6, folder.path().string());
        const auto has = [&](const char* flag) { return words.find(flag) != std::string::npos; };
        // Coarse and soon done, where the words do not say otherwise.
        if (!has("--voxel-size ") && words.find("--resolution ") != 0)
            words += " --resolution 16";
        if (!has("--samples "))
            words += " --samples 0";
        // The one flag that is for level sets.
        const std::string input = has("--contour-adaptivity") ? field + ":surface" : ball;
        const std::string shell = file("s.vdb");
        const Outcome built = run("--threads 1 build " + input + " " + words + " -q -o " + shell);
        // Bounds need not be met here.
        EXPECT_TRUE(built.status == ExitCode::success || built.status == ExitCode::bound_not_met)
            << words << ": " << built.status << ' ' << built.err;
        // What `info --json` prints, without a process more for each flag.
        json parameters = json::parse(read_shell_info(shell).parameters_json);
        std::filesystem::rename(shell, last);
        return parameters;
    }

    const std::string ball = mesh_file("ball.obj", icosphere(1.0, 1));
    const std::string core = mesh_file("core.obj", icosphere(0.3, 1));
    const std::string field = file("field.vdb"), last = file("last.vdb");
};

TEST_F(BuildFlags, EachArrivesInTheParametersOfTheFile)
{
    ASSERT_EQ(
        run("build " + ball + " --resolution 24 --field dense --samples 0 -q -o " + field).status,
        ExitCode::success);
    const json plain = parameters_of("");
    EXPECT_EQ(json::parse(run("info --json " + last).out).at("parameters"), plain);
    std::size_t parameters = 0, others = 0;
    for (const json& option : options_of_build()) {
        if (option.at("flag").is_null() || option.at("key").is_null())
            continue; // of files of options alone, or of the call and not of the shell
        const std::string flag = option.at("flag"), key = option.at("key");
        SCOPED_TRACE(flag);
        const Given given = other_value(option);
        const std::string words = given.words + " " + partner_of(option);
        const auto wants = [&](const std::string& program) {
            return words.find("--core-fill " + program) != std::string::npos &&
                   fill::find_program(program).empty();
        };
        if (wants("gmsh") || wants("tetgen"))
            continue; // it is not installed
        const json found = parameters_of(words);
        if (is_no_parameter(key)) {
            EXPECT_TRUE(at_key(found, key).is_null()) << "it is a parameter";
            ++others;
            continue;
        }
        ++parameters;
        if (given.expected.is_object())
            EXPECT_TRUE(at_key(found, key).is_object()) << at_key(found, key);
        else
            EXPECT_EQ(at_key(found, key), given.expected);
        EXPECT_NE(at_key(found, key), at_key(plain, key)) << "it is the default";
    }
    // As many as there were when this was written: no rule above leaves all of them out.
    EXPECT_GE(parameters, 82u);
    EXPECT_GE(others, 19u);
}

} // namespace
} // namespace vdb_shell::test
