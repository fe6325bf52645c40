// SPDX-License-Identifier: Apache-2.0

// The digests of a file's parts as an entry of its metadata, and back. They are of what the parts
// mean, so they hold in a file that another program has written of the same grids, too, and name
// what that program has changed. Files without the entry are read as before: they state nothing.

#include "write/file_digests.h"

#include "core/text_stream.h"
#include "io/vdb_seal.h"
#include "vdb_shell/core/error.h"
#include "vdb_shell/io/read_file.h"

#include <algorithm>
#include <utility>

namespace vdb_shell
{
namespace
{

namespace fs = std::filesystem;

std::string in_words(const std::string& name)
{
    if (name == "metadata")
        return "its metadata";
    // Names of our grids have no dot, so what is behind one is an attribute.
    const std::size_t dot = name.find('.');
    if (dot == name.npos)
        return "grid " + vdb_shell::quoted(name);
    return "attribute " + vdb_shell::quoted(name.substr(dot + 1)) + " of grid " +
           vdb_shell::quoted(name.substr(0, dot));
}

} // namespace

void add_digests(openvdb::MetaMap& metadata, const openvdb::GridPtrVec& grids)
{
    // The first place is for the metadata, whose digest can only be made when all other entries are
    // there.
    std::vector<NamedDigest> all(1);
    for (const openvdb::GridBase::Ptr& grid : grids)
        for (NamedDigest& one : digests_of(*grid))
            all.push_back(std::move(one));
    // The count stands beside the entry, so that an entry that was taken out of the file leaves a
    // trace.
    metadata.insertMeta(kDigestCountKey, openvdb::Int32Metadata(std::int32_t(all.size())));
    all.front() = digest_of_metadata(metadata, kDigestsKey);
    std::string text;
    for (const NamedDigest& one : all) {
        text.append(one.name).append(" ").append(one.hex);
        // Attributes are spread over the bytes of their grid, so they have none of their own.
        if (one.name.find('.') == one.name.npos)
            text.append(" ").append(kUnsealed);
        text += "\n";
    }
    metadata.insertMeta(kDigestsKey, openvdb::StringMetadata(text));
}

StatedDigests::StatedDigests(const openvdb::MetaMap& metadata, fs::path path)
    : path_(std::move(path))
{
    const openvdb::Metadata::ConstPtr entry = metadata[kDigestsKey];
    if (!entry) {
        if (metadata[kDigestCountKey])
            throw ReadError(path_.string() + ": metadata \"" + kDigestsKey + "\" is missing");
        return;
    }
    InText lines(entry->str());
    for (std::string line; std::getline(lines, line);) {
        InText words(line);
        NamedDigest one;
        // What follows the digest is the seal of the bytes (io/vdb_seal.h), which is looked at
        // before OpenVDB opens the file.
        if (!(words >> one.name >> one.hex))
            throw ReadError(path_.string() + ": metadata \"" + kDigestsKey +
                            "\" has a line without a digest");
        stated_.push_back(std::move(one));
    }
    require_same(digest_of_metadata(metadata, kDigestsKey));
}

void StatedDigests::require(const openvdb::GridBase& grid) const
{
    if (stated_.empty())
        return;
    const std::vector<NamedDigest> found = digests_of(grid);
    // What the grid has and the file does not state counts as changed too (require_same): somebody
    // has added it.
    for (const NamedDigest& one : found)
        require_same(one);
    // What is stated and gone is changed as well.
    for (const NamedDigest& one : stated_)
        if (one.name.compare(0, grid.getName().size() + 1, grid.getName() + ".") == 0 &&
            std::none_of(found.begin(), found.end(),
                         [&](const NamedDigest& other) { return other.name == one.name; }))
            throw ReadError(path_.string() + ": " + in_words(one.name) + " is missing");
}

void StatedDigests::require_same(const NamedDigest& found) const
{
    const auto stated = std::find_if(stated_.begin(), stated_.end(), [&](const NamedDigest& one) {
        return one.name == found.name;
    });
    const bool said = stated != stated_.end();
    if (!said || stated->hex != found.hex)
        throw ReadError(path_.string() + ": " + in_words(found.name) +
                        " is not what was written: its digest is " + found.hex +
                        ", the file says " + (said ? vdb_shell::quoted(stated->hex) : "nothing"));
}

} // namespace vdb_shell
