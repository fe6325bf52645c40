// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/io/io.h>

#include <cstddef>
#include <memory>
#include <new>
#include <ostream>
#include <streambuf>
#include <string>
#include <utility>
#include <vector>

namespace vdb_shell
{

/// Bytes of a file in the order in which they stand there.
using VdbParts = std::vector<std::string>;

/// What is written to it, in strings that can be taken: std::ostringstream gives copies only, and
/// the grids of points of a million triangles have a hundred megabytes each. One string would be
/// copied each time that it has to grow.
class VdbBytes : public std::streambuf
{
public:
    VdbParts take()
    {
        size_ = 0;
        return std::exchange(parts_, {});
    }

private:
    int_type overflow(int_type c) override
    {
        if (traits_type::eq_int_type(c, traits_type::eof()))
            return traits_type::not_eof(c);
        const char byte = traits_type::to_char_type(c);
        xsputn(&byte, 1);
        return c;
    }
    std::streamsize xsputn(const char* data, std::streamsize size) override
    {
        constexpr std::size_t kPart = std::size_t(1) << 20;
        const auto count = std::size_t(size);
        if (parts_.empty() || parts_.back().size() + count > kPart)
            parts_.emplace_back();
        parts_.back().append(data, count);
        size_ += size;
        return size;
    }
    /// Where the next byte goes; nothing can be written over.
    pos_type seekoff(off_type by, std::ios_base::seekdir from, std::ios_base::openmode) override
    {
        return by == 0 && from != std::ios_base::beg ? pos_type(off_type(size_))
                                                     : pos_type(off_type(-1));
    }

    VdbParts parts_;
    std::streamsize size_ = 0;
};

/// A stream in memory that OpenVDB finds its settings on.
struct VdbStream {
    explicit VdbStream(const openvdb::io::StreamMetadata& wanted)
        : settings(std::make_shared<openvdb::io::StreamMetadata>(wanted))
    {
        openvdb::io::setStreamMetadataPtr(out, settings);
        // Where memory runs out, in VdbBytes or for these settings, a stream only makes a mark, at
        // which nobody looks.
        if (!out)
            throw std::bad_alloc();
        out.exceptions(std::ios_base::badbit);
    }
    VdbBytes bytes;
    std::ostream out{&bytes};
    openvdb::io::StreamMetadata::Ptr settings;
};

} // namespace vdb_shell
