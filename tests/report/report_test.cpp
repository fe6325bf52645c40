// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/report/report.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace vdb_shell
{
namespace
{

using nlohmann::json;

ShellReport good_report()
{
    ShellReport report;
    report.source = "cow.obj";
    report.mesh.points = 12;
    report.signs.tets = 60;
    report.field.voxel_size = 0.1;
    report.quality.min_dihedral_radians.min = std::acos(0.0);
    report.quality.max_dihedral_radians.max = std::acos(-1.0);
    report.solid_volume = 2.0;
    report.shell_volume = 1.0;
    report.fill = 0.5;
    report.coverage.samples = 1000;
    report.stages = {{"level set", 1.5, 2u << 20}, {"tets", 0.5, 1u << 20}};
    return report;
}

TEST(Report, JsonHoldsTheNumbersExactly)
{
    ShellReport report = good_report();
    report.shell_volume = 0.1 + 0.2;
    report.signs.inverted = {3, {1, 4, 5}};
    const json parsed = json::parse(report_json(report));
    EXPECT_EQ(parsed.at("/volume/shell"_json_pointer).get<double>(), 0.1 + 0.2);
    EXPECT_EQ(parsed.at("/tets/inverted"_json_pointer), 3);
    EXPECT_EQ(parsed.at("/tets/first_inverted"_json_pointer), json({1, 4, 5}));
    EXPECT_EQ(parsed.at("/mesh/self_intersections"_json_pointer), 0);
    EXPECT_TRUE(parsed.at("/field/smooth/max_drift"_json_pointer).is_number());
    EXPECT_TRUE(parsed.at("read").is_null());
}

TEST(Report, AnglesAreInDegrees)
{
    const json parsed = json::parse(report_json(good_report()));
    EXPECT_NEAR(parsed.at("/quality/min_dihedral_degrees/min"_json_pointer).get<double>(), 90,
                1e-12);
    EXPECT_NEAR(parsed.at("/quality/max_dihedral_degrees/max"_json_pointer).get<double>(), 180,
                1e-12);
    EXPECT_EQ(report_json(good_report()).find("radians"), std::string::npos);
}

TEST(Report, CostsCanBeLeftOut)
{
    ShellReport slow = good_report();
    slow.stages[0].seconds = 99;
    EXPECT_EQ(report_json(slow, false), report_json(good_report(), false));
    EXPECT_NE(report_json(slow), report_json(good_report()));
    EXPECT_FALSE(json::parse(report_json(slow, false)).contains("stages"));
}

TEST(Report, KeysStandInAFixedOrder)
{
    const std::string text = report_json(good_report());
    const char* const order[] = {"\"source\"",  "\"mesh\"",     "\"field\"",
                                 "\"lines\"",   "\"tets\"",     "\"conformity\"",
                                 "\"quality\"", "\"coverage\"", "\"stages\""};
    std::size_t last = 0;
    for (const char* key : order) {
        const std::size_t at = text.find(key);
        ASSERT_NE(at, std::string::npos) << key;
        EXPECT_GT(at, last) << key;
        last = at;
    }
}

TEST(Report, FileNameWithOtherBytesThanUtf8IsStillJson)
{
    ShellReport report = good_report();
    report.source = "k\xFChe.obj";
    EXPECT_FALSE(json::parse(report_json(report), nullptr, false).is_discarded());
}

TEST(Report, TextIsAboutTwentyLines)
{
    const std::string text = report_text(good_report());
    const auto lines = std::count(text.begin(), text.end(), '\n');
    EXPECT_GE(lines, 15);
    EXPECT_LE(lines, 25);
    EXPECT_NE(text.find("fill 50.00 %"), std::string::npos) << text;
    EXPECT_NE(text.find("smallest 90 degrees"), std::string::npos) << text;
}

TEST(Report, SaysWhetherTheShellIsCertified)
{
    ShellReport report = good_report();
    EXPECT_TRUE(json::parse(report_json(report)).at("certificate").is_null());
    EXPECT_EQ(report_text(report).find("certified   "), std::string::npos);
    report.certificate.emplace().layers.resize(1);
    Certificate& layer = report.certificate->layers[0];
    json certificate = json::parse(report_json(report)).at("certificate");
    EXPECT_EQ(certificate.at("test"), "twelve-tets");
    EXPECT_EQ(certificate.at("certified"), true);
    EXPECT_NE(report_text(report).find("yes (12 tets of each prism positive, surfaces embedded and "
                                       "disjoint)"),
              std::string::npos);
    EXPECT_EQ(report_text(report).find("not certified"), std::string::npos);

    layer.test = PrismTest::chosen_tets;
    layer.inner_folds = {2, {{3, 4}, {5, 9}}};
    certificate = json::parse(report_json(report)).at("certificate");
    EXPECT_EQ(certificate.at("test"), "chosen-tets");
    EXPECT_EQ(certificate.at("certified"), false);
    EXPECT_EQ(certificate.at("locally_valid"), true);
    EXPECT_EQ(certificate.at("/inner_folds/count"_json_pointer), 2);
    EXPECT_EQ(certificate.at("/inner_folds/first"_json_pointer), json({{3, 4}, {5, 9}}));
    EXPECT_NE(report_text(report).find("NO, only locally valid: inner_folds 2 (first 3-4 5-9)"),
              std::string::npos);
    EXPECT_NE(report_text(report).find("not certified"), std::string::npos);
    layer.bad_prisms = {1, {7}};
    EXPECT_NE(report_text(report).find("NO: bad_prisms 1 (first 7), inner_folds"),
              std::string::npos);
}

TEST(Report, SaysWhatGrowthScalingAndCuttingDid)
{
    ShellReport report = good_report();
    report.grow = GrowReport();
    EXPECT_NE(report_text(report).find("0 rounds, 0 diagonals turned, 0 pins released"),
              std::string::npos);
    EXPECT_EQ(report_text(report).find("min quality"), std::string::npos);
    report.grow->released = 3;
    report.grow->quality_rounds = 4;
    report.grow->tets_below_quality = 51;
    report.grow->vertices_below_quality = 17;
    report.scale = ScaleReport{6, 2};
    report.cut = LayerReport{8, 5, 2};
    report.outside.emplace();
    report.outside->grow = GrowReport();
    report.outside->grow->released = 5;
    report.outside->scale = ScaleReport{7, 1};
    const std::string text = report_text(report);
    // Of shells on both sides each side tells its own.
    EXPECT_NE(text.find("5 pins released"), std::string::npos) << text;
    EXPECT_NE(text.find("7 pillars shortened further, 1 of them pinned"), std::string::npos);
    EXPECT_NE(text.find("3 pins released"), std::string::npos) << text;
    EXPECT_NE(text.find("4 rounds; still below: 51 tets, 17 inner vertices"), std::string::npos);
    EXPECT_NE(text.find("6 pillars shortened further, 2 of them pinned"), std::string::npos);
    EXPECT_NE(text.find("8 points between them moved, 5 pillars left whole; 2 LAYERS ARE EMPTY"),
              std::string::npos);
    const json figures = json::parse(report_json(report));
    EXPECT_EQ(figures.at("/growth/released_pins"_json_pointer), 3);
    EXPECT_EQ(figures.at("/growth/tets_below_quality"_json_pointer), 51);
    EXPECT_EQ(figures.at("/scale/shortened_pillars"_json_pointer), 6);
    EXPECT_EQ(figures.at("/cut/uncut_pillars"_json_pointer), 5);
    EXPECT_EQ(figures.at("/cut/empty_layers"_json_pointer), 2);
}

TEST(Report, SaysWhereNeedlesHoldPillarsBack)
{
    ShellReport needled = good_report();
    needled.grow = GrowReport();
    needled.surface_bounds.edge_ratio.max = 300;
    const auto said_of = [](const ShellReport& report) {
        return report_text(report).find("needles hold pillars back") != std::string::npos;
    };
    EXPECT_TRUE(said_of(needled));
    const auto unless = [&](const auto& change) {
        ShellReport other = needled;
        change(other);
        EXPECT_FALSE(said_of(other));
    };
    unless([](ShellReport& r) { r.grow.reset(); });
    unless([](ShellReport& r) { r.fill = 0.95; });
    unless([](ShellReport& r) { r.side = Side::outward; });
    unless([](ShellReport& r) { r.surface_bounds.edge_ratio.max = 3; });
    unless([](ShellReport& r) { r.lines.stops[std::size_t(StopReason::thickness)] = 4; });
    unless([](ShellReport& r) { r.scale.emplace(); });
    unless([](ShellReport& r) { r.cores.emplace(); });
}

TEST(Report, AdvisesAgainstNeedlesOnlyWhatHasNotBeenUsed)
{
    const auto advice_after = [](const auto& change) {
        ShellReport report = good_report();
        report.grow = GrowReport();
        report.surface_bounds.edge_ratio.max = 300;
        report.certificate.emplace().layers.resize(1);
        change(report);
        const std::string text = report_text(report);
        const std::size_t at = text.find("needles hold pillars back");
        return text.substr(at, text.find('\n', at) - at);
    };
    const auto names = [](const std::string& advice) {
        const auto has = [&](const char* option) {
            return advice.find(option) != std::string::npos;
        };
        return std::array{has("--retriangulate"), has("--remesh-to"), has("--thickest")};
    };
    const auto nothing = [](ShellReport&) {};
    EXPECT_EQ(names(advice_after(nothing)), (std::array{true, true, true}));
    const auto retriangulated = [](ShellReport& r) { r.retriangulate.emplace(); };
    EXPECT_EQ(names(advice_after(retriangulated)), (std::array{false, true, true}));
    const auto remeshed = [](ShellReport& r) { r.remesh.emplace(); };
    EXPECT_EQ(names(advice_after(remeshed)), (std::array{false, false, true}));
    const auto three_tets = [](ShellReport& r) {
        r.certificate->layers.front().test = PrismTest::chosen_tets;
    };
    EXPECT_EQ(names(advice_after(three_tets)), (std::array{true, true, false}));
    const auto tapered = [](ShellReport& r) { r.certificate->layers.clear(); };
    EXPECT_EQ(names(advice_after(tapered)), (std::array{true, true, false}));
}

TEST(Report, NamesTheLayerThatFails)
{
    ShellReport report = good_report();
    report.certificate.emplace().layers.resize(3);
    EXPECT_NE(report_text(report).find("in all 3 layers"), std::string::npos);
    report.certificate->layers[1].inner_contacts = {1, {{3, 9}}};
    EXPECT_NE(report_text(report).find("layer 1: inner_contacts 1 (first 3-9)"), std::string::npos);
    EXPECT_NE(report_text(report).find("not certified"), std::string::npos);
}

TEST(Report, VerdictNamesEveryFault)
{
    const auto verdict = [](const ShellReport& report) {
        const std::string text = report_text(report);
        return text.substr(text.find("verdict"));
    };
    EXPECT_EQ(verdict(good_report()).find("NOT VALID"), std::string::npos);
    EXPECT_NE(verdict(good_report()).find("not certified"), std::string::npos);
    const auto faulty = [&](auto spoil, const char* said) {
        ShellReport report = good_report();
        spoil(report);
        EXPECT_NE(verdict(report).find("NOT VALID"), std::string::npos) << said;
        EXPECT_NE(verdict(report).find(said), std::string::npos) << verdict(report);
    };
    faulty([](ShellReport& r) { r.signs.inverted.count = 2; }, "2 inverted tets");
    faulty([](ShellReport& r) { r.signs.flat.count = 1; }, "1 flat tets");
    faulty([](ShellReport& r) { r.conformity.stray_faces.count = 1; }, "do not conform");
    faulty([](ShellReport& r) { r.coverage.in_several = 5; }, "5 sample points covered more");
    faulty([](ShellReport& r) { r.overlaps.emplace().pairs.count = 3; },
           "3 pairs of tets that overlap");
    ShellReport piecewise = good_report();
    piecewise.overlaps.emplace();
    EXPECT_NE(verdict(piecewise).find("proven tet by tet; not certified"), std::string::npos);
    ShellReport unseen = good_report();
    unseen.coverage.samples = 0;
    EXPECT_NE(verdict(unseen).find("overlaps not looked for"), std::string::npos);
}

} // namespace
} // namespace vdb_shell
