// SPDX-License-Identifier: Apache-2.0
#include "support/files.h"

#include "vdb_shell/core/error.h"

#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <stdexcept>

namespace vdb_shell::test
{

namespace fs = std::filesystem;

TemporaryFolder::TemporaryFolder()
{
    std::string pattern = (fs::temp_directory_path() / "vdb_shell_test_XXXXXX").string();
    if (!::mkdtemp(pattern.data()))
        throw std::runtime_error("no temporary folder");
    path_ = pattern;
}

TemporaryFolder::~TemporaryFolder()
{
    std::error_code ignored;
    fs::remove_all(path_, ignored);
}

std::string complaint_of(const std::function<void()>& read)
{
    try {
        read();
    } catch (const ReadError& error) {
        return error.what();
    }
    return {};
}

std::string read_bytes(const fs::path& path)
{
    std::ifstream in(path, std::ios::binary);
    if (!in)
        throw std::runtime_error(path.string() + " cannot be opened");
    return {std::istreambuf_iterator<char>(in), {}};
}

void write_bytes(const fs::path& path, const std::string& bytes)
{
    std::ofstream out(path, std::ios::binary);
    out << bytes;
    if (!out)
        throw std::runtime_error(path.string() + " cannot be written");
}

fs::path real_meshes()
{
    const fs::path folder = VDB_SHELL_MESHES;
    return fs::is_directory(folder) ? folder : fs::path();
}

const std::vector<std::string>& clean_meshes()
{
    static const std::vector<std::string> names{
        "paper/box",          "paper/support_box",
        "paper/cylinder",     "paper/pointy",
        "paper/diku",         "paper/tube",
        "paper/lamp",         "paper/sphere",
        "paper/teapot",       "paper/glass",
        "paper/propella",     "paper/funnel",
        "paper/jack",         "paper/dragon_small_resolution",
        "paper/cow",          "paper/bunny_low_resolution",
        "paper/bend",         "paper/bowl",
        "paper/torus",        "paper/knot",
        "artist/cheburashka", "artist/fandisk",
        "artist/rocker-arm"};
    return names;
}

} // namespace vdb_shell::test
