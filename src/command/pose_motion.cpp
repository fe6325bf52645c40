// SPDX-License-Identifier: Apache-2.0

// Takes files of surfaces, gives poses, each made once while it is near to the frame that is worked
// on. Whether a pose was there already changes nothing but the time.

#include "command/pose_motion.h"

#include <algorithm>

namespace vdb_shell::command
{

PoseCache::Pose PoseCache::get(const std::filesystem::path& mesh,
                               const std::function<PoseResult()>& make)
{
    std::promise<Pose> promise;
    std::shared_future<Pose> pose;
    {
        const std::lock_guard<std::mutex> lock(mutex_);
        const auto known = std::find_if(poses_.begin(), poses_.end(),
                                        [&](const auto& entry) { return entry.first == mesh; });
        if (known != poses_.end())
            pose = known->second;
        else
            // Under the lock: whoever asks next finds that somebody is at work on it, and waits for
            // the future.
            poses_.emplace_back(mesh, promise.get_future().share());
        // The oldest goes. Who waits for it has a future of his own, so nothing is lost but the
        // work, if it is wanted again.
        if (poses_.size() > kMost)
            poses_.pop_front();
    }
    // Not under the lock: another thread may be at work on it.
    if (pose.valid())
        return pose.get();
    try {
        auto made = std::make_shared<const PoseResult>(make());
        promise.set_value(made);
        return made;
    } catch (...) {
        // Those who wait must not wait for ever.
        promise.set_exception(std::current_exception());
        throw;
    }
}

} // namespace vdb_shell::command
