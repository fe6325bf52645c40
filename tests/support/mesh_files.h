// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "support/files.h"
#include "vdb_shell/core/error.h"
#include "vdb_shell/io/read_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <string>

// Mesh files that a test makes byte by byte, and what reading them gives or says.

namespace vdb_shell::test
{

/// The unit tetrahedron.
inline const char* const kTetrahedronObj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n"
                                           "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

/// The bytes of a number in the given order; the machine's own is little-endian.
template <typename Value> std::string raw(Value value, bool big_endian = false)
{
    std::string bytes(sizeof value, '\0');
    std::memcpy(bytes.data(), &value, sizeof value);
    if (big_endian)
        std::reverse(bytes.begin(), bytes.end());
    return bytes;
}

class MeshFiles : public testing::Test
{
protected:
    std::filesystem::path put(const std::string& file, const std::string& bytes)
    {
        write_bytes(folder_ / file, bytes);
        return folder_ / file;
    }
    ReadResult read(const std::string& file, const std::string& bytes,
                    const ReadOptions& options = {})
    {
        return read_mesh(put(file, bytes), options);
    }
    /// The message of the ReadError, which has to name the file.
    std::string complaint(const std::string& file, const std::string& bytes)
    {
        put(file, bytes);
        return complaint(file);
    }
    std::string complaint(const std::string& file)
    {
        try {
            read_mesh(folder_ / file);
        } catch (const ReadError& error) {
            EXPECT_EQ(std::string(error.what()).find((folder_ / file).string()), 0U);
            return error.what();
        }
        return "nothing was thrown";
    }
    TemporaryFolder folder_;
};

} // namespace vdb_shell::test

#define EXPECT_SAYS(message, part)                                                                 \
    EXPECT_NE((message).find(part), std::string::npos) << "it says: " << (message)
