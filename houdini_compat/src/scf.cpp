// SPDX-License-Identifier: Apache-2.0

// The container of .bgeo.sc: Blosc chunks of one mebibyte of the document, and an index of them at
// the end. Written so that the bytes depend only on the input and on the versions of Blosc and its
// codec: one thread, fixed level and shuffle. Read without trust: the index has to lie in the file
// and its chunks have to follow each other, and a chunk that declares more than its compressed
// bytes can stand for is refused before memory is taken. A truncated file shows at once, since the
// end mark is missing.

#include "scf.h"

#include "vdb_shell/core/error.h"

#include "vdb_shell/io/read_file.h"

#include <blosc.h>

#include <algorithm>
#include <cassert>
#include <utility>

namespace vdb_shell::houdini
{
namespace
{

// The layout, in which all words are of eight bytes and big-endian. In this order: the mark, the
// length of a preamble and the preamble itself; the chunks; an index, which has for each chunk but
// the first where it starts (counted from the end of the preamble), then the size of a full chunk
// and the size of the last one, both uncompressed; the length of the index; the end mark.

constexpr std::size_t kChunk = std::size_t(1) << 20;
// One thread, so that the bytes do not depend on the number of cores. Shuffling by four bytes
// groups the bytes of equal weight of int32 and float32, which most of the document is made of.
constexpr int kLevel = 5, kElementSize = 4, kOneThread = 1;
constexpr std::size_t kAutomaticBlocks = 0;
constexpr const char* kCodec = "lz4";

constexpr std::string_view kEndMark = "1fcs";
constexpr std::size_t kWord = 8;
constexpr std::size_t kHead = kScfMark.size() + kWord; ///< the mark and the length of a preamble
constexpr std::size_t kTail = kWord + kEndMark.size(); ///< the length of the index and its mark
/// What a compressed byte can stand for at most: a little more than the best codec of Blosc can
/// make of one byte (zlib: 1032 bytes).
constexpr std::uint64_t kMostExpansion = 1100;

std::string big_endian(std::uint64_t value)
{
    std::string bytes(kWord, '\0');
    for (std::size_t i = 0; i < kWord; ++i)
        bytes[i] = static_cast<char>((value >> (56 - 8 * i)) & 0xffu);
    return bytes;
}

std::uint64_t word_at(const std::string& bytes, std::size_t at)
{
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < kWord; ++i)
        value = value << 8 | static_cast<unsigned char>(bytes[at + i]);
    return value;
}

void put(const Sink& out, std::string_view bytes)
{
    out(bytes.data(), bytes.size());
}

/// The layout of a file, every part within its bounds.
struct Layout {
    std::vector<std::size_t> bounds; ///< of the chunks in the file: one more than there are
    std::uint64_t chunk = 0, last_chunk = 0;
};

Layout read_layout(const std::string& name, const std::string& bytes)
{
    const std::size_t size = bytes.size();
    // The shortest file has an index of two words, for the sizes. After this test no subtraction
    // below can wrap.
    if (size < kHead + 2 * kWord + kTail)
        refuse(name, "it has " + std::to_string(size) + " bytes, too few for a compressed file");
    if (std::string_view(bytes).substr(size - kEndMark.size()) != kEndMark)
        refuse(name, "it does not end in \"1fcs\": it is cut short, or no compressed geometry");
    const std::uint64_t preamble = word_at(bytes, kScfMark.size());
    const std::uint64_t index_size = word_at(bytes, size - kTail);
    // The differences are compared, not the sums: both lengths come from the file, and their sum
    // could wrap.
    const std::size_t between = size - kHead - kTail;
    if (preamble > between || index_size > between - preamble || index_size % kWord != 0 ||
        index_size < 2 * kWord)
        refuse(name, "a preamble of " + std::to_string(preamble) + " bytes and an index of " +
                         std::to_string(index_size) + " bytes do not fit into " +
                         std::to_string(size) + " bytes");
    const std::size_t begin = kHead + static_cast<std::size_t>(preamble);
    const std::size_t index = size - kTail - static_cast<std::size_t>(index_size);
    const std::size_t starts = static_cast<std::size_t>(index_size) / kWord - 2;
    Layout layout;
    layout.bounds.push_back(begin);
    for (std::size_t i = 0; i < starts; ++i) {
        const std::uint64_t start = word_at(bytes, index + i * kWord);
        // Starts that increase strictly leave no chunk empty and let none overlap the next, so the
        // total of compressed bytes is bounded by the file.
        if (start > index - begin || begin + start <= layout.bounds.back())
            refuse(name, "the index has chunk " + std::to_string(i + 1) + " begin at " +
                             std::to_string(start) +
                             ", which is not after the chunk before it and "
                             "before the index at " +
                             std::to_string(index - begin));
        layout.bounds.push_back(begin + static_cast<std::size_t>(start));
    }
    layout.bounds.push_back(index);
    layout.chunk = word_at(bytes, index + starts * kWord);
    layout.last_chunk = word_at(bytes, index + (starts + 1) * kWord);
    return layout;
}

/// Appends chunk `number`, which has to give `wanted` bytes.
void append_chunk(const std::string& where, std::string_view packed, std::uint64_t wanted,
                  std::string& result)
{
    // Blosc's own header is validated first: decompressing trusts the lengths that stand in it.
    std::size_t held = 0;
    if (blosc_cbuffer_validate(packed.data(), packed.size(), &held) != 0)
        refuse(where, "its " + std::to_string(packed.size()) + " bytes are no Blosc data");
    if (held != wanted)
        refuse(where, "it holds " + std::to_string(held) + " bytes, the index says " +
                          std::to_string(wanted));
    // What is declared must not take more memory than the file can stand for.
    if (wanted > kMostExpansion * packed.size())
        refuse(where, std::to_string(packed.size()) + " compressed bytes cannot hold " +
                          std::to_string(wanted));
    const std::size_t before = result.size();
    result.resize(before + held);
    const int got =
        held == 0 ? 0
                  : blosc_decompress_ctx(packed.data(), result.data() + before, held, kOneThread);
    if (got < 0 || static_cast<std::size_t>(got) != held)
        refuse(where, "Blosc cannot decode it (status " + std::to_string(got) + ")");
}

} // namespace

ScfWriter::ScfWriter(Sink out) : out_(std::move(out))
{
    put(out_, kScfMark);
    // No preamble.
    put(out_, big_endian(0));
    chunk_.reserve(kChunk);
}

void ScfWriter::compress_chunk()
{
    // The first chunk starts at 0, which the index leaves out.
    if (compressed_ > 0)
        starts_.push_back(compressed_);
    std::string packed(chunk_.size() + BLOSC_MAX_OVERHEAD, '\0');
    const int size =
        blosc_compress_ctx(kLevel, BLOSC_SHUFFLE, kElementSize, chunk_.size(), chunk_.data(),
                           packed.data(), packed.size(), kCodec, kAutomaticBlocks, kOneThread);
    if (size <= 0)
        throw WriteError("Blosc cannot compress with " + std::string(kCodec) + " (status " +
                         std::to_string(size) + ")");
    put(out_, std::string_view(packed).substr(0, static_cast<std::size_t>(size)));
    compressed_ += static_cast<std::uint64_t>(size);
    last_chunk_ = chunk_.size();
    chunk_.clear();
}

void ScfWriter::write(const char* data, std::size_t size)
{
    while (size > 0) {
        // A full chunk waits until more bytes come, because the last chunk may be full as well, and
        // only the last one's size is told apart in the index.
        if (chunk_.size() == kChunk)
            compress_chunk();
        const std::size_t piece = std::min(size, kChunk - chunk_.size());
        chunk_.append(data, piece);
        data += piece;
        size -= piece;
    }
}

void ScfWriter::finish()
{
    // The document is never empty, so this can only fail by a mistake in our own code.
    assert(!chunk_.empty());
    compress_chunk();
    for (const std::uint64_t start : starts_)
        put(out_, big_endian(start));
    put(out_, big_endian(kChunk));
    put(out_, big_endian(last_chunk_));
    put(out_, big_endian((starts_.size() + 2) * kWord));
    put(out_, kEndMark);
}

std::string read_scf(const std::string& name, const std::string& bytes)
{
    const Layout layout = read_layout(name, bytes);
    std::string result;
    for (std::size_t i = 0; i + 1 < layout.bounds.size(); ++i) {
        const std::size_t begin = layout.bounds[i];
        const bool last = i + 2 == layout.bounds.size();
        append_chunk(name + ": chunk " + std::to_string(i),
                     std::string_view(bytes).substr(begin, layout.bounds[i + 1] - begin),
                     last ? layout.last_chunk : layout.chunk, result);
    }
    return result;
}

} // namespace vdb_shell::houdini
