// SPDX-License-Identifier: Apache-2.0

// The bytes of a file as a whole, and the wording of all refusals. Files are read whole because the
// scans work on views into the bytes, without copying words. Kinds of file are told apart before
// anything is opened: a pipe would wait for a writer, and a folder can be opened on some systems.
// What was read is held against the size, so a file that cannot be read to its end is refused.

#include "vdb_shell/io/read_file.h"

#include "vdb_shell/core/error.h"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <system_error>

namespace vdb_shell
{

namespace fs = std::filesystem;

std::string read_whole_file(const fs::path& path)
{
    const std::string name = path.string();
    std::error_code error;
    const fs::file_status status = fs::status(path, error);
    // A file in a folder that may not be searched, say, may well be there.
    if (error && error != std::errc::no_such_file_or_directory &&
        error != std::errc::not_a_directory)
        refuse(name, "it cannot be opened: " + error.message());
    if (!fs::exists(status))
        refuse(name, "there is no such file");
    if (fs::is_directory(status))
        refuse(name, "it is a folder, not a file");
    if (!fs::is_regular_file(status))
        refuse(name, "it is not a regular file");
    // A folder or a pipe can be opened as well, but has no size to read.
    errno = 0;
    std::ifstream in(path, std::ios::binary);
    if (!in)
        refuse(name, std::string("it cannot be opened: ") + std::strerror(errno));
    const std::uintmax_t size = fs::file_size(path, error);
    if (error)
        refuse(name, "it cannot be opened: " + error.message());
    std::string bytes(size, '\0');
    in.read(bytes.data(), static_cast<std::streamsize>(size));
    if (static_cast<std::uintmax_t>(in.gcount()) != size)
        refuse(name, "only " + std::to_string(in.gcount()) + " of its " + std::to_string(size) +
                         " bytes can be read");
    if (bytes.empty())
        refuse(name, "the file is empty");
    return bytes;
}

void refuse(const std::string& name, const std::string& what)
{
    throw ReadError(name + ": " + what);
}

std::string quoted(std::string_view word)
{
    // A file of another kind may be a single word of many megabytes.
    constexpr std::size_t kLongest = 40;
    std::string text(word.substr(0, kLongest));
    std::replace_if(
        // Messages go to terminals, where control characters of a damaged file could do anything.
        text.begin(), text.end(), [](unsigned char c) { return !std::isprint(c); }, '?');
    return "\"" + text + (word.size() > kLongest ? "..." : "") + "\"";
}

} // namespace vdb_shell
