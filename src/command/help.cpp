// SPDX-License-Identifier: Apache-2.0

// What a person asks first: what to type, and which build this is.

#include "command/help.h"

#include "core/text_stream.h"

#include <CLI/CLI.hpp>
#include <blosc.h>
#include <nlohmann/json.hpp>
#include <openvdb/version.h>
#include <tbb/version.h>

#include <array>
#include <map>
#include <memory>
#include <vector>

namespace vdb_shell::command
{
namespace
{

struct ExampleOf {
    const char *command, *words, *does;
};

/// In the order of the help. Those of the program itself stand under an empty name.
constexpr std::array<ExampleOf, 33> kExamples{{
    {"", "inspect cow.obj", "what stands in the way of a shell"},
    {"", "build cow.obj -o cow.vdb -o cow.vtu", "a shell, for Houdini and ParaView"},
    {"", "build walk.####.obj --frames 1-100 -o walk.####.vdb", "one for each frame"},
    {"", "check cow.vdb", "is it what it claims?"},
    {"build", "build cow.obj -o cow.vdb -o cow.png", "a shell and a picture of its cross-section"},
    {"build", "build scan.ply --repair --decimate-to 20000 -o scan.vdb", "of a scan with holes"},
    {"build", "build body.obj --for simulation -o body.msh", "tets for a solver"},
    {"build",
     "build walk.####.obj --frames 1-100 --keep-going --manifest walk.json --resume -o "
     "walk.####.vdb",
     "a sequence; typed again it does what is left"},
    {"inspect", "inspect scan.ply -o defects.ply", "what is wrong, and a picture of where"},
    {"inspect", "inspect scan.ply --json", "the same for a program"},
    {"repair", "repair scan.ply --cut-crossings -o mended.obj", "close holes, cut crossings"},
    {"pose", "pose rest.vdb cow.0001.obj -o posed.vdb", "the same tets on the surface in a pose"},
    {"pose", "pose rest.vdb walk.####.obj --frames 1-100 -o posed.####.vdb", "and in each frame"},
    {"volumes", "volumes cow.vdb --volumes depth,rest,layer -o coordinates.vdb",
     "where in the shell each voxel is"},
    {"deform", "deform smoke.vdb --posed posed.####.vdb --frames 1-100 -o smoke.####.vdb",
     "volumes in the shell at rest go with its poses"},
    {"map", "map bricks.vdb --shell cow.vdb --mesh cow.obj --repeat-u 12 --repeat-v 4 -o wall.vdb",
     "a texture of voxels, tiled over the surface"},
    {"info", "info cow.vdb --json", "options and figures, as one JSON object"},
    {"convert", "convert cow.vdb -o cow.usda -o cow.msh", "other formats of the same shell"},
    {"page", "page cow.vdb -o cow.html", "to turn and cut a shell in a browser"},
    {"page", "page walk.####.vdb --frames 1-100 -o walk.html", "with a slider for the frames"},
    {"check", "check cow.vdb", "status 0: it is what it claims"},
    {"usd", "usd walk.####.vdb --frames 1-100 -o walk.usda", "a stage of a posed sequence"},
    {"compare", "compare old.vdb new.vdb", "figures of both, and how far their points lie apart"},
    {"compare", "compare a.vdb b.vdb -o ab.png --section-axis view --colour-by quality",
     "the two cut open side by side"},
    {"estimate", "estimate scan.ply --layers 3 -o scan.vdb",
     "seconds, memory and bytes of that build"},
    {"estimate", "estimate *.obj --report -", "of many, for a program"},
    {"estimate", "estimate -- pose rest.vdb walk.####.obj --frames 1-100 -o posed.####.vdb",
     "of a whole call, which stands behind --"},
    {"farm",
     "farm --engine slurm -o walk.sbatch -- build walk.####.obj --frames 1-100 --voxel-size 0.01 "
     "-o walk.####.vdb",
     "an array job; bash walk.sbatch submit hands it over"},
    {"join", "join walk.tasks -o walk.json --expect 1-100", "what is done, and what is missing"},
    {"doctor", "doctor", "what is installed"},
    {"doctor", "doctor scan.ply", "what a file needs"},
    {"options", "options --json", "all options of all commands, for programs"},
    {"options", "options --complete bash > ~/.local/share/bash-completion/completions/vdb_shell",
     "completion with the tab key"},
}};

class HelpWithExamples : public CLI::Formatter
{
public:
    std::string make_description(const CLI::App* app) const override
    {
        std::string text = CLI::Formatter::make_description(app);
        // The program itself has no parent.
        const std::string command = app->get_parent() ? app->get_name() : "";
        const std::vector<Example>& examples = examples_of(command);
        if (!examples.empty())
            text += "\nExamples:\n";
        for (const Example& example : examples)
            text += "  # " + example.does + "\n  vdb_shell " + example.words + '\n';
        return text + (examples.empty() ? "" : "\n");
    }

    /// CLI11 adds to the negation of a switch which value it stands for; people read that from its
    /// name.
    std::string make_option_name(const CLI::Option* option, bool is_positional) const override
    {
        if (is_positional)
            return CLI::Formatter::make_option_name(option, is_positional);
        std::vector<std::string> names;
        for (const std::string& name : option->get_snames())
            names.push_back("-" + name);
        for (const std::string& name : option->get_lnames())
            names.push_back("--" + name);
        return CLI::detail::join(names, ", ");
    }
};

} // namespace

const std::vector<Example>& examples_of(const std::string& command)
{
    static const std::map<std::string, std::vector<Example>> by_command = [] {
        std::map<std::string, std::vector<Example>> sorted;
        for (const ExampleOf& example : kExamples)
            sorted[example.command].push_back({example.words, example.does});
        return sorted;
    }();
    static const std::vector<Example> none;
    const auto found = by_command.find(command);
    return found == by_command.end() ? none : found->second;
}

void begin_help_with_examples(CLI::App& app)
{
    app.formatter(std::make_shared<HelpWithExamples>());
}

/// What a report of a fault has to say.
std::string version_text()
{
    OutText text;
    text << "vdb_shell " VDB_SHELL_VERSION "\n"
         << "OpenVDB " << openvdb::getLibraryVersionString() << ", oneTBB " << TBB_runtime_version()
         << ", Blosc " BLOSC_VERSION_STRING ", JSON for Modern C++ " << NLOHMANN_JSON_VERSION_MAJOR
         << '.' << NLOHMANN_JSON_VERSION_MINOR << '.' << NLOHMANN_JSON_VERSION_PATCH
         << ", CLI11 " CLI11_VERSION "\n"
#if defined(__clang__)
         << "Clang " __clang_version__
#else
         << "GCC " __VERSION__
#endif
         << ", build " VDB_SHELL_BUILD_TYPE
#if defined(NDEBUG)
         << ", without assertions";
#else
         << ", with assertions";
#endif
    return text.str();
}

} // namespace vdb_shell::command
