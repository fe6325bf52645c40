// SPDX-License-Identifier: Apache-2.0

// A call with --frames is as many calls as it has frames: its words with the frame's number in
// place of each token. So commands need not know of frames. All of them are planned before the
// first one runs: what is known to fail after an hour is told at once. The commands
// that gather frames, page and usd, are the exception: one call, whose input is as many files.

#include "command/sequence.h"

#include "vdb_shell/core/error.h"
#include "vdb_shell/core/words.h"

#include "command/frames.h"

#include <algorithm>
#include <map>
#include <utility>

namespace vdb_shell::command
{
namespace
{

namespace fs = std::filesystem;

std::string name_of(const Step& step)
{
    return step.frame ? "frame " + std::to_string(*step.frame) + ": " : "";
}

/// Which step reads or writes which file.
class FilesOfSteps
{
public:
    /// `who`: "by frame 7".
    void add(const std::string& who, const FilePlan& plan)
    {
        for (const FilePlan::Entry& input : plan.inputs())
            // Only the first reader is kept, for the message; many frames may read one file.
            readers_.emplace(input.identity, who);
        for (const FilePlan::Entry& output : plan.outputs())
            // Many frames may write into one pipe, or into /dev/null.
            if (!output.special)
                add_output(who, output);
    }

    /// After all steps: an output that is the input of a later frame would be read when it has
    /// been replaced, and that of an earlier one would be gone.
    void require_apart() const
    {
        for (const auto& [identity, writer] : writers_) {
            const auto reader = readers_.find(identity);
            if (reader != readers_.end())
                throw InvalidOption(writer.path.string() + ": is written " + writer.who +
                                    " and read " + reader->second + "; it is not overwritten");
        }
    }

private:
    struct Writer {
        std::string who;
        fs::path path;
    };

    void add_output(const std::string& who, const FilePlan::Entry& output)
    {
        const auto [other, added] = writers_.emplace(output.identity, Writer{who, output.path});
        if (!added)
            throw InvalidOption(output.path.string() + ": would be written " + other->second.who +
                                " and " + who +
                                "; in a sequence its name needs a frame token (####, @@@@, %04d, "
                                "or '$F4' in quotes)" +
                                (lower_case_extension(output.path) == ".html"
                                     ? "; one page of all frames is made by vdb_shell page"
                                     : ""));
    }

    std::map<FilePlan::Identity, std::string> readers_;
    std::map<FilePlan::Identity, Writer> writers_;
};

/// Beside all that the steps read and write.
void add_manifest(FilesOfSteps& files, const fs::path& manifest)
{
    if (const std::string token = frame_token(manifest.string()); !token.empty())
        throw InvalidOption(manifest.string() + ": has the frame token \"" + token +
                            "\", and there is one manifest for all frames");
    FilePlan plan(Existing::replaced);
    plan.add_output(manifest);
    files.add("as the manifest", plan);
}

/// Without --frames a token is a part of the name. That is well for a file that is there, and
/// surely not meant for one that would be written.
void require_no_tokens(const FilePlan& plan)
{
    for (const FilePlan::Entry& output : plan.outputs())
        if (const std::string token = frame_token(output.path.string()); !token.empty())
            throw InvalidOption(output.path.string() + ": has the frame token \"" + token +
                                "\", which needs --frames");
    for (const fs::path& input : plan.missing())
        if (const std::string token = frame_token(input.string()); !token.empty())
            throw InvalidOption(input.string() + ": there is no such file, and its frame token \"" +
                                token + "\" needs --frames");
}

/// --resume replaces what is stale, and a frame takes the input of no other.
void require_repeatable(const FilePlan& plan, const GlobalArguments& global)
{
    if (global.resume && plan.existing() == Existing::kept)
        throw InvalidOption("--resume excludes --no-clobber: stale outputs are replaced");
    if (plan.reads_standard_input() && !global.frames.empty())
        throw InvalidOption("-: standard input is read once, and --frames would read it for each");
    if (plan.reads_standard_input() && !global.manifest.empty())
        throw InvalidOption("-: standard input is read once, and --manifest needs its digest");
}

/// Fills in the files of the step as well, which a dry run prints and a manifest notes.
FilePlan plan_of(Step& step)
{
    Call call(step.command);
    call.parse(step.words);
    FilePlan plan = call.plan();
    for (const FilePlan::Entry& input : plan.inputs())
        step.inputs.push_back(input.path);
    for (const FilePlan::Entry& output : plan.outputs())
        step.outputs.push_back(output.path);
    step.missing = plan.missing();
    return plan;
}

/// An error of one frame says which.
template <typename Body> void with_name(const Step& step, const Body& body)
{
    try {
        body();
    } catch (const InvalidOption& error) {
        throw InvalidOption(name_of(step) + error.what());
    } catch (const ReadError& error) {
        throw ReadError(name_of(step) + error.what());
    } catch (const GeometryError& error) {
        throw GeometryError(name_of(step) + error.what());
    } catch (const WriteError& error) {
        throw WriteError(name_of(step) + error.what());
    }
}

/// How far the frame that a word names is from the one that is worked on: the meshes of `pose`'s
/// neighbours are those of other frames.
int shift_of(const std::vector<std::string>& words, std::size_t i)
{
    const auto behind = [&](const std::string& flag) {
        return words[i].rfind(flag + "=", 0) == 0 || (i > 0 && words[i - 1] == flag);
    };
    return behind("--mesh-after") - behind("--mesh-before");
}

/// One step, in which each name with a token stands once for each frame.
Step gathered(const std::vector<std::string>& words, const FrameList& list)
{
    Call call;
    call.parse(words);
    const FilePlan plan = call.plan();
    for (const FilePlan::Entry& output : plan.outputs())
        if (const std::string token = frame_token(output.path.string()); !token.empty())
            throw InvalidOption(output.path.string() + ": has the frame token \"" + token +
                                "\", and all frames come into one file");
    // The frames go with the step, for `usd` writes their numbers as times.
    Step step{std::nullopt, {}, {}, {}, {}, list.frames};
    for (const std::string& word : words) {
        if (frame_token(word).empty())
            step.words.push_back(word);
        else
            for (const int frame : list.frames)
                step.words.push_back(with_frame(word, frame));
    }
    return step;
}

/// The words of each step; their files are not known yet.
std::vector<Step> steps_of(const std::vector<std::string>& words, const GlobalArguments& global,
                           const Context& context)
{
    if (global.frames.empty())
        return {{std::nullopt, words, {}, {}, {}, {}}};
    const FrameList list = parse_frames(global.frames);
    if (!list.repeated.empty())
        context.say(LogLevel::warning, "warning: --frames has " + frames_text(list.repeated) +
                                           " more than once; each frame is done once");
    Call whole;
    whole.parse(words);
    // Asked of the words as they stand, with their tokens: which command it is does not depend on
    // the frame.
    if (whole.gathers_frames())
        return {gathered(words, list)};
    std::vector<Step> steps;
    for (const int frame : list.frames) {
        Step step{frame, {}, {}, {}, {}, {}};
        for (std::size_t i = 0; i < words.size(); ++i)
            step.words.push_back(with_frame(words[i], frame + shift_of(words, i)));
        steps.push_back(std::move(step));
    }
    return steps;
}

/// A file in a folder that may not be searched is missing too, and may well be there.
std::string why_missing(const fs::path& path)
{
    std::error_code unknown;
    const bool there = fs::exists(path, unknown);
    return there || unknown ? "cannot be read: " + unknown.message() : "there is no such file";
}

/// For the one step of a command that gathers frames, which would read for minutes before it comes
/// to a file that is missing: all are told before the work. One file alone is told by its reader.
void require_gathered(const Step& step)
{
    const std::size_t count = step.missing.size();
    if (count == 0 || (step.gathered.empty() && step.inputs.empty() && count == 1))
        return;
    constexpr std::size_t kMost = 20; // names that a line has room for
    std::string text = step.missing.front().string() + ": " + why_missing(step.missing.front());
    for (std::size_t i = 1; i < std::min(count, kMost); ++i)
        text += (i == 1 ? "; nor " : ", ") + step.missing[i].string();
    if (count > kMost)
        text += " and " + std::to_string(count - kMost) + " more";
    throw ReadError(text + "; " + std::to_string(count) + " of " +
                    std::to_string(count + step.inputs.size()) +
                    " inputs are missing, and nothing was done");
}

/// A file that is missing in a sequence is told before an hour of work, and all of them at once.
void require_inputs(const std::vector<Step>& steps)
{
    std::vector<int> frames;
    const Step* first = nullptr;
    for (const Step& step : steps)
        if (step.frame && !step.missing.empty()) {
            first = first ? first : &step;
            frames.push_back(*step.frame);
        }
    if (first)
        throw ReadError(
            "no input for frames " + frames_text(frames) + ": " + first->missing.front().string() +
            " is the first that is missing; nothing was done (--keep-going does the others)");
}

} // namespace

std::vector<Step> plan_steps(const std::vector<std::string>& words, const GlobalArguments& global,
                             const Context& context)
{
    std::vector<Step> steps = steps_of(words, global, context);
    FilesOfSteps files;
    Call first;
    first.parse(steps.front().words);
    for (Step& step : steps)
        with_name(step, [&] {
            step.command = first.name();
            const FilePlan plan = plan_of(step);
            require_repeatable(plan, global);
            if (!step.frame)
                require_no_tokens(plan);
            files.add(step.frame ? "by frame " + std::to_string(*step.frame) : "by the command",
                      plan);
        });
    if (!global.manifest.empty())
        add_manifest(files, global.manifest);
    files.require_apart();
    if (first.gathers_frames() && !global.dry_run)
        require_gathered(steps.front());
    // With it a frame that misses an input fails when its turn comes, and the others are done.
    if (!global.keep_going)
        require_inputs(steps);
    return steps;
}

void print_steps(const std::vector<Step>& steps, std::ostream& out)
{
    const auto print = [&](const char* between, const std::vector<fs::path>& files) {
        for (const fs::path& file : files)
            out << between << file.string();
    };
    std::vector<int> frames;
    for (const Step& step : steps) {
        out << name_of(step) << "reads";
        print(" ", step.inputs);
        print(" MISSING ", step.missing);
        if (!step.outputs.empty())
            out << ", writes";
        print(" ", step.outputs);
        out << '\n';
        if (step.frame)
            frames.push_back(*step.frame);
    }
    if (!frames.empty())
        out << frames.size() << (frames.size() == 1 ? " frame: " : " frames: ")
            << frames_text(frames) << '\n';
}

} // namespace vdb_shell::command
