// SPDX-License-Identifier: Apache-2.0

// Takes shells of the same tets; leaves one HTML file. Style, body and script are texts of their
// own in write/page, which CMake puts into a header, so that they are read and edited as what they
// are. All that is of the shell, names and reports too, stands in the page as base 64 and is put
// on the screen as text: no name of a file can be a tag.

#include "vdb_shell/write/html_page.h"

#include "vdb_shell/core/atomic_file.h"
#include "vdb_shell/core/digest.h"
#include "vdb_shell/core/error.h"
#include "write/page_block.h"
#include "write/page_shell.h"

#include <page_texts.h>

#include <algorithm>
#include <array>
#include <ostream>
#include <string_view>
#include <utility>

namespace vdb_shell
{
namespace
{

using Json = nlohmann::ordered_json;

Json json_of(const openvdb::Vec3d& v)
{
    return {v[0], v[1], v[2]};
}

/// Whatever two frames have to have in common.
std::string digest_of(const ShellFile& file)
{
    Digest digest;
    digest.add_number(std::uint64_t(file.stack.layers.size()));
    digest.add_number(std::uint64_t(file.stack.surface(0).size()));
    digest.add_values(file.stack.triangles());
    digest.add_values(file.tets.tets);
    digest.add_values(file.tets.source_vertex);
    digest.add_values(file.tets.layer);
    digest.add_values(file.core.tets);
    return digest.hex();
}

/// For the legend of the page: every reason has a count, in the order of its number, which is what
/// the array `stop` has.
Json counts_of_pins_and_stops(const ShellStack& stack, const std::vector<StopReason>& stops)
{
    std::array<std::size_t, kStopReasonCount> counts{};
    for (const StopReason stop : stops)
        ++counts[std::size_t(stop)];
    Json json{{"pinned", 0}, {"stops", Json::array()}};
    for (std::size_t i = 0; i < counts.size(); ++i)
        json["stops"].push_back({name_of(StopReason(i)), counts[i]});
    std::size_t pinned = 0;
    for (std::size_t v = 0; v < stops.size(); ++v)
        pinned += pinned_throughout(stack, v) ? 1 : 0;
    json["pinned"] = pinned;
    return json;
}

PageBlock block_of(const PageShell& shown, const ShellFile& file)
{
    PageBlock block;
    const ShellStack& stack = file.stack;
    // Of the whole pillar, from the outermost surface to the innermost.
    const std::vector<StopReason> stops = hull_of(stack).stop;
    block.about = counts_of_pins_and_stops(stack, stops);
    block.about["vertices"] = stack.surface(0).size();
    block.about["triangles"] = stack.triangles().size();
    block.about["tets"] = file.tets.tets.size();
    block.about["layers"] = stack.layers.size();
    block.about["skin"] = stack.skin;
    block.about["core_tets"] = file.core.tets.size();
    // The page says then that what is drawn is not the shell itself, while all counts are.
    block.about["coarser"] = shown.coarser();
    block.about["parameters"] = file.parameters_json;
    std::vector<std::uint8_t> shown_stops;
    for (std::size_t v = 0; v < shown.vertices(); ++v)
        shown_stops.push_back(std::uint8_t(stops[shown.coarser() ? shown.from[v] : v]));
    block.add("from", shown.from);
    block.add("triangles", shown.triangles, 3);
    block.add("surfaces", shown.surfaces);
    block.add("tets", shown.tets, 4);
    block.add("prism", shown.prism);
    block.add("layer", shown.layer);
    block.add("stop", shown_stops);
    return block;
}

PageBlock block_of(const PageFrame& frame, const ShellFile& file)
{
    PageBlock block;
    block.about["report"] = file.report_json;
    block.about["angles"] = frame.angle_counts;
    block.about["thickness"] = frame.thickness_counts;
    block.add("positions", frame.positions, 3);
    block.add("thickness", frame.thickness);
    block.add("angles", frame.angles);
    return block;
}

void write_data(std::ostream& out, const std::string& id, const std::string& base64)
{
    // Browsers neither run nor show a script of this type, and base 64 has no character that could
    // end it.
    out << "<script type=\"text/plain\" id=\"" << id << "\">" << base64 << "</script>\n";
}

} // namespace

struct HtmlPage::Parts {
    std::size_t most_shown_prisms;
    PageShell shown;
    std::string shell, digest; ///< of the first frame
    Json about{{"version", VDB_SHELL_VERSION}, {"frames", Json::array()}};
    std::vector<std::string> frames;
};

HtmlPage::HtmlPage(std::size_t most_shown_prisms) : parts_(std::make_unique<Parts>())
{
    parts_->most_shown_prisms = most_shown_prisms;
}

HtmlPage::~HtmlPage() = default;

void HtmlPage::add(const std::string& label, const ShellFile& file)
{
    Parts& p = *parts_;
    try {
        require_consistent(file.stack, file.tets);
        require_consistent_core(file.stack, file.tets, file.core);
    } catch (const InvalidOption& error) {
        // Which of the frames it is, the shell itself does not know.
        throw InvalidOption(label + ": " + error.what());
    }
    const std::string digest = digest_of(file);
    // What is the same in all frames is taken from the first one, once. Later ones bring places and
    // figures only.
    if (p.frames.empty()) {
        p.shown = page_shell(file, p.most_shown_prisms);
        p.shell = block_of(p.shown, file).base64();
        p.digest = digest;
        p.about["origin"] = json_of(file.placement.origin);
        p.about["unit"] = file.placement.unit;
    } else if (digest != p.digest) {
        throw GeometryError(label + ": its triangles or tets are not those of " +
                            p.about["frames"][0]["label"].get<std::string>() +
                            ", and a page has frames of one shell");
    }
    const PageFrame frame = page_frame(p.shown, file);
    p.about["frames"].push_back({{"label", label},
                                 {"low", json_of(frame.box.low)},
                                 {"high", json_of(frame.box.high)},
                                 {"thickest", frame.thickest}});
    p.frames.push_back(block_of(frame, file).base64());
}

void HtmlPage::write(const std::filesystem::path& path, OutputSet* with) const
{
    const Parts& p = *parts_;
    if (p.frames.empty())
        throw InvalidOption(path.string() + ": a page without a shell");
    PageBlock about;
    about.about = p.about;
    write_stream_atomically(
        path,
        [&](std::ostream& out) {
            const std::string_view body = page::kBody;
            out << "<!DOCTYPE html>\n<html lang=\"en\">\n"
                << page::kHead << "<style>\n"
                << page::kStyle << "</style>\n</head>\n"
                << body;
            write_data(out, "page", about.base64());
            write_data(out, "shell", p.shell);
            for (std::size_t f = 0; f < p.frames.size(); ++f)
                write_data(out, "frame" + std::to_string(f), p.frames[f]);
            out << "<script>\n\"use strict\";\n(() => {\n";
            for (const char* script : page::kScripts)
                out << script;
            out << "})();\n</script>\n</body>\n</html>\n";
        },
        with);
}

} // namespace vdb_shell
