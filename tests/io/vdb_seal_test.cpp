// SPDX-License-Identifier: Apache-2.0
#include "io/vdb_seal.h"

#include "vdb_shell/core/error.h"

#include "io/vdb_archive.h"
#include "io/vdb_walk.h"
#include "support/files.h"
#include "support/grids.h"

#include <gtest/gtest.h>
#include <openvdb/io/File.h>

namespace vdb_shell
{
namespace
{

namespace fs = std::filesystem;

class VdbSeal : public testing::Test
{
protected:
    VdbSeal()
    {
        openvdb::initialize();
        const auto one = test::sphere_level_set(4.0f, 1.0f), other = one->deepCopy();
        one->setName("one");
        other->setName("other");
        openvdb::MetaMap metadata;
        const std::string room(kUnsealed);
        metadata.insertMeta(kDigestsKey,
                            openvdb::StringMetadata("metadata ab " + room + "\none ab " + room +
                                                    "\none.x ab\nother ab " + room + "\n"));
        seal_vdb(path_, write_vdb_archive(path_, {one, other}, metadata));
        sound_ = test::read_bytes(path_);
    }

    std::string complaint(const std::string& bytes) const
    {
        try {
            check_seal(bytes, "a.vdb");
        } catch (const ReadError& error) {
            return error.what();
        }
        return {};
    }

    std::string flipped(std::size_t byte, int bit = 0) const
    {
        std::string bytes = sound_;
        bytes[byte] = char(bytes[byte] ^ (1 << bit));
        return bytes;
    }

    const test::TemporaryFolder folder_;
    const fs::path path_ = folder_ / "a.vdb";
    std::string sound_;
};

TEST_F(VdbSeal, HoldsAndOpenVdbReadsTheFile)
{
    EXPECT_TRUE(check_seal(sound_, "a.vdb"));
    openvdb::io::File file(path_.string());
    file.open(false);
    EXPECT_EQ(file.getGrids()->size(), 2u);
    EXPECT_EQ(file.getUniqueTag(), sound_.substr(kUuid, kUuidLength));
}

TEST_F(VdbSeal, AnyBitOfAnyByteBreaksIt)
{
    // Seven and eight have no common divisor, so every bit of a byte gets its turn.
    for (std::size_t byte = 0; byte < sound_.size(); byte += 7)
        EXPECT_NE(complaint(flipped(byte, int(byte % 8))), "") << byte;
    for (std::size_t byte = kUuid; byte < kUuid + kUuidLength; ++byte)
        for (int bit = 0; bit < 8; ++bit)
            EXPECT_NE(complaint(flipped(byte, bit)), "") << byte << " " << bit;
    EXPECT_NE(complaint(sound_ + "x"), "");
}

TEST_F(VdbSeal, NamesTheDamagedPart)
{
    EXPECT_NE(complaint(flipped(sound_.size() - 100)).find("grid \"other\" differs"),
              std::string::npos);
    EXPECT_NE(complaint(flipped(sound_.size() / 2 - 100)).find("grid \"one\" differs"),
              std::string::npos);
    EXPECT_NE(complaint(flipped(14)).find("metadata differs"), std::string::npos);
    EXPECT_NE(complaint(flipped(kUuid)).find("the digests themselves"), std::string::npos);
}

TEST_F(VdbSeal, AProgramThatWritesTheFileAnewLiftsIt)
{
    openvdb::io::File in(path_.string());
    in.open(false);
    const openvdb::GridPtrVec grids = *in.getGrids();
    const openvdb::MetaMap metadata = *in.getMetadata();
    in.close();
    openvdb::io::File(path_.string()).write(grids, metadata);
    EXPECT_FALSE(check_seal(test::read_bytes(path_), "a.vdb"));
}

TEST_F(VdbSeal, FilesWithoutOneHaveNone)
{
    EXPECT_FALSE(check_seal("", "a.vdb"));
    EXPECT_FALSE(check_seal(std::string(1000, 'x'), "a.vdb"));
}

TEST_F(VdbSeal, SameGridsGiveTheSameFile)
{
    const auto write = [&](const char* name) {
        seal_vdb(folder_ / name,
                 write_vdb_archive(folder_ / name, {test::sphere_level_set(4.0f, 1.0f)}, {}));
        return test::read_bytes(folder_ / name);
    };
    EXPECT_TRUE(write("b.vdb") == write("c.vdb"));
}

} // namespace
} // namespace vdb_shell
