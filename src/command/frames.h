// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

// Numbers of frames, and the places in names of files where they stand (docs/frames.md). Pure
// functions: no file is looked at.

namespace vdb_shell::command
{

struct FrameList {
    std::vector<int> frames;   ///< in the order in which they were given, each once
    std::vector<int> repeated; ///< what was given again, and left out; each once
};

/// "1-100", "1-100x2" or "1-100:2" (every second), "10-1", "10-1x-3", "5,8,-3--1". Throws
/// InvalidOption with the place in the text for anything else, and for more than a million frames.
FrameList parse_frames(const std::string& text, const std::string& flag = "--frames");

/// The same the other way round, as short as it goes: "1-9x2,20".
std::string frames_text(const std::vector<int>& frames);

/// The first frame token of a file's name, or nothing. Tokens are runs of # and of @ in the last
/// part of the path, and %d, %04d, $F, $F4, ${F4} anywhere in it.
std::string frame_token(const std::string& path);

/// The name with every token replaced by the frame's number, filled up with zeros to the token's
/// width; a minus counts as one of its digits.
std::string with_frame(const std::string& path, int frame);

} // namespace vdb_shell::command
