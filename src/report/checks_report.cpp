// SPDX-License-Identifier: Apache-2.0

// Takes: what the certificate, the conformity, the figures and the samples of a shell have found.
// Gives: their keys of the report. Names of findings are the certificate's own.

#include "report/checks_report.h"

#include "certify/certificate_findings.h"
#include "mesh/defect_json.h"
#include "report/shape_report.h"

namespace vdb_shell
{
namespace
{

using nlohmann::ordered_json;

ordered_json conformity_json(const Conformity& conformity)
{
    return {{"conforming", conformity.conforming()},
            {"crowded_faces", defect_json(conformity.crowded_faces)},
            {"misoriented_faces", defect_json(conformity.misoriented_faces)},
            {"stray_faces", defect_json(conformity.stray_faces)},
            {"missing_triangles", defect_json(conformity.missing_triangles)}};
}

/// Points in no tet, in one and in several add up to the samples. Those outside are apart: they
/// were drawn on the way and belong to no share of the solid.
ordered_json coverage_json(const Coverage& coverage)
{
    return {{"samples", coverage.samples},
            {"in_none", coverage.in_none},
            {"in_one", coverage.in_one},
            {"in_several", coverage.in_several},
            {"outside_covered", coverage.outside_covered},
            {"covered_share", coverage.covered_share},
            {"overlap_share", coverage.overlap_share},
            {"standard_error", coverage.standard_error}};
}

/// What holds tet by tet where the whole is not certified (docs/theory.md, "A surface that crosses
/// itself").
ordered_json overlaps_json(const Overlaps& overlaps)
{
    return {{"pairs", defect_json(overlaps.pairs)},
            {"tets", overlaps.tets},
            {"certified_tets", overlaps.certified_tets()},
            {"uncertified_tets", defect_json(overlaps.uncertified)},
            {"prisms", overlaps.prisms},
            {"certified_prisms", overlaps.certified_prisms()},
            {"uncertified_prisms", defect_json(overlaps.uncertified_prisms)},
            {"certified_volume", overlaps.certified_volume}};
}

/// Names and order are those of the certificate's own messages, so that a failure in the text can
/// be looked up by the same word here.
template <typename OneCertificate>
void add_findings(ordered_json& json, const OneCertificate& certificate)
{
    for_each_kind(certificate,
                  [&](const char* name, const auto& defect) { json[name] = defect_json(defect); });
}

/// Stands where a PrismTest is named otherwise.
constexpr const char* kComplexTest = "complex";

/// Findings stand under the certificate itself where there is one layer, else by layer, from the
/// outermost; the hull is only looked at where there are several. All layers are certified by the
/// same test, so that of the first stands for it. A tapered stack has one certificate for all, and
/// a test of another name: its tets alone are positive.
ordered_json certificate_json(const StackCertificate& certificate)
{
    const std::vector<Certificate>& layers = certificate.layers;
    const PrismTest test = layers.empty() ? PrismTest::twelve_tets : layers.front().test;
    ordered_json json{{"test", certificate.complex ? kComplexTest : name_in_table(test)},
                      {"certified", certificate.certified()},
                      {"locally_valid", certificate.locally_valid()}};
    if (certificate.complex) {
        add_findings(json, *certificate.complex);
        return json;
    }
    if (layers.size() == 1) {
        add_findings(json, layers.front());
        return json;
    }
    json["hull_contacts"] = defect_json(certificate.hull_contacts);
    json["hull_nested_wrongly"] = defect_json(certificate.hull_nested_wrongly);
    json["layers"] = ordered_json::array();
    for (const Certificate& layer : layers) {
        ordered_json one{{"certified", layer.certified()},
                         {"locally_valid", layer.locally_valid()}};
        add_findings(one, layer);
        json["layers"].push_back(one);
    }
    return json;
}

} // namespace

void add_checks(ordered_json& json, const ShellReport& report)
{
    json["conformity"] = conformity_json(report.conformity);
    json["quality"] = quality_json(report.quality);
    json["surface_bounds"] = bounds_json(report.surface_bounds);
    json["wanted"] = report.wanted ? wanted_json(*report.wanted) : ordered_json();
    json["volume"] = {{"solid", report.solid_volume},
                      {"shell", report.shell_volume},
                      {"outside", report.outside_volume},
                      {"fill", report.fill}};
    json["coverage"] =
        report.coverage.samples > 0 ? coverage_json(report.coverage) : ordered_json();
    json["certificate"] =
        report.certificate ? certificate_json(*report.certificate) : ordered_json();
    json["overlaps"] = report.overlaps ? overlaps_json(*report.overlaps) : ordered_json();
}

} // namespace vdb_shell
