// SPDX-License-Identifier: Apache-2.0

// Takes names of stages and their per cent; leaves lines on standard error with the share of the
// whole that is done. Nobody knows beforehand how long a stage will take, so shares are those of a
// usual build; what matters to who waits is that they grow and end at 1.

#include "command/progress.h"

#include <nlohmann/json.hpp>

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <exception>

namespace vdb_shell::command
{
namespace
{

struct StageShare {
    const char* name;
    double begins_at;
};

/// In the order of the pipeline. Means of nine surfaces of 12 to 40,000 triangles that were written
/// as .vdb; growth took 23 to 75 per cent of the time (docs/frames.md).
constexpr std::array<StageShare, 29> kStages{{{"read", 0.0},
                                              {"inspect", 0.02},
                                              {"filling holes", 0.02},
                                              {"mending", 0.03},
                                              {"wrap", 0.03},
                                              {"contour", 0.03},
                                              {"surface distance", 0.04},
                                              {"retriangulate", 0.04},
                                              {"decimate", 0.04},
                                              {"simplify", 0.04},
                                              {"remesh", 0.04},
                                              {"cores", 0.05},
                                              {"level set", 0.05},
                                              {"smooth", 0.11},
                                              {"line step", 0.11},
                                              {"grow", 0.14},
                                              {"pose", 0.14},
                                              {"refine triangles", 0.6},
                                              {"scale", 0.67},
                                              {"layers", 0.67},
                                              {"taper", 0.67},
                                              {"certificate", 0.68},
                                              {"overlaps", 0.7},
                                              {"coverage", 0.72},
                                              {"core fill", 0.74},
                                              {"write", 0.76},
                                              {"shell depth", 0.78},
                                              {"done", 1.0},
                                              {"failed", 1.0}}};

constexpr std::chrono::milliseconds kBetweenLines{200};

double seconds_since(std::chrono::steady_clock::time_point start)
{
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

double rounded(double value)
{
    constexpr double kSteps = 1000;
    return std::round(value * kSteps) / kSteps;
}

/// Where the next stage begins.
double share_after(const std::string& stage)
{
    const double begin = share_at(stage);
    for (const StageShare& other : kStages)
        if (other.begins_at > begin)
            return other.begins_at;
    return 1.0;
}

} // namespace

const NameTable<ProgressStyle>& names(ProgressStyle)
{
    static const NameTable<ProgressStyle> table{{"none", ProgressStyle::none},
                                                {"text", ProgressStyle::text},
                                                {"json", ProgressStyle::json}};
    return table;
}

double share_at(const std::string& stage)
{
    for (const StageShare& known : kStages)
        if (stage == known.name)
            return known.begins_at;
    return -1.0;
}

Progress::Progress(ProgressStyle style, std::ostream& err, std::size_t steps)
    : style_(style), err_(err), steps_(double(std::max<std::size_t>(steps, 1))),
      terminal_(::isatty(STDERR_FILENO) == 1)
{
}

void Progress::clear_line()
{
    if (line_shown_)
        err_ << "\r\033[K" << std::flush;
    line_shown_ = false;
}

/// As long again as it took so far, for what is left. Not told at the very beginning, where it
/// would jump.
double Progress::seconds_left(double share) const
{
    constexpr double kLeast = 0.05;
    return share < kLeast ? -1.0 : seconds_since(start_) * (1.0 - share) / share;
}

/// On a terminal one line is written over and over; into a file or a pipe a line for each stage, as
/// what was written cannot be taken back there.
void Progress::show_text(const StepProgress& step, double share)
{
    const std::string frame = step.frame_ ? "frame " + std::to_string(*step.frame_) + ": " : "";
    if (!terminal_) {
        // The last lines, of "done" and "failed", are said by who runs the steps.
        if (share_at(step.stage_) < 1.0)
            err_ << "vdb_shell: " + frame + step.stage_ + '\n';
        return;
    }
    clear_line();
    if (share >= 1.0)
        return;
    std::array<char, 64> figures{};
    const double left = seconds_left(share);
    std::snprintf(figures.data(), figures.size(), left < 0 ? "%3.0f %%" : "%3.0f %%, %.0f s left",
                  100 * share, left);
    err_ << "vdb_shell: " << figures.data() << ", " << frame << step.stage_ << std::flush;
    line_shown_ = true;
}

void Progress::show_json(const StepProgress& step, double share)
{
    nlohmann::ordered_json json{{"event", "progress"}};
    if (step.frame_)
        json["frame"] = *step.frame_;
    json["stage"] = step.stage_;
    json["share"] = rounded(share);
    json["seconds"] = rounded(seconds_since(start_));
    const double left = seconds_left(share);
    if (left >= 0)
        json["seconds_left"] = rounded(left);
    err_ << json.dump() + '\n' << std::flush;
}

void Progress::show(const StepProgress& step)
{
    const double share = std::min(done_ / steps_, 1.0);
    if (style_ == ProgressStyle::text)
        show_text(step, share);
    else if (style_ == ProgressStyle::json)
        show_json(step, share);
}

StepProgress::~StepProgress()
{
    try {
        advance(failed_ ? "failed" : "done", 1.0, true);
    } catch (const std::exception&) {
        stage_.clear(); // a line that cannot be shown is no reason to fail
    }
}

void StepProgress::stage(const std::string& name)
{
    if (name == stage_)
        return;
    advance(name, share_at(name), true);
}

void StepProgress::percent_of_stage(int percent)
{
    // OpenVDB's tools give -1 where they do not know how far they are.
    if (percent <= 0 || stage_.empty() || share_at(stage_) < 0)
        return;
    const double begin = share_at(stage_);
    advance(stage_, begin + (share_after(stage_) - begin) * std::min(percent, 100) / 100.0, false);
}

void StepProgress::clear_line_of(Progress& all)
{
    const std::lock_guard lock(all.mutex_);
    all.clear_line();
}

void StepProgress::advance(const std::string& stage, double share, bool at_once)
{
    const auto now = std::chrono::steady_clock::now();
    // Stages may report thousands of times a second; a person reads five lines.
    if (!at_once && now - shown_ < kBetweenLines)
        return;
    const std::lock_guard lock(all_.mutex_);
    // Lines for people who have no terminal are those of stages alone.
    const bool same_stage = stage == stage_;
    stage_ = stage;
    shown_ = now;
    // A stage may come more than once in a step, and some names have no share: what was shown is
    // not taken back.
    const double reached = std::max(share, share_);
    // By differences, since steps that run at the same time add to one sum.
    all_.done_ += reached - share_;
    share_ = reached;
    if (!same_stage || all_.terminal_ || all_.style_ == ProgressStyle::json)
        all_.show(*this);
}

} // namespace vdb_shell::command
