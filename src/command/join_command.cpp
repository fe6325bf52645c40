// SPDX-License-Identifier: Apache-2.0

// The command `join`: manifests that the tasks of a farm left in, one manifest out, and what is
// missing in it. A task that never ran has left no manifest, so what is expected has to be said: a
// frame that nobody knows of is no success.

#include "command/join_command.h"

#include "vdb_shell/core/error.h"

#include "command/exit_code.h"
#include "command/frames.h"
#include "command/manifest.h"
#include "core/folder_names.h"
#include "options/shown_text.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <deque>
#include <optional>
#include <ostream>

namespace vdb_shell::command
{
namespace
{

namespace fs = std::filesystem;

/// Without --expect one run without a frame, whose manifest has a null for it.
std::vector<std::optional<int>> expected(const JoinArguments& arguments)
{
    if (arguments.expect.empty())
        return {std::nullopt};
    const std::vector<int> frames = parse_frames(arguments.expect, "--expect").frames;
    return {frames.begin(), frames.end()};
}

/// One of the steps that are expected.
struct Finding {
    int status = success;
    std::string what; ///< empty where it is done
};

/// From the worst to the best: not noted, failed, noted but gone. That the bytes are still the same
/// is not asked: a thousand frames would have to be read.
Finding finding_of(const Manifest& manifest, std::optional<int> frame)
{
    const std::optional<ManifestEntry> entry = manifest.find(frame);
    if (!entry)
        return {check_failed, "missing: no task has noted it"};
    if (entry->status != success)
        return {entry->status, "status " + std::to_string(entry->status) +
                                   (entry->error.empty() ? "" : ", " + entry->error)};
    const std::string lost = manifest.lost_output(*entry);
    if (!lost.empty())
        return {check_failed, "missing: " + lost + " is gone, or has another size"};
    return {};
}

/// Those that are there; in the place of a folder all manifests in it, but for the one to write.
std::vector<fs::path> parts_of(const JoinArguments& arguments)
{
    std::vector<fs::path> parts;
    for (const fs::path& part : arguments.parts) {
        std::error_code unknown;
        if (!fs::is_directory(part, unknown)) {
            // One that is not there is what a task that never ran has left: its frames are told to
            // be missing. One that cannot be looked at is refused where it is read.
            if (fs::exists(part, unknown) || unknown)
                parts.push_back(part);
            continue;
        }
        std::vector<fs::path> inside;
        for (const std::string& name : names_in(part, unknown)) {
            const fs::path path = part / name;
            std::error_code gone;
            // The whole manifest may stand in the folder of its parts, from an earlier join, and is
            // none of them. Neither are folders, pipes and links to nothing.
            if (path.extension() == ".json" && fs::is_regular_file(path, gone) &&
                !fs::equivalent(path, arguments.whole, gone))
                inside.push_back(path);
        }
        if (unknown)
            throw ReadError(part.string() + ": the folder cannot be read: " + unknown.message());
        // A folder is listed in no order. Where two parts know of a frame the last one holds, so
        // the order has to be the same each time.
        std::sort(inside.begin(), inside.end());
        parts.insert(parts.end(), inside.begin(), inside.end());
    }
    return parts;
}

/// Prints a line for each step that is not done, and the count. The status is that of the first.
int print_findings(const JoinArguments& arguments, const Manifest& manifest, std::ostream& out)
{
    const std::vector<std::optional<int>> steps = expected(arguments);
    std::vector<int> undone;
    int status = success;
    std::size_t done = 0;
    for (const std::optional<int> frame : steps) {
        const Finding finding = finding_of(manifest, frame);
        if (finding.status == success) {
            ++done;
            continue;
        }
        status = status == success ? finding.status : status;
        undone.push_back(frame.value_or(0));
        // Names and errors are those of a file, and go to a terminal.
        out << arguments.whole.string() << ": "
            << (frame ? "frame " + std::to_string(*frame) + ": " : "") << shown(finding.what)
            << '\n';
    }
    out << arguments.whole.string() << ": " << done << " of " << steps.size()
        << (arguments.expect.empty() ? " runs" : " frames") << " done";
    if (!undone.empty() && !arguments.expect.empty())
        out << ", not done: " << frames_text(undone);
    out << '\n';
    return status;
}

} // namespace

BoundOptions add_join_command(CLI::App& app, JoinArguments& arguments)
{
    app.add_option("manifests", arguments.parts,
                   "Manifests of one command, with other frames each, or a folder of them; one "
                   "that is not there is passed over, and its frames are missing")
        ->required();
    Option whole = option("", arguments.whole, "--output",
                          "The manifest to write; what it has already of other frames is kept")
                       .with_names({"-o"});
    whole.required = true;
    const Option expect = option("", arguments.expect, "--expect",
                                 "Frames that have to be there, as for --frames; without it one "
                                 "run without a frame");
    return bind(app, {{"", in_group("Output", {whole, expect})}});
}

FilePlan plan_join(const JoinArguments& arguments)
{
    expected(arguments);
    // --expect was read above for its errors alone, which are told before anything is joined.
    FilePlan plan(Existing::replaced);
    for (const fs::path& part : arguments.parts)
        plan.add_input(part);
    plan.add_output(arguments.whole);
    return plan;
}

int run_join(const JoinArguments& arguments, Context& context)
{
    const std::vector<fs::path> files = parts_of(arguments);
    if (files.empty())
        throw ReadError("none of the manifests is there, the first of them not " +
                        arguments.parts.front().string() + "; nothing was written");
    // The first one says which command the others have to be of.
    const std::string command = Manifest::command_in(files.front());
    // A manifest holds a mutex and cannot be moved, which a vector would do as it grows.
    std::deque<Manifest> parts;
    for (const fs::path& file : files)
        parts.emplace_back(file, command);
    Manifest whole(arguments.whole, command);
    whole.put_all_of(parts);
    return print_findings(arguments, whole, context.out);
}

} // namespace vdb_shell::command
