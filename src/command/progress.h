// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/options/name_table.h"

#include <chrono>
#include <cstddef>
#include <mutex>
#include <optional>
#include <ostream>
#include <string>

namespace vdb_shell::command
{

/// How the progress of a call is shown on standard error.
enum class ProgressStyle {
    none,
    text, ///< on a terminal one line that changes; else a line for each stage
    json  ///< one object a line
};
const NameTable<ProgressStyle>& names(ProgressStyle);

/// The share of the whole that is done when a stage of this name begins, as stages take it in a
/// usual build (docs/frames.md, "Progress"); less than 0 for an unknown name.
double share_at(const std::string& stage);

class StepProgress;

/// The progress of a call of one step or of many, several of which may run at once.
class Progress
{
public:
    Progress(ProgressStyle style, std::ostream& err, std::size_t steps);

private:
    friend class StepProgress;
    void clear_line();
    void show(const StepProgress& step);
    void show_text(const StepProgress& step, double share);
    void show_json(const StepProgress& step, double share);
    double seconds_left(double share) const;

    const ProgressStyle style_;
    std::ostream& err_;
    const double steps_;
    const bool terminal_;
    const std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
    std::mutex mutex_;
    double done_ = 0; ///< sum of the shares of all steps
    bool line_shown_ = false;
};

/// That of one step. The share never falls, and is 1 at the end.
class StepProgress
{
public:
    StepProgress(Progress& all, std::optional<int> frame) : all_(all), frame_(frame) {}
    ~StepProgress();
    StepProgress(const StepProgress&) = delete;
    StepProgress& operator=(const StepProgress&) = delete;

    /// From the thread that runs the step only.
    void stage(const std::string& name);
    void percent_of_stage(int percent);
    void failed() { failed_ = true; }
    /// Before anything else is printed.
    void clear_line() { clear_line_of(all_); }
    static void clear_line_of(Progress& all);

private:
    friend class Progress;
    void advance(const std::string& stage, double share, bool at_once);

    Progress& all_;
    const std::optional<int> frame_;
    const std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
    std::chrono::steady_clock::time_point shown_{};
    std::string stage_;
    double share_ = 0;
    bool failed_ = false;
};

} // namespace vdb_shell::command
