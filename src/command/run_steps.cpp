// SPDX-License-Identifier: Apache-2.0

// Runs the steps of a call. An error ends its own step; what it means for the others is said by
// --keep-going. Where surfaces are small, a frame keeps several processors busy only now and then,
// so several frames run at once, each in a part of the threads. The first frame is always alone,
// for it may fix a voxel size for the others. No byte of a result depends on any of that.

#include "command/run_steps.h"

#include "vdb_shell/core/digest.h"
#include "vdb_shell/core/error.h"

#include "command/error_status.h"
#include "command/exit_code.h"
#include "command/frames.h"
#include "command/manifest.h"
#include "command/progress.h"
#include "command/signals.h"
#include "core/available_memory.h"
#include "core/parallel.h"
#include "core/text_stream.h"

#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <mutex>
#include <system_error>
#include <thread>
#include <utility>

namespace vdb_shell::command
{
namespace
{

namespace fs = std::filesystem;

/// Bytes of a frame's inputs up to which frames run at once: some 200,000 triangles as text. For
/// those it was measured to be faster (docs/frames.md); larger ones need gigabytes each.
constexpr std::uintmax_t kSmallInputs = 8U << 20U;
/// Memory of a frame: some 40 MiB, and 60 bytes for each of its inputs (as measured), rounded up.
constexpr double kFrameMemory = 64.0 * (1U << 20U), kMemoryPerByte = 70;

std::string seconds_text(std::chrono::steady_clock::time_point start)
{
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%.2f s", seconds.count());
    return text.data();
}

/// Files that cannot be looked at count as none: running them will say what is wrong.
std::uintmax_t bytes_of_inputs(const Step& step)
{
    std::uintmax_t bytes = 0;
    for (const fs::path& input : step.inputs) {
        std::error_code unknown;
        const std::uintmax_t size = fs::file_size(input, unknown);
        bytes += unknown ? 0 : size;
    }
    return bytes;
}

std::size_t frames_at_once(const std::vector<Step>& steps, const GlobalArguments& global)
{
    if (global.frames_at_once > 0)
        return std::size_t(global.frames_at_once);
    std::uintmax_t largest = 0;
    for (const Step& step : steps)
        largest = std::max(largest, bytes_of_inputs(step));
    // The largest one decides for all, as it is not known which frames will be at work together.
    if (largest > kSmallInputs)
        return 1;
    // Half of what is free, for other programs want some too.
    const double fit = 0.5 * available_memory() / (kFrameMemory + kMemoryPerByte * double(largest));
    return fit < double(thread_count()) ? std::size_t(std::max(fit, 1.0)) : thread_count();
}

/// A thread that is not joined ends the process, so they are joined however their scope is left.
struct Workers {
    std::vector<std::thread> threads;

    Workers() = default;
    Workers(const Workers&) = delete;
    Workers& operator=(const Workers&) = delete;
    ~Workers()
    {
        for (std::thread& thread : threads)
            thread.join();
    }
};

class Runner
{
public:
    Runner(const std::vector<Step>& steps, const GlobalArguments& global, const Context& context)
        : steps_(steps), global_(global), context_(context), results_(steps.size())
    {
        if (!global.manifest.empty())
            manifest_.emplace(global.manifest, steps.front().command);
        if (global.progress != ProgressStyle::none)
            progress_.emplace(global.progress, context.err, steps.size());
    }

    int run()
    {
        // Even where many could run at once: the first one may fix the voxel size for the others.
        run_alone();
        const std::size_t at_once =
            std::min(frames_at_once(steps_, global_), steps_.size() - next_.load());
        if (at_once > 1 && !stop_)
            run_at_once(at_once);
        else
            while (!stop_ && next_ < steps_.size())
                run_in_order(next_++);
        return ended();
    }

private:
    struct Result {
        int status = success;
        bool begun = false, done = false, left_out = false;
        /// What it has said, until all before it have been printed.
        std::string out, err;
    };

    /// The first steps, until one has gone through and what they have in common is known.
    void run_alone()
    {
        while (!stop_ && next_ < steps_.size()) {
            const std::size_t i = next_++;
            run_in_order(i);
            // One that failed may have failed before it chose the voxels. Then the next one is
            // alone too.
            if (sequence_.voxel_size || results_[i].status == success)
                return;
        }
    }

    void run_in_order(std::size_t i)
    {
        Context context = context_;
        run_step(i, context);
        context.out.flush();
        if (!context.out)
            stop_ = true; // whoever reads the figures is gone
    }

    void run_at_once(std::size_t at_once)
    {
        // What ran alone has printed by itself.
        printed_ = next_;
        const std::size_t threads = std::max<std::size_t>(thread_count() / at_once, 1);
        {
            Workers workers;
            try {
                for (std::size_t w = 0; w < at_once; ++w)
                    workers.threads.emplace_back([this, threads] { work(threads); });
            } catch (const std::system_error&) {
                // The system gives no more of them. Those that there are do all frames, if later.
            }
            if (workers.threads.empty())
                work(threads);
        }
        print_finished();
        if (thrown_)
            std::rethrow_exception(thrown_);
    }

    void take_frames()
    {
        while (!stop_) {
            const std::size_t i = next_++;
            if (i >= steps_.size())
                return;
            OutText out, err;
            // What it says is kept until all frames before it have been printed; so the text of a
            // call is the same however many run at once.
            Context context{out, err, context_.level, context_.format, std::nullopt};
            run_step(i, context);
            const std::lock_guard lock(mutex_);
            results_[i].out = out.str();
            results_[i].err = err.str();
            results_[i].done = true;
            print_finished();
        }
    }

    void work(std::size_t threads)
    {
        try {
            // A frame's parallel loops stay in its arena, so that frames do not wait for each
            // other's.
            tbb::task_arena arena(static_cast<int>(threads));
            arena.execute([&] { take_frames(); });
        } catch (...) {
            const std::lock_guard lock(mutex_);
            // An exception must not leave a thread. Only what ends the whole call comes here;
            // errors of frames are results.
            thrown_ = std::current_exception();
            stop_ = true;
        }
    }

    /// Whatever is next in the order of the frames.
    void print_finished()
    {
        while (printed_ < results_.size() && results_[printed_].done) {
            Result& result = results_[printed_++];
            context_.out << result.out << std::flush;
            // The line of the progress stands where the text would go.
            if (progress_ && !result.err.empty())
                StepProgress::clear_line_of(*progress_);
            context_.err << result.err << std::flush;
            result.out.clear();
            result.err.clear();
        }
    }

    /// What ends a call with an error ends one step here; a signal ends the call.
    void run_step(std::size_t i, Context& context)
    {
        const Step& step = steps_[i];
        Result& result = results_[i];
        const auto start = std::chrono::steady_clock::now();
        context.frame = step.frame;
        context.gathered = step.gathered;
        // A single call has nothing to share, and would only keep in memory what nobody asks for
        // again.
        context.sequence = step.frame ? &sequence_ : nullptr;
        std::optional<StepProgress> progress;
        if (progress_)
            context.progress = &progress.emplace(*progress_, step.frame);
        result.begun = true;
        try {
            result.status = status_of_step(step, context, result.left_out);
            progress.reset();
            context.progress = nullptr;
            if (step.frame && !result.left_out)
                context.say(LogLevel::info,
                            (result.status == success
                                 ? "done in "
                                 : "ended with status " + std::to_string(result.status) + " in ") +
                                seconds_text(start));
        } catch (const std::exception& error) {
            if (progress)
                progress->failed();
            // A single call ends as it does without steps: main tells the error and its status.
            if (!step.frame || dynamic_cast<const Cancelled*>(&error))
                throw;
            context.say(error);
            result.status = command::status_of(error);
        }
        // Frames that have begun go on to their end; none begins after it.
        if ((result.status != success && !global_.keep_going) || caught_signal())
            stop_ = true;
    }

    int status_of_step(const Step& step, Context& context, bool& left_out)
    {
        Call call(step.command);
        call.parse(step.words);
        // Planned anew: the plan of the whole sequence was made minutes or hours ago.
        const FilePlan plan = call.plan();
        if (!manifest_)
            return run_call(step, call, context);
        // Before the run, for the digests are to be those of the inputs that the run is given.
        ManifestEntry entry = entry_for(step, call, plan);
        if (global_.resume) {
            const std::optional<ManifestEntry> known = up_to_date(entry, step);
            if (known) {
                left_out = true;
                context.say(LogLevel::info, "left out, its outputs are up to date");
                // A frame that is left out fixes the voxels as it would have if it had run.
                if (!sequence_.voxel_size && known->voxel_size)
                    sequence_.voxel_size = known->voxel_size;
                return known->status;
            }
        }
        try {
            entry.status = run_call(step, call, context);
        } catch (const Cancelled&) {
            throw;
        } catch (const std::exception& error) {
            entry.status = command::status_of(error);
            entry.error = message_of(error);
            manifest_->put(entry);
            throw;
        }
        // After the run, which may have fixed it.
        entry.voxel_size = sequence_.voxel_size;
        for (const FilePlan::Entry& output : plan.outputs())
            // What went into a pipe is gone, and cannot be asked for its digest.
            if (!output.special)
                entry.outputs.push_back(manifest_->mark_output(output.path));
        manifest_->put(entry);
        return entry.status;
    }

    static int run_call(const Step& step, Call& call, Context& context)
    {
        if (step.frame && !step.missing.empty())
            throw ReadError(step.missing.front().string() + ": is not there");
        return call.run(context);
    }

    static ManifestEntry entry_for(const Step& step, const Call& call, const FilePlan& plan)
    {
        ManifestEntry entry;
        entry.frame = step.frame;
        Digest digest;
        // Another version may write other bytes.
        digest.add_text(VDB_SHELL_VERSION);
        digest.add_text(call.options_text());
        for (const FilePlan::Entry& input : plan.inputs()) {
            if (!fs::is_regular_file(input.path))
                throw InvalidOption(input.path.string() +
                                    ": can be read only once, and --manifest needs its digest");
            entry.inputs.push_back(mark_of(input.path));
            // By what is in them, in their order. Names of inputs do not count, but as options_text
            // has them.
            digest.add_text(entry.inputs.back().digest);
        }
        entry.fingerprint = digest.hex();
        return entry;
    }

    /// What is known of the step, if it went through with the same inputs and options, and if its
    /// outputs are still what they were.
    std::optional<ManifestEntry> up_to_date(const ManifestEntry& wanted, const Step& step) const
    {
        std::optional<ManifestEntry> known = manifest_->find(step.frame);
        // The voxel size is no option of the frame, so the fingerprint does not know it.
        const bool same_voxels = known && (!sequence_.voxel_size || !known->voxel_size ||
                                           *known->voxel_size == *sequence_.voxel_size);
        if (!known || !known->error.empty() || known->fingerprint != wanted.fingerprint ||
            !same_voxels || !manifest_->outputs_are_there(*known, step.outputs))
            return std::nullopt;
        return known;
    }

    /// The status of the call, and the count of its frames.
    int ended() const
    {
        int first = success;
        std::vector<int> failed;
        std::size_t begun = 0, left_out = 0;
        for (std::size_t i = 0; i < steps_.size(); ++i) {
            const Result& result = results_[i];
            begun += result.begun ? 1 : 0;
            left_out += result.left_out && result.status == success ? 1 : 0;
            if (result.status == success)
                continue;
            // In the order of --frames, and not in that of time, so that it is the same for any
            // number of threads.
            first = first == success ? result.status : first;
            failed.push_back(steps_[i].frame.value_or(0));
        }
        if (!steps_.front().frame)
            return first;
        std::string text = std::to_string(begun - left_out - failed.size()) + " of " +
                           std::to_string(steps_.size()) + " frames done";
        if (left_out > 0)
            text += ", left out: " + std::to_string(left_out);
        if (!failed.empty())
            text += ", failed: " + frames_text(failed);
        if (begun < steps_.size())
            text += ", not begun: " + std::to_string(steps_.size() - begun);
        context_.say(failed.empty() ? LogLevel::info : LogLevel::error, text);
        return first;
    }

    const std::vector<Step>& steps_;
    const GlobalArguments& global_;
    const Context& context_;
    std::optional<Manifest> manifest_;
    std::optional<Progress> progress_;
    Sequence sequence_;
    std::vector<Result> results_;
    /// The first step that nobody has begun, and whether none is to be begun any more.
    std::atomic<std::size_t> next_{0};
    std::atomic<bool> stop_{false};
    std::mutex mutex_; ///< of what follows, and of results' texts
    std::size_t printed_ = 0;
    std::exception_ptr thrown_;
};

} // namespace

int run_steps(const std::vector<Step>& steps, const GlobalArguments& global, const Context& context)
{
    return Runner(steps, global, context).run();
}

} // namespace vdb_shell::command
