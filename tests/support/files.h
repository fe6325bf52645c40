// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace vdb_shell::test
{

/// A fresh folder that is removed with the object.
class TemporaryFolder
{
public:
    TemporaryFolder();
    ~TemporaryFolder();
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
    const std::filesystem::path& path() const { return path_; }

private:
    std::filesystem::path path_;
};

std::string read_bytes(const std::filesystem::path& path);
void write_bytes(const std::filesystem::path& path, const std::string& bytes);

/// What a reader says as it refuses; empty when it does not.
std::string complaint_of(const std::function<void()>& read);

/// The folder of real meshes, empty when it is not there.
std::filesystem::path real_meshes();

/// Names of the clean meshes under real_meshes(): closed, manifold, outward, embedded.
const std::vector<std::string>& clean_meshes();

} // namespace vdb_shell::test

/// Ends the test as skipped, saying so, when the real meshes are not beside the checkout.
#define VDB_SHELL_NEEDS_REAL_MESHES()                                                              \
    if (vdb_shell::test::real_meshes().empty())                                                    \
    GTEST_SKIP() << "the folder of real meshes is not beside this checkout"
