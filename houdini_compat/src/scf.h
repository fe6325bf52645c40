// SPDX-License-Identifier: Apache-2.0
#pragma once

// SCF, the container of .bgeo.sc: an opening mark, Blosc chunks of the same uncompressed size but
// for the last, an index of them (docs/houdini.md has the table).

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace vdb_shell::houdini
{

inline constexpr std::string_view kScfMark = "scf1";

/// Where a writer's bytes go.
using Sink = std::function<void(const char* data, std::size_t size)>;

/// Compresses what it is given, chunk by chunk. Same bytes for the same input and Blosc library.
class ScfWriter
{
public:
    explicit ScfWriter(Sink out);
    void write(const char* data, std::size_t size);
    /// The last chunk and the index. Precondition: something has been written.
    void finish();

private:
    void compress_chunk();
    Sink out_;
    std::string chunk_;
    std::uint64_t compressed_ = 0;
    std::vector<std::uint64_t> starts_; ///< of every chunk after the first
    std::uint64_t last_chunk_ = 0;
};

/// The uncompressed bytes. Throws ReadError "name: ..." for whatever contradicts the index, a chunk
/// that Blosc cannot decode, and sizes that its compressed bytes cannot hold.
std::string read_scf(const std::string& name, const std::string& bytes);

} // namespace vdb_shell::houdini
