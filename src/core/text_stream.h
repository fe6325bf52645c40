// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sstream>
#include <string>

namespace vdb_shell
{

/// Streams of the standard library keep exceptions to themselves and go on with half of the text:
/// where memory runs out that is a wrong digest in a file, or a wrong complaint about one. These
/// throw them on.
class OutText : public std::ostringstream
{
public:
    OutText() { exceptions(std::ios_base::badbit); }
};
class InText : public std::istringstream
{
public:
    explicit InText(const std::string& text) : std::istringstream(text)
    {
        exceptions(std::ios_base::badbit);
    }
};

} // namespace vdb_shell
