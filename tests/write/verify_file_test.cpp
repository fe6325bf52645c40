// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/write/verify_file.h"

#include "support/broken_shells.h"
#include "support/files.h"
#include "support/verifications.h"
#include "vdb_shell/core/error.h"
#include "vdb_shell/report/report.h"
#include "write/hand_made.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <utility>

namespace vdb_shell
{
namespace
{

using test::SplitShell;

ShellFile file_of(const SplitShell& made)
{
    const TetMesh tets = make_tets(made.shell, made.split);
    ShellFile file = test::hand_made_file({made.shell, made.split, tets}, 0.25);
    ShellReport report;
    report.certificate = certify_stack(one_layer(made.shell, made.split), PrismTest::twelve_tets);
    file.report_json = report_json(report);
    return file;
}

/// What check says about one thing, the certificate unless told otherwise, after the shell has been
/// to a file and back.
Verification verdict(const ShellFile& file, const char* what = "certificate is as stated")
{
    const test::TemporaryFolder folder;
    write_shell_vdb(folder / "shell.vdb", file);
    return test::verification_of(read_shell_vdb(folder / "shell.vdb"), what);
}

void claim(ShellFile& file, const char* what, const nlohmann::json& value)
{
    auto report = nlohmann::ordered_json::parse(file.report_json);
    report.at("certificate").at(what) = value;
    file.report_json = report.dump(2);
}

TEST(VerifyFile, ACertifiedShellIsCertifiedAgain)
{
    ShellFile file = file_of(test::scaled_shell(test::icosphere(1, 2), 0.5f));
    Verification entry = verdict(file);
    EXPECT_TRUE(entry.holds) << entry.detail;
    EXPECT_EQ(entry.detail.find("not certified"), std::string::npos) << entry.detail;
    claim(file, "certified", false);
    EXPECT_FALSE(verdict(file).holds);
    file.report_json = "{}";
    EXPECT_TRUE(verdict(file).holds);
    file.report_json = "{\"certificate\": null}";
    EXPECT_TRUE(verdict(file).holds);
}

TEST(VerifyFile, NamesWhatBreaksAShellAndFailsAFalseClaim)
{
    const auto cube = [](double low) {
        return test::moved_shell(test::box(openvdb::Vec3d(low), openvdb::Vec3d(low + 1)),
                                 [=](const openvdb::Vec3s& p) {
                                     const openvdb::Vec3s centre(static_cast<float>(low + 0.5));
                                     return centre + (p - centre) * 0.5f;
                                 });
    };
    const SplitShell two_cubes = test::joined(cube(0), cube(0.875));
    const std::pair<const char*, SplitShell> broken[] = {
        {"bad_prisms", test::twisted_shell(1.2)},
        {"inner_folds", test::folded_shell()},
        {"inner_contacts", test::plate_shell(0.625f, 0.625f)},
        {"inner_through_outer", test::plate_shell(1.25f, 0.25f)},
        {"inside_out_components", test::inside_out_shell()},
        {"non_conforming_edges", test::disagreeing_shell(5)},
        {"open_edges", test::open_shell()},
        {"outer_contacts", two_cubes},
        {"nested_wrongly", test::swallowed_shell()}};
    for (const auto& [kind, made] : broken) {
        ShellFile file = file_of(made);
        const Verification honest = verdict(file);
        EXPECT_TRUE(honest.holds) << kind;
        EXPECT_NE(honest.detail.find(std::string("; ") + kind + " "), std::string::npos)
            << honest.detail;
        claim(file, "certified", true);
        const Verification forged = verdict(file);
        EXPECT_FALSE(forged.holds) << kind;
        EXPECT_EQ(forged.detail.substr(0, 13), "not certified") << forged.detail;
    }
}

TEST(VerifyFile, OverlapsAreFoundAgainAndAFalseCountFails)
{
    const SplitShell made = test::plate_shell(0.625f, 0.625f);
    ShellFile file = file_of(made);
    const char* const what = "overlaps are as stated";
    EXPECT_TRUE(verdict(file, what).holds); // a file that says nothing of them
    ShellReport report;
    report.certificate = certify_stack(one_layer(made.shell, made.split), PrismTest::twelve_tets);
    report.overlaps = find_overlaps(file.tets);
    ASSERT_GT(report.overlaps->pairs.count, 0U);
    file.report_json = report_json(report);
    EXPECT_TRUE(verdict(file, what).holds) << verdict(file, what).detail;
    EXPECT_NE(
        verdict(file, what)
            .detail.find(std::to_string(report.overlaps->pairs.count) + " pairs of tets overlap"),
        std::string::npos);
    for (const char* lie :
         {"/overlaps/pairs/count", "/overlaps/certified_prisms", "/overlaps/certified_tets"}) {
        auto claims = nlohmann::ordered_json::parse(report_json(report));
        claims.at(nlohmann::ordered_json::json_pointer(lie)) = 0;
        file.report_json = claims.dump(2);
        EXPECT_FALSE(verdict(file, what).holds) << lie;
    }
}

TEST(VerifyFile, TheTetsThatAreCertifiedAreThoseThatOverlapNone)
{
    const SplitShell shells[] = {test::scaled_shell(test::icosphere(1, 2), 0.5f),
                                 test::twisted_shell(1.2), test::folded_shell(),
                                 test::plate_shell(1.25f, 0.25f)};
    std::vector<std::size_t> uncertified;
    for (const SplitShell& made : shells) {
        const ShellFile file = file_of(made);
        const std::vector<std::uint8_t> found = certified_tets(file);
        EXPECT_EQ(found, find_overlaps(file.tets).certified);
        uncertified.push_back(
            static_cast<std::size_t>(std::count(found.begin(), found.end(), std::uint8_t(0))));
    }
    EXPECT_EQ(uncertified[0], 0U);
    EXPECT_GT(uncertified[3], 0U);
}

TEST(VerifyFile, TetsThatAreNotThoseOfThePrismsAreLookedAtOneByOne)
{
    ShellFile file = file_of(test::scaled_shell(test::icosphere(1, 1), 0.5f));
    // The prisms are as sound as before.
    std::swap(file.tets.tets[0][0], file.tets.tets[0][1]);
    EXPECT_EQ(certified_tets(file)[0], 0);
}

TEST(VerifyFile, TheTestIsTheOneThatTheFileNames)
{
    // An inner vertex goes aside, until not all twelve tets are positive, but all chosen ones are.
    const auto certified = [](const SplitShell& shell, PrismTest test) {
        return certify_shell(shell.shell, shell.split, test).certified();
    };
    SplitShell made;
    bool found = false;
    for (std::size_t v = 0; v < 42 && !found; ++v)
        for (int step = 1; step < 40 && !found; ++step) {
            made = test::scaled_shell(test::icosphere(1, 1), 0.5f);
            made.shell.inner[v] += openvdb::Vec3s(0.02f, 0.01f, 0) * float(step);
            found =
                !certified(made, PrismTest::twelve_tets) && certified(made, PrismTest::chosen_tets);
        }
    ASSERT_TRUE(found);
    ShellFile file = file_of(made);
    claim(file, "certified", true);
    EXPECT_FALSE(verdict(file).holds);
    claim(file, "locally_valid", true);
    claim(file, "test", "chosen-tets");
    EXPECT_TRUE(verdict(file).holds) << verdict(file).detail;
}

TEST(VerifyFile, AnOrderThatIsNoneIsNotEvenWritten)
{
    ShellFile file = file_of(test::scaled_shell(test::icosphere(1, 1), 0.5f));
    file.stack.splits[0].order[7] = {0, 2, 0};
    const test::TemporaryFolder folder;
    EXPECT_ANY_THROW(write_shell_vdb(folder / "shell.vdb", file));
}

} // namespace
} // namespace vdb_shell
