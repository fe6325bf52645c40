// SPDX-License-Identifier: Apache-2.0

// Takes the paths of a call, as they were given; leaves the proof that no output destroys an input
// or another output, or a refusal that names both. It is asked before the work begins. What others
// do to the files meanwhile it cannot know: renames at the end never follow a link.

#include "command/file_plan.h"

#include "core/output_target.h"
#include "vdb_shell/core/error.h"
#include "vdb_shell/core/words.h"

#include <unistd.h>

#include <array>
#include <tuple>

namespace vdb_shell::command
{
namespace
{

namespace fs = std::filesystem;

/// True where one of the two streams goes to this very file: `> report.json`.
bool takes_a_stream(const struct stat& file)
{
    for (const int stream : {STDOUT_FILENO, STDERR_FILENO}) {
        struct stat status {
        };
        // A rename would leave the stream writing into a file that has no name any more. Devices
        // keep their place, so they are no matter.
        if (S_ISREG(file.st_mode) && ::fstat(stream, &status) == 0 &&
            status.st_dev == file.st_dev && status.st_ino == file.st_ino)
            return true;
    }
    return false;
}

} // namespace

bool FilePlan::Identity::operator==(const Identity& other) const
{
    return device == other.device && inode == other.inode && name == other.name;
}

bool FilePlan::Identity::operator<(const Identity& other) const
{
    return std::tie(device, inode, name) < std::tie(other.device, other.inode, other.name);
}

std::optional<FilePlan::Identity> FilePlan::identity_of(const fs::path& path)
{
    struct stat status {
    };
    // Follows links: what counts is which bytes are read or replaced.
    if (::stat(path.c_str(), &status) != 0)
        return std::nullopt;
    return Identity{status.st_dev, status.st_ino, ""};
}

const FilePlan::Entry* FilePlan::find(const std::vector<Entry>& entries, const Identity& identity)
{
    for (const Entry& entry : entries)
        if (entry.identity == identity)
            return &entry;
    return nullptr;
}

void FilePlan::add_input(const fs::path& path)
{
    if (is_standard_input(path)) {
        if (standard_input_)
            throw InvalidOption("-: standard input is given twice");
        standard_input_ = true;
        return;
    }
    const std::optional<Identity> identity = identity_of(path);
    if (!identity) {
        // An option that was left out; so callers add all paths without asking.
        if (!path.empty())
            missing_.push_back(path);
        return;
    }
    // Points of a shell may stand in a file that is only known when outputs have been added
    // (read_shell_info), so both are asked whichever comes first.
    if (const Entry* output = find(outputs_, *identity))
        throw InvalidOption(output->path.string() + ": is the input " + path.string() +
                            "; it is not overwritten");
    inputs_.push_back({path, *identity, false});
}

void FilePlan::add_output(const fs::path& path)
{
    // Where the bytes will go: behind links, and with the reason told where nothing can be written.
    const OutputTarget target = find_output_target(path);
    std::optional<Identity> identity = identity_of(target.path);
    if (!identity) {
        identity = identity_of(target.folder());
        if (!identity)
            refuse_output(path, "its folder does not exist");
        // A file that is not there has no inode. Its folder has, and within a folder a name is
        // unique.
        identity->name = target.path.filename().string();
    }
    if (const Entry* input = find(inputs_, *identity))
        throw InvalidOption(path.string() + ": is the input " + input->path.string() +
                            "; it is not overwritten");
    if (const Entry* output = find(outputs_, *identity))
        throw InvalidOption(path.string() + ": given twice as an output, the other time as " +
                            output->path.string());
    if (target.existing && takes_a_stream(*target.existing))
        throw InvalidOption(path.string() +
                            ": standard output or standard error goes to this file already");
    if (target.existing && !target.special && existing_ == Existing::kept)
        refuse_output(path, "it exists, and is to be kept (--no-clobber)");
    outputs_.push_back({path, *identity, target.special});
}

fs::path current_folder()
{
    std::error_code gone;
    fs::path folder = fs::current_path(gone);
    if (gone)
        throw ReadError("the folder of this call is gone, or cannot be named: " + gone.message());
    return folder;
}

fs::path absolute_path(const fs::path& path)
{
    return (path.is_absolute() ? path : current_folder() / path).lexically_normal();
}

bool is_standard_input(const fs::path& path)
{
    return path == "-";
}

void require_extension(const fs::path& path, const std::string& extension)
{
    if (lower_case_extension(path) != extension)
        throw InvalidOption(path.string() + ": the extension is not " + extension);
}

bool is_standard_output(const fs::path& path)
{
    static const std::array<const char*, 4> names{"-", "/dev/stdout", "/dev/fd/1",
                                                  "/proc/self/fd/1"};
    for (const char* name : names)
        if (path == name)
            return true;
    return false;
}

Option no_clobber_option(bool& keep)
{
    return option("", keep, "--no-clobber",
                  "Refuse to replace files that exist, before the work and after it");
}

Existing existing_files(bool keep)
{
    return keep ? Existing::kept : Existing::replaced;
}

FilePlan plan_reading(const std::filesystem::path& file)
{
    FilePlan plan(Existing::replaced);
    plan.add_input(file);
    return plan;
}

} // namespace vdb_shell::command
