// SPDX-License-Identifier: Apache-2.0

// A job to one script. Slurm copies a script away before it runs it, so nothing in it depends on
// where it stands; only the job that joins is submitted with the file itself. Names are between
// single quotes everywhere, so none of them can become a command.

#include "command/farm_slurm.h"

#include "command/frames.h"
#include "command/shell_words.h"
#include "core/text_stream.h"

#include <cmath>

namespace vdb_shell::command
{
namespace
{

/// Between the words of sbatch's own lines and the tasks; the same for every job.
constexpr const char* kFunctions = R"(
threads=${SLURM_CPUS_PER_TASK:-$cpus}
status=0

# STATUS: a task whose command was killed (137), say by the kernel, goes back into the queue: what it
# noted as done is left out the next time. One that was asked to stop, or crashed, does not.
give_back() {
    if [ "$1" -eq 137 ] && [ -n "${SLURM_ARRAY_JOB_ID:-}" ] &&
        [ "${SLURM_RESTART_COUNT:-0}" -lt "$retries" ]; then
        echo "$name: task $SLURM_ARRAY_TASK_ID was killed, back into the queue" >&2
        scontrol requeue "${SLURM_ARRAY_JOB_ID}_$SLURM_ARRAY_TASK_ID"
    fi
    exit "$1"
}

# PART FRAMES WORDS...: runs the command once, with a manifest of its own.
run() {
    local part=$1 frames=$2 state=0
    shift 2
    local own=(--threads "$threads" --resume --manifest "$folder/$part.json")
    [ -z "$frames" ] || own+=(--frames "$frames" --keep-going)
    "$program" "${own[@]}" "$@" || state=$?
    [ "$state" -lt 128 ] || give_back "$state"
    [ "$status" -ne 0 ] || status=$state
}

# OUTPUT FRAMES PARTS...: one manifest of all parts, and what is missing in it.
join_parts() {
    local whole=$1 frames=$2 state=0
    shift 2
    "$program" join -o "$whole" ${frames:+"--expect=$frames"} "$@" || state=$?
    calls=$((calls + 1))
    [ "$state" -ne 0 ] || whole_calls=$((whole_calls + 1))
    [ "$status" -ne 0 ] || status=$state
}

join() {
    mkdir -p "$folder" || exit 5
    calls=0 whole_calls=0
    join_all
    echo "$name: $whole_calls of $calls calls are whole"
}

# OPTIONS...: for sbatch. Prints the number of the array, and of the job that joins.
submit() {
    local array last
    mkdir -p "$folder" || exit 5
    array=$(sbatch --parsable --output="${folder//%/%%}/%a.log" "$@" "$0") || exit
    # What comes last holds. The lines for sbatch say that it is an array, so this is one of a task.
    last=$(sbatch --parsable "$@" --output="${folder//%/%%}/join.log" --job-name="$name-join" \
        --dependency="afterany:${array%%;*}" --array=0 --cpus-per-task=1 $wait "$0" join)
    state=$?
    echo "${array%%;*} ${last%%;*}"
    return "$state"
}
)";

/// What the script is asked for: the first word says it; without one a task of an array runs
/// itself, and a person is shown the lines at the top of the file.
constexpr const char* kRoles = R"(
here() {
    mkdir -p "$folder" || exit 5
    cd "$home" || exit 3
    task "$1"
}

role=${1:-}
[ $# -eq 0 ] || shift
wait=
case ${role:-${SLURM_ARRAY_TASK_ID:+run}} in
submit) submit "$@" || exit ;;
wait)
    wait=--wait
    submit "$@"
    status=$?
    cat "$folder/join.log"
    ;;
run) here "$SLURM_ARRAY_TASK_ID" ;;
task) here "${1:?which task}" ;;
join) join ;;
*)
    sed -n '2,/^#SBATCH/{/^#SBATCH/!s/^# \{0,1\}//p}' "$0" >&2
    exit 2
    ;;
esac
exit "$status"
)";

void write_directives(std::ostream& out, const FarmJob& job)
{
    const FarmLimits& limits = job.limits;
    constexpr double kMibPerGib = 1024;
    out << "#SBATCH --job-name=" << job.name << "\n#SBATCH --array=0-" << job.tasks.size() - 1;
    if (limits.at_once > 0)
        out << '%' << limits.at_once;
    out << "\n#SBATCH --cpus-per-task=" << limits.cpus << '\n';
    if (limits.memory_gib)
        // Whole mebibytes and minutes, rounded up: sbatch takes no fractions.
        out << "#SBATCH --mem=" << std::lround(std::ceil(*limits.memory_gib * kMibPerGib)) << "M\n";
    if (limits.minutes)
        out << "#SBATCH --time=" << std::lround(std::ceil(*limits.minutes)) << '\n';
    // A task that is put back goes on in the same log, so that the reason of its first end is not
    // lost.
    out << "#SBATCH --requeue\n#SBATCH --open-mode=append\n";
}

/// All that differs from job to job as variables, so that the functions are the same in every
/// script.
void write_values(std::ostream& out, const FarmJob& job)
{
    out << "\nset -u\nname=" << quoted(job.name) << "\nprogram=" << quoted(job.program)
        << "\nhome=" << quoted(job.home.string()) << "\nfolder=" << quoted(job.folder.string())
        << "\ncpus=" << job.limits.cpus << "\nretries=" << job.limits.retries << '\n';
}

void write_calls(std::ostream& out, const FarmJob& job)
{
    out << '\n';
    for (std::size_t c = 0; c < job.calls.size(); ++c) {
        // A function for each call, as a call has many tasks and its words are written once.
        out << "call_" << c << "() { run \"$1\" \"$2\"";
        for (const std::string& word : job.calls[c].words)
            out << ' ' << quoted(word);
        out << "; }\n";
    }
}

/// What each number of the array is to do. A task of several calls runs one after the other.
void write_tasks(std::ostream& out, const FarmJob& job)
{
    out << "\ntask() {\n    case $1 in\n";
    for (std::size_t t = 0; t < job.tasks.size(); ++t) {
        out << "    " << t << ")";
        for (const FarmRun& run : job.tasks[t])
            out << (job.tasks[t].size() > 1 ? "\n        " : " ") << "call_" << run.call << ' '
                << run.call << '-' << run.part << ' ' << quoted(frames_text(run.frames));
        out << " ;;\n";
    }
    out << "    *)\n        echo \"$name: no task $1\" >&2\n        exit 2\n        ;;\n"
           "    esac\n}\n";
}

/// One manifest of parts for each call. bash makes their names of a range, for a call may have a
/// thousand parts.
void write_joins(std::ostream& out, const FarmJob& job)
{
    std::vector<std::size_t> parts(job.calls.size(), 0);
    for (const FarmTask& task : job.tasks)
        for (const FarmRun& run : task)
            ++parts[run.call];
    out << "\njoin_all() {\n";
    for (std::size_t c = 0; c < job.calls.size(); ++c) {
        const FarmCall& call = job.calls[c];
        out << "    join_parts " << quoted(call.manifest.string()) << ' '
            << quoted(frames_text(call.frames)) << " \"$folder\"/" << c << '-';
        if (parts[c] > 1)
            out << "{0.." << parts[c] - 1 << '}';
        else
            out << '0';
        out << ".json\n";
    }
    out << "}\n";
}

} // namespace

/// Lines for sbatch have to stand before the first command; functions before what calls them.
std::string slurm_script(const FarmJob& job, const std::string& file)
{
    OutText out;
    const std::string call = "bash " + quoted(file);
    out << "#!/bin/bash\n# " << job.name << ": " << job.steps() << " frames or runs of "
        << job.calls.size() << (job.calls.size() == 1 ? " call" : " calls") << " in "
        << job.tasks.size() << " tasks. Written by vdb_shell " VDB_SHELL_VERSION ".\n#\n#   "
        << call << " submit [OPTIONS OF SBATCH]   the tasks, and behind them a job that joins\n#   "
        << call << " wait [OPTIONS OF SBATCH]     the same; ends with what the join says\n#   "
        << call << " task N                       one task, here\n#   " << call
        << " join                         what is done, failed, missing\n";
    write_directives(out, job);
    write_values(out, job);
    out << kFunctions;
    write_calls(out, job);
    write_tasks(out, job);
    write_joins(out, job);
    out << kRoles;
    return out.str();
}

} // namespace vdb_shell::command
