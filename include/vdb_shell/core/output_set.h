// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <iosfwd>
#include <memory>
#include <vector>

namespace vdb_shell
{

struct OutputTarget;

/// What becomes of a file that stands where an output goes.
enum class Existing { replaced, kept };

/// Files that appear together or not at all. Each is written into a temporary of its own folder;
/// commit() puts all of them in their places. After a fault at any moment all places hold what they
/// held before. A device or a fifo is written into by commit(), before any file is replaced: what
/// went into it cannot be taken back. docs/reliability.md says what is kept of a replaced file.
class OutputSet
{
public:
    /// With Existing::kept a file that is there already is a WriteError.
    explicit OutputSet(Existing existing = Existing::replaced);
    /// Removes what was not committed.
    ~OutputSet();
    OutputSet(const OutputSet&) = delete;
    OutputSet& operator=(const OutputSet&) = delete;

    /// `write` fills the temporary, which has the extension of `path` for libraries that go by it.
    /// Throws WriteError with the path and the system's reason, also for a file that is in the set
    /// already.
    void write(const std::filesystem::path& path,
               const std::function<void(const std::filesystem::path& temporary)>& write);

    /// The same for a binary stream; a stream that ends in a failed state is a failure.
    void write_stream(const std::filesystem::path& path,
                      const std::function<void(std::ostream& out)>& write);

    /// Puts all files in their places. The set is empty afterwards.
    void commit();

private:
    struct File;
    void require_free(const OutputTarget& target) const;
    void put_in_places();
    void put_back() noexcept;
    std::vector<std::unique_ptr<File>> files_;
    Existing existing_;
};

/// Writes into the set, which its owner commits; without one into a set of its own, which is
/// committed here.
void write_together(OutputSet* with, const std::function<void(OutputSet&)>& write);

} // namespace vdb_shell
