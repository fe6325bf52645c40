// SPDX-License-Identifier: Apache-2.0

// From words to one command that can say which files it needs and can run. A new command is added
// in add_commands(), and thereby has frames, dry runs and all else that is global: they know only
// words, plans of files and statuses.

#include "command/call.h"

#include "command/build_command.h"
#include "command/compare_command.h"
#include "command/deform_command.h"
#include "command/doctor_command.h"
#include "command/estimate_command.h"
#include "command/exit_code.h"
#include "command/farm_command.h"
#include "command/file_commands.h"
#include "command/help.h"
#include "command/inspect_command.h"
#include "command/join_command.h"
#include "command/map_command.h"
#include "command/options_command.h"
#include "command/page_command.h"
#include "command/pose_command.h"
#include "command/repair_command.h"
#include "command/unknown_words.h"
#include "command/usd_command.h"
#include "command/volumes_command.h"
#include "options/option_json.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <functional>
#include <stdexcept>
#include <utility>

namespace vdb_shell::command
{
namespace
{

/// The parser binds fields when it is made, before it is known which command is given; so all
/// commands have theirs here.
struct Arguments {
    GlobalArguments global;
    BuildArguments build;
    InspectArguments inspect;
    RepairArguments repair;
    PoseArguments pose;
    VolumesArguments volumes;
    DeformArguments deform;
    MapArguments map;
    PageArguments page;
    UsdArguments usd;
    FileArguments info, convert, check;
    CompareArguments compare;
    EstimateArguments estimate;
    FarmArguments farm;
    JoinArguments join;
    DoctorArguments doctor;
    OptionsArguments options;
};

/// A subcommand with its options, which files it takes and leaves, and what it does.
struct Subcommand {
    CLI::App* app = nullptr;
    BoundOptions bound;
    std::function<FilePlan()> plan;
    std::function<int(Context&)> run;
    /// --frames gives this command all frames in one run, as its output is one file of all.
    bool gathers_frames = false;
};

/// None has a key, for a file of options says what a shell is made like and not how a call is run.
OptionSections describe(GlobalArguments& a)
{
    const Option threads =
        option("", a.threads, "--threads", "Threads to use; 0 is all. Results do not depend on it")
            .in(Unit::count)
            .within(at_least(0));
    const Option progress =
        option("", a.progress, "--progress",
               "Show the stages, per cent and time left on standard error; text where nothing else "
               "is said, json is one object a line");
    const Option level =
        option("", a.log_level, "--log-level", "How much is said on standard error");
    const Option errors = option("", a.errors, "--errors",
                                 "How errors and all else that is said are written to standard "
                                 "error; json is one object a line");
    const Option frames =
        option("", a.frames, "--frames",
               "Run the command once for each frame: 1-100, 1-100x2, 10-1, 5,8,-3--1. Names of "
               "files have tokens: #### @@@@ %04d $F4");
    const Option dry_run = option("", a.dry_run, "--dry-run",
                                  "Print frames and files, and what stands in their way; read and "
                                  "write none");
    const Option keep_going = option("", a.keep_going, "--keep-going",
                                     "Go on after a frame that failed; the status is still that "
                                     "of the first one that did")
                                  .needing("--frames");
    const Option manifest =
        option("", a.manifest, "--manifest",
               "Note in this JSON file, after each frame, what went in and what came out");
    const Option resume = option("", a.resume, "--resume",
                                 "Leave out frames that the manifest has with the same inputs, "
                                 "options and version, and whose outputs are unchanged")
                              .needing("--manifest");
    const Option at_once = option("", a.frames_at_once, "--frames-at-once",
                                  "Frames to work on at the same time; 0 is as many as threads for "
                                  "small inputs, and else one. Results do not depend on it")
                               .in(Unit::count)
                               .within(at_least(0))
                               .needing("--frames");
    return {{"", in_group("Options", {threads, progress, level, errors})},
            {"", in_group("Frames", {frames, dry_run, keep_going, manifest, resume, at_once})}};
}

/// Numbers with all digits, since options that differ in the seventh one give other bytes.
std::string exact_text(const OptionValue& value)
{
    return std::holds_alternative<double>(value) ? value_json(value).dump() : text_of(value);
}

} // namespace

struct Call::Parts {
    CLI::App app{"Thick shells of prisms and tets from triangle surfaces, as OpenVDB volumes.",
                 "vdb_shell"};
    Arguments a;
    BoundOptions global;
    std::vector<Subcommand> commands;
    /// The only one that is registered; empty: all are.
    std::string only;

    /// The order of its calls is that of the commands in the help.
    template <typename Add, typename Struct>
    void add(const char* name, const char* help, Add add_options, Struct& arguments,
             std::function<FilePlan()> plan, std::function<int(Context&)> run,
             bool gathers_frames = false)
    {
        if (!only.empty() && only != name)
            return;
        CLI::App* subcommand = app.add_subcommand(name, help);
        subcommand->footer(
            "Options of every command, as --frames and --progress: vdb_shell --help");
        commands.push_back({subcommand, add_options(*subcommand, arguments), std::move(plan),
                            std::move(run), gathers_frames});
    }

    void add_commands();
    void add_volume_commands();
    void add_farm_commands();
    void add_file_commands();
    std::vector<CommandEntry> entries() const;
    Subcommand& given();
};

/// From a shell to volumes.
void Call::Parts::add_volume_commands()
{
    add(
        "volumes", "Write volumes of a shell's coordinates", add_volumes_command, a.volumes,
        [this] { return plan_volumes(a.volumes); },
        [this](Context& context) { return run_volumes(a.volumes, context); });
    add(
        "deform", "Carry volumes in a shell to the shell in a pose", add_deform_command, a.deform,
        [this] { return plan_deform(a.deform); },
        [this](Context& context) { return run_deform(a.deform, context); });
    add(
        "map", "Push a texture volume into a shell, by texture coordinates", add_map_command, a.map,
        [this] { return plan_map(a.map); },
        [this](Context& context) { return run_map(a.map, context); });
}

/// What many builds need, beside builds.
void Call::Parts::add_farm_commands()
{
    add(
        "estimate", "Say what a call would cost: seconds, memory, bytes of files",
        add_estimate_command, a.estimate, [this] { return plan_estimate(a.estimate); },
        [this](Context& context) { return run_estimate(a.estimate, context); });
    add(
        "farm", "Write the job of a sequence, or of many assets, for the engine of a farm",
        add_farm_command, a.farm, [this] { return plan_farm(a.farm); },
        [this](Context& context) { return run_farm(a.farm, context); });
    add(
        "join", "Join the manifests of a farm's tasks, and say what is missing", add_join_command,
        a.join, [this] { return plan_join(a.join); },
        [this](Context& context) { return run_join(a.join, context); });
}

/// Those that take a finished shell, or its frames.
void Call::Parts::add_file_commands()
{
    add(
        "page", "Write a page that shows a shell, or its frames, in a browser", add_page_command,
        a.page, [this] { return plan_page(a.page); },
        [this](Context& context) { return run_page(a.page, context); }, true);
    add(
        "usd", "Write one USD stage of a shell's frames", add_usd_command, a.usd,
        [this] { return plan_usd(a.usd); },
        [this](Context& context) { return run_usd(a.usd, context); }, true);
    add(
        "info", "Print what a shell's file holds", add_info_command, a.info,
        [this] { return plan_reading(a.info.file); },
        [this](Context& context) { return run_info(a.info, context); });
    add(
        "convert", "Write other formats from a shell's file", add_convert_command, a.convert,
        [this] { return plan_convert(a.convert); },
        [this](Context&) { return run_convert(a.convert); });
    add(
        "check", "Verify that a shell's file is what it claims", add_check_command, a.check,
        [this] { return plan_reading(a.check.file); },
        [this](Context& context) { return run_check(a.check, context); });
    add(
        "compare", "Say how two shells differ, and draw them side by side", add_compare_command,
        a.compare, [this] { return plan_compare(a.compare); },
        [this](Context& context) { return run_compare(a.compare, context); });
}

/// The actions refer to fields of this struct, which outlive them.
void Call::Parts::add_commands()
{
    add(
        "build", "Build a shell from a triangle surface", add_build_command, a.build,
        [this] { return plan_build(a.build); },
        [this](Context& context) { return run_build(a.build, context); });
    add(
        "inspect", "Say what stands in the way of a shell, and what mends it", add_inspect_command,
        a.inspect, [this] { return plan_inspect(a.inspect); },
        [this](Context& context) { return run_inspect(a.inspect, context); });
    add(
        "repair", "Close and mend a surface, keeping what is sound", add_repair_command, a.repair,
        [this] { return plan_repair(a.repair); },
        [this](Context& context) { return run_repair(a.repair, context); });
    add(
        "pose", "Put a shell onto its surface in another pose", add_pose_command, a.pose,
        [this] { return plan_pose(a.pose); },
        [this](Context& context) { return run_pose(a.pose, context); });
    add_volume_commands();
    add_file_commands();
    add_farm_commands();
    add(
        "doctor", "Say what is installed, and what a file needs", add_doctor_command, a.doctor,
        [this] { return plan_reading(a.doctor.file); },
        [this](Context& context) { return run_doctor(a.doctor, context); });
    add(
        "options", "List the options, for people, programs and shells", add_options_command,
        a.options, [] { return FilePlan(Existing::replaced); },
        [this](Context& context) {
            // This call may know its own command only.
            const Call all;
            return run_options(a.options, all.parts_->entries(), context.out);
        });
}

/// The global options first, under no name.
std::vector<CommandEntry> Call::Parts::entries() const
{
    std::vector<CommandEntry> entries{{"", "", &global}};
    for (const Subcommand& command : commands)
        entries.push_back(
            {command.app->get_name(), command.app->get_description(), &command.bound});
    return entries;
}

/// After parse(). The parser wants one command and takes no second one.
Subcommand& Call::Parts::given()
{
    for (Subcommand& command : commands)
        if (command.app->parsed())
            return command;
    throw std::logic_error("the parser wants a command");
}

std::vector<std::string> words_of(const std::vector<std::string>& given)
{
    std::vector<std::string> words;
    // The parser would take whatever comes next for the value, and so `--progress build` for a
    // style.
    const auto style = [](const std::string& word) {
        const auto& table = names(ProgressStyle::none);
        return std::any_of(table.begin(), table.end(),
                           [&](const auto& entry) { return entry.first == word; });
    };
    for (std::size_t i = 0; i < given.size(); ++i) {
        const std::string& word = given[i];
        const std::string next = i + 1 < given.size() ? given[i + 1] : "";
        if (word == "--frames" && !next.empty()) {
            words.push_back(word);
            // A parser takes a word that begins with a minus for a flag; behind an = it does not.
            words.back().append("=").append(next);
            ++i;
        } else if (word == "--progress") {
            words.push_back(word);
            words.back().append("=").append(style(next) ? next : "text");
            i += style(next) ? 1 : 0;
        } else {
            words.push_back(word == "--no-progress" ? "--progress=none" : word);
        }
    }
    return words;
}

Call::Call(const std::string& only) : parts_(std::make_unique<Parts>())
{
    Parts& p = *parts_;
    p.only = only;
    p.app.set_version_flag("--version", version_text());
    p.app.require_subcommand(1);
    // Global options may stand behind the command as well, where people tend to add them.
    p.app.fallthrough();
    begin_help_with_examples(p.app);
    p.app.failure_message([](const CLI::App*, const CLI::Error& error) {
        return std::string("vdb_shell: ") + error.what() +
               "\nRun with --help for more information.\n";
    });
    p.global = bind(p.app, describe(p.a.global));
    p.add_commands();
}

Call::~Call() = default;

void Call::parse(const std::vector<std::string>& words)
{
    // The parser takes them from the back.
    try {
        parts_->app.parse(std::vector<std::string>(words.rbegin(), words.rend()));
    } catch (const CLI::ArgumentMismatch& error) {
        // "--thickness: At Most 1 required but received 2", "--thickness: 1 required  missing".
        const std::string what = error.what(), flag = what.substr(0, what.find(": "));
        if (what.find("At Most 1") != std::string::npos)
            throw CLI::ArgumentMismatch(flag + " is given more than once",
                                        CLI::ExitCodes::ArgumentMismatch);
        if (what.find(" missing") != std::string::npos)
            throw CLI::ArgumentMismatch(flag + " has no value behind it",
                                        CLI::ExitCodes::ArgumentMismatch);
        throw;
    } catch (const CLI::RequiredError&) {
        const std::vector<std::string> unknown = parts_->app.remaining();
        // The parser asks for a command before it asks what the words are.
        if (!parts_->app.get_subcommands().empty() || unknown.empty())
            throw;
        throw CLI::ExtrasError(told_no_command(unknown.front(), parts_->entries()),
                               CLI::ExitCodes::ExtrasError);
    } catch (const CLI::ExtrasError&) {
        std::vector<std::string> unknown = parts_->app.remaining(true);
        // The parser lists them from the back.
        std::reverse(unknown.begin(), unknown.end());
        throw CLI::ExtrasError(
            told_unknown(unknown, parts_->given().app->get_name(), parts_->entries()),
            CLI::ExitCodes::ExtrasError);
    }
    apply(parts_->global);
}

int Call::end(const CLI::ParseError& error) const
{
    // Help and version are thrown as well, with status 0; CLI11's other numbers are its own and
    // are replaced by ours.
    return parts_->app.exit(error) == 0 ? success : usage_error;
}

const GlobalArguments& Call::global() const
{
    return parts_->a.global;
}

std::string Call::name() const
{
    return parts_->given().app->get_name();
}

bool Call::gathers_frames() const
{
    return parts_->given().gathers_frames;
}

std::string Call::options_text() const
{
    const Subcommand& command = parts_->given();
    // Folders do not count: the same work on another machine, or after the project was moved, has
    // other folders and the same bytes.
    const auto name_alone = [](const std::string& file) {
        return std::filesystem::path(file).filename().string();
    };
    std::string text = command.app->get_name() + '\n';
    for (const CLI::Option* option : command.app->get_options())
        // Words without a flag have no description of ours.
        if (option->get_positional())
            for (const std::string& word : option->results())
                text += name_alone(word) + '\n';
    for (const BoundOption& bound : command.bound.options) {
        const Option& option = bound.option;
        const std::string value = exact_text(option.get());
        text += option.flag + ' ' + option.key + '=';
        if (option.kind == OptionKind::text && bound.given)
            // An option that can be given several times keeps more than its field shows, and their
            // order counts.
            for (const std::string& word : bound.given->results())
                text += name_alone(word) + ' ';
        text += (option.kind == OptionKind::text ? name_alone(value) : value) + '\n';
    }
    return text;
}

std::string Call::value_of(const std::string& flag) const
{
    for (const BoundOption& bound : parts_->given().bound.options)
        if (bound.option.flag == flag) {
            const OptionValue value = bound.option.get();
            return std::holds_alternative<std::monostate>(value) ? "" : text_of(value);
        }
    return "";
}

const BuildArguments& Call::build_arguments() const
{
    return parts_->a.build;
}

const PoseArguments& Call::pose_arguments() const
{
    return parts_->a.pose;
}

const DeformArguments& Call::deform_arguments() const
{
    return parts_->a.deform;
}

FilePlan Call::plan()
{
    Subcommand& command = parts_->given();
    apply(command.bound);
    return command.plan();
}

int Call::run(Context& context)
{
    return parts_->given().run(context);
}

} // namespace vdb_shell::command
