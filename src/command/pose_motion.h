// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/pipeline.h"

#include <deque>
#include <filesystem>
#include <functional>
#include <future>
#include <memory>
#include <mutex>
#include <utility>

namespace vdb_shell::command
{

/// Poses by the file of their surface. A frame whose neighbours are wanted, too, is posed once for
/// all three of them, whichever of several threads comes first.
class PoseCache
{
public:
    using Pose = std::shared_ptr<const PoseResult>;

    /// Throws what `make` throws, also where another thread has called it.
    Pose get(const std::filesystem::path& mesh, const std::function<PoseResult()>& make);

private:
    /// As many frames as can be worked on at once, with their neighbours, and a few more.
    static constexpr std::size_t kMost = 40;
    std::mutex mutex_;
    std::deque<std::pair<std::filesystem::path, std::shared_future<Pose>>> poses_;
};

} // namespace vdb_shell::command
