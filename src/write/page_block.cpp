// SPDX-License-Identifier: Apache-2.0

// Takes arrays and a few words about them; leaves one text that stands in an HTML page. The
// browser has the way back built in: atob, DecompressionStream, and running sums. The bytes are in
// little-endian order on every machine, for the page is opened on others.

#include "write/page_block.h"

#include "write/base64.h"

#include <zlib.h>

#include <new>
#include <stdexcept>
#include <utility>

namespace vdb_shell
{
namespace
{

/// Higher levels take twice the time for some per cent.
constexpr int kLevel = 6;
/// No header: browsers call it "deflate-raw".
constexpr int kRawWindow = -15;
constexpr int kMemory = 8; ///< zlib's default

std::string deflated(const std::string& bytes)
{
    z_stream stream{};
    if (deflateInit2(&stream, kLevel, Z_DEFLATED, kRawWindow, kMemory, Z_DEFAULT_STRATEGY) != Z_OK)
        throw std::bad_alloc();
    std::string out;
    // In pieces: zlib counts bytes in 32 bits.
    constexpr std::size_t kPiece = 1U << 20U;
    std::vector<unsigned char> buffer(kPiece);
    // Once even for no bytes, as an empty stream has an end that has to be written.
    for (std::size_t begin = 0, end = 0; begin == 0 || begin < bytes.size(); begin = end) {
        end = std::min(begin + kPiece, bytes.size());
        // The type of the library's input is not const, though it only reads.
        stream.next_in = const_cast<Bytef*>(reinterpret_cast<const Bytef*>(bytes.data() + begin));
        stream.avail_in = uInt(end - begin);
        do {
            stream.next_out = buffer.data();
            stream.avail_out = uInt(buffer.size());
            // A buffer that is filled to its end says that there may be more to take.
            deflate(&stream, end == bytes.size() ? Z_FINISH : Z_NO_FLUSH);
            out.append(reinterpret_cast<const char*>(buffer.data()),
                       buffer.size() - stream.avail_out);
        } while (stream.avail_out == 0);
    }
    deflateEnd(&stream);
    return out;
}

} // namespace

template <typename T>
void PageBlock::add_array(const char* name, const std::vector<T>& values, std::size_t stride)
{
    arrays_.push_back({name, sizeof(T), values.size(), stride});
    const std::size_t begin = bytes_.size(), count = values.size();
    bytes_.resize(begin + count * sizeof(T));
    for (std::size_t i = 0; i < count; ++i) {
        // In unsigned numbers, which wrap round: the sums in the browser wrap round the same way.
        const auto difference = T(values[i] - (i < stride ? T(0) : values[i - stride]));
        for (std::size_t byte = 0; byte < sizeof(T); ++byte)
            bytes_[begin + byte * count + i] = char((difference >> (8 * byte)) & 255U);
    }
}

void PageBlock::add(const char* name, const std::vector<std::uint8_t>& values, std::size_t stride)
{
    add_array(name, values, stride);
}

void PageBlock::add(const char* name, const std::vector<std::uint16_t>& values, std::size_t stride)
{
    add_array(name, values, stride);
}

void PageBlock::add(const char* name, const std::vector<std::uint32_t>& values, std::size_t stride)
{
    add_array(name, values, stride);
}

std::string PageBlock::base64() const
{
    nlohmann::ordered_json all = about;
    all["arrays"] = arrays_;
    // Names of files may have any bytes.
    const std::string text =
        all.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
    std::string bytes;
    // The length first, for the reader has to know where JSON ends and arrays begin.
    for (std::size_t byte = 0; byte < 4; ++byte)
        bytes += char((text.size() >> (8 * byte)) & 255U);
    bytes += text;
    bytes += bytes_;
    const std::string small = deflated(bytes);
    return vdb_shell::base64(reinterpret_cast<const unsigned char*>(small.data()), small.size());
}

} // namespace vdb_shell
