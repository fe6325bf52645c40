// SPDX-License-Identifier: Apache-2.0

// What is done of a sequence, in a file beside its outputs: of each step a fingerprint of all that
// went into it, and size and digest of what came out. It is no part of the outputs, since half of
// their formats have no place for it, and since a step that failed has no outputs at all. The file
// is replaced in one step, so a process that is killed leaves that of the step before; a step whose
// outputs came into their places in the same moment is done again, with the same bytes. Processes
// that share a manifest take turns by a lock on its folder: the file itself is another one after
// each write.

#include "command/manifest.h"

#include "command/file_plan.h"
#include "core/temporary_file.h"
#include "options/parse_json.h"
#include "options/shown_text.h"
#include "vdb_shell/core/digest.h"
#include "vdb_shell/core/error.h"
#include "vdb_shell/core/output_set.h"
#include "vdb_shell/io/read_file.h"

#include <nlohmann/json.hpp>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>

#include <cerrno>
#include <fstream>
#include <limits>
#include <string_view>
#include <type_traits>
#include <utility>

namespace vdb_shell::command
{
namespace
{

namespace fs = std::filesystem;
using nlohmann::ordered_json;

/// Raised when keys of the document change their meaning.
constexpr int kManifestSchema = 1;

fs::path folder_of(const fs::path& file)
{
    const fs::path folder = file.parent_path();
    return folder.empty() ? "." : folder;
}

/// Waits for its turn. File systems without locks have one process at a time.
class FolderLock
{
public:
    explicit FolderLock(const fs::path& folder)
        : folder_(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC))
    {
        while (folder_.number() >= 0 && ::flock(folder_.number(), LOCK_EX) != 0 && errno == EINTR) {
        }
    }

private:
    Descriptor folder_; // closing it ends the lock
};

ordered_json json_of(const std::vector<FileMark>& files)
{
    ordered_json json = ordered_json::array();
    for (const FileMark& file : files)
        json.push_back({{"file", file.path}, {"bytes", file.bytes}, {"xxh3", file.digest}});
    return json;
}

/// The whole number under that key. The parser's own conversion wraps what does not fit, and a
/// frame that became another one would be taken for done. `name` is that of the manifest.
template <typename Number>
Number whole_number(const ordered_json& json, const char* key, const std::string& name)
{
    const ordered_json& value = json.at(key);
    constexpr Number kLow = std::numeric_limits<Number>::min();
    constexpr Number kHigh = std::numeric_limits<Number>::max();
    bool fits = false;
    // The order matters: an unsigned number is an integer for this library too.
    if (value.is_number_unsigned())
        fits = value.get<std::uint64_t>() <= std::uint64_t(kHigh);
    else if (value.is_number_integer())
        fits = std::is_signed_v<Number> && value.get<std::int64_t>() >= std::int64_t(kLow);
    if (!fits)
        throw ReadError(
            name + ": " + key + " is " +
            shown_in_part(value.dump(-1, ' ', false, ordered_json::error_handler_t::replace)) +
            ", must be a whole number, " + std::to_string(kLow) + " to " + std::to_string(kHigh));
    return value.get<Number>();
}

std::vector<FileMark> marks_of(const ordered_json& json, const std::string& name)
{
    std::vector<FileMark> files;
    for (const ordered_json& file : json)
        files.push_back({file.at("file").get<std::string>(),
                         whole_number<std::uint64_t>(file, "bytes", name),
                         file.at("xxh3").get<std::string>()});
    return files;
}

ordered_json json_of(const ManifestEntry& entry)
{
    ordered_json json;
    // Null, so that every entry has the key and a reader need not ask for it.
    json["frame"] = entry.frame ? ordered_json(*entry.frame) : ordered_json();
    json["status"] = entry.status;
    if (!entry.error.empty())
        json["error"] = entry.error;
    json["fingerprint"] = entry.fingerprint;
    json["voxel_size"] = entry.voxel_size ? ordered_json(*entry.voxel_size) : ordered_json();
    json["inputs"] = json_of(entry.inputs);
    json["outputs"] = json_of(entry.outputs);
    return json;
}

/// `name` is that of the manifest.
ManifestEntry entry_of(const ordered_json& json, const std::string& name)
{
    ManifestEntry entry;
    if (!json.at("frame").is_null())
        entry.frame = whole_number<int>(json, "frame", name);
    entry.status = whole_number<int>(json, "status", name);
    entry.error = json.value("error", "");
    entry.fingerprint = json.at("fingerprint").get<std::string>();
    if (!json.at("voxel_size").is_null())
        entry.voxel_size = json.at("voxel_size").get<double>();
    entry.inputs = marks_of(json.at("inputs"), name);
    entry.outputs = marks_of(json.at("outputs"), name);
    return entry;
}

/// Throws what values of another kind throw; callers say of which file (with_file).
ordered_json parsed(const fs::path& file)
{
    // Demands a regular file: a pipe would wait for a writer for ever.
    ordered_json json =
        parse_json(read_whole_file(file), file.string(), "is no manifest of vdb_shell");
    // Keys of another schema could mean something else, and a frame that is taken for done is never
    // looked at again.
    if (const int schema = whole_number<int>(json, "schema", file.string());
        schema != kManifestSchema)
        throw ReadError(file.string() + ": schema is " + std::to_string(schema) + ", must be " +
                        std::to_string(kManifestSchema));
    return json;
}

std::string json_text(const ordered_json& json)
{
    return json.dump(1, ' ', false, ordered_json::error_handler_t::replace);
}

/// All lines but the first.
std::string indented(const std::string& text, std::size_t by)
{
    std::string out;
    for (const char c : text) {
        out += c;
        if (c == '\n')
            out.append(by, ' ');
    }
    return out;
}

/// What the parser throws says nothing of the file.
template <typename Body> auto with_file(const fs::path& file, const Body& body)
{
    try {
        return body();
    } catch (const ordered_json::exception& error) {
        throw ReadError(file.string() + ": is no manifest of vdb_shell: " + error.what());
    }
}

} // namespace

bool FileMark::operator==(const FileMark& other) const
{
    return path == other.path && bytes == other.bytes && digest == other.digest;
}

FileMark mark_of(const fs::path& file)
{
    std::ifstream in(file, std::ios::binary);
    FileMark mark{file.string(), 0, ""};
    Digest digest;
    // A mebibyte at a time: outputs may be larger than memory.
    std::vector<char> buffer(std::size_t(1) << 20U);
    while (in.read(buffer.data(), std::streamsize(buffer.size())) || in.gcount() > 0) {
        digest.add(buffer.data(), std::size_t(in.gcount()));
        mark.bytes += std::uint64_t(in.gcount());
    }
    // A disk that fails in the middle of a file ends the loop just as its end does.
    if (!in.eof())
        throw ReadError(file.string() + ": cannot be read");
    mark.digest = digest.hex();
    return mark;
}

Manifest::Manifest(fs::path file, std::string command)
    : file_(std::move(file)), command_(std::move(command)), entries_(read())
{
}

std::string Manifest::command_in(const fs::path& file)
{
    return with_file(file, [&] { return parsed(file).at("command").get<std::string>(); });
}

/// A file that is not there yet is a manifest without entries.
Manifest::Entries Manifest::read() const
{
    std::error_code unknown;
    // Where even that cannot be asked, reading it says why.
    if (!fs::exists(file_, unknown) && !unknown)
        return {};
    return with_file(file_, [&] {
        const ordered_json json = parsed(file_);
        // Frame 7 of another command is another thing, and one of the two would be lost.
        if (json.at("command").get<std::string>() != command_)
            throw ReadError(file_.string() + ": is the manifest of `" +
                            json.at("command").get<std::string>() + "`, not of `" + command_ + "`");
        Entries entries;
        for (const ordered_json& step : json.at("steps")) {
            ManifestEntry entry = entry_of(step, file_.string());
            const std::optional<int> frame = entry.frame;
            entries[frame] = {std::move(entry), ""};
        }
        return entries;
    });
}

std::optional<ManifestEntry> Manifest::find(std::optional<int> frame) const
{
    const std::lock_guard lock(mutex_);
    const auto found = entries_.find(frame);
    return found == entries_.end() ? std::nullopt : std::optional(found->second.entry);
}

/// The manifest and its outputs may be moved together.
std::string Manifest::relative(const fs::path& file) const
{
    const fs::path folder = absolute_path(folder_of(file_));
    return absolute_path(file).lexically_relative(folder).generic_string();
}

FileMark Manifest::mark_output(const fs::path& file) const
{
    FileMark mark = mark_of(file);
    mark.path = relative(file);
    return mark;
}

bool Manifest::outputs_are_there(const ManifestEntry& entry,
                                 const std::vector<fs::path>& outputs) const
{
    if (entry.outputs.size() != outputs.size())
        return false;
    for (std::size_t i = 0; i < outputs.size(); ++i) {
        // The size first, for it costs nothing.
        std::error_code gone;
        if (entry.outputs[i].path != relative(outputs[i]) ||
            fs::file_size(outputs[i], gone) != entry.outputs[i].bytes || gone ||
            !(mark_output(outputs[i]) == entry.outputs[i]))
            return false;
    }
    return true;
}

/// The mutex keeps threads of this process apart, the lock of the folder other processes.
void Manifest::put(const ManifestEntry& entry)
{
    const std::lock_guard lock(mutex_);
    const FolderLock turn(folder_of(file_));
    // Others may have noted theirs meanwhile.
    read_if_changed();
    entries_[entry.frame] = {entry, ""};
    write();
}

fs::path Manifest::place_of(const FileMark& output) const
{
    return folder_of(file_) / output.path;
}

void Manifest::put_all_of(const std::deque<Manifest>& others)
{
    const std::lock_guard lock(mutex_);
    const FolderLock turn(folder_of(file_));
    read_if_changed();
    for (const Manifest& other : others)
        for (const auto& [frame, known] : other.entries_) {
            // Names of outputs are relative to the manifest, and this one may stand elsewhere.
            Known& own = entries_[frame] = {known.entry, ""};
            for (FileMark& output : own.entry.outputs)
                output.path = relative(other.place_of(output));
        }
    write();
}

std::string Manifest::lost_output(const ManifestEntry& entry) const
{
    for (const FileMark& output : entry.outputs) {
        std::error_code gone;
        if (fs::file_size(place_of(output), gone) != output.bytes || gone)
            return place_of(output).lexically_normal().string();
    }
    return "";
}

/// Opened for it, since network file systems ask their server when a file is opened, and not when
/// its name is looked up.
std::optional<Manifest::FileState> Manifest::state() const
{
    const Descriptor file(::open(file_.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
    struct stat found;
    if (file.number() < 0 || ::fstat(file.number(), &found) != 0)
        return std::nullopt;
    const timespec written = found.st_mtim, changed = found.st_ctim;
    return FileState(found.st_dev, found.st_ino, found.st_size, written.tv_sec, written.tv_nsec,
                     changed.tv_sec, changed.tv_nsec);
}

/// Reading is what takes the time where there are thousands of steps. Precondition: it is this
/// process' turn, or the file could change in between.
void Manifest::read_if_changed()
{
    const std::optional<FileState> now = state();
    if (!now || now != written_)
        entries_ = read();
}

void Manifest::write()
{
    ordered_json json;
    json["schema"] = kManifestSchema;
    // Says to a person what wrote the file; no reader asks for it.
    json["program"] = "vdb_shell";
    json["version"] = VDB_SHELL_VERSION;
    json["command"] = command_;
    json["steps"] = ordered_json::array();
    std::string text = json_text(json);
    // The texts of the steps go between the brackets at the end, each made once only.
    constexpr std::string_view kEnd = "]\n}";
    text.resize(text.size() - kEnd.size());
    const char* between = "\n  ";
    for (auto& [frame, known] : entries_) {
        if (known.text.empty())
            known.text = indented(json_text(json_of(known.entry)), 2);
        text.append(between).append(known.text);
        between = ",\n  ";
    }
    text.append(entries_.empty() ? "" : "\n ").append(kEnd).append("\n");
    OutputSet files;
    // By a set of files as every output: replaced whole, or left as it was.
    files.write_stream(file_, [&](std::ostream& out) { out << text; });
    files.commit();
    written_ = state();
}

} // namespace vdb_shell::command
