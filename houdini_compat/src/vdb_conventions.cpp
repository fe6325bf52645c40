// SPDX-License-Identifier: Apache-2.0

// Reads any .vdb and lists what Houdini would drop, change or misread in it: the entry point of the
// rules, and those that concern names and types of grids. The rules come from the conversion code
// that OpenVDB publishes for Houdini and from its documentation (docs/vdb_conventions.md has all of
// them); Houdini itself was not run. The order of the findings follows the order of the grids in
// the file, so it is the same on each run.

#include "vdb_shell/houdini/vdb_conventions.h"

#include "vdb_shell/core/error.h"
#include "vdb_shell/io/vdb_header.h"

#include "vdb_rules.h"

#include <openvdb/io/File.h>

#include <algorithm>
#include <set>

namespace vdb_shell
{
namespace
{

namespace fs = std::filesystem;

/// The trees that Houdini's own tables know; it makes nothing of the others. The name of the tree
/// decides and not that of the values: a mask's values are bools too, and only its tree tells it
/// from a grid of bools.
bool is_houdini_tree(const std::string& type)
{
    static const std::set<std::string> known{
        "Tree_float_5_4_3",   "Tree_double_5_4_3",     "Tree_int32_5_4_3", "Tree_int64_5_4_3",
        "Tree_bool_5_4_3",    "Tree_vec3s_5_4_3",      "Tree_vec3d_5_4_3", "Tree_vec3i_5_4_3",
        "Tree_ptidx32_5_4_3", "Tree_ptdataidx32_5_4_3"};
    return known.count(type) > 0;
}

/// Whether a name has a character that stands for something else where grids are picked by name:
/// wildcards, sets, attributes, quotes, ranges. Blanks and control characters separate names there.
bool has_pattern_character(const std::string& name)
{
    return std::any_of(name.begin(), name.end(), [](unsigned char c) {
        return c <= ' ' ||
               std::string("*?[]{}^!@#\"'`$&|;:,()<>=\\/%~").find(char(c)) != std::string::npos;
    });
}

void check_name(const openvdb::GridBase& grid, const std::set<std::string>& earlier,
                VdbViolations& found)
{
    const std::string name = grid.getName();
    if (name.empty())
        found.push_back({"name", name, "", "the name is empty; grids are picked by name"});
    else if (has_pattern_character(name))
        found.push_back({"name", name, "",
                         "the name has a blank or a character with a meaning in group patterns"});
    if (earlier.count(name))
        found.push_back({"unique-name", name, "",
                         "an earlier grid has this name; Houdini appends [0], [1], ... to them"});
    // Tools of Houdini pick grids by these two names unless told otherwise, and expect the class
    // that goes with them.
    const openvdb::GridClass grid_class = grid.getGridClass();
    const char* const other_name =
        name == "surface" && grid_class != openvdb::GRID_LEVEL_SET    ? "level sets"
        : name == "density" && grid_class != openvdb::GRID_FOG_VOLUME ? "fog volumes"
                                                                      : nullptr;
    if (other_name)
        found.push_back({"name-for-class", name, "",
                         "the class is \"" + openvdb::GridBase::gridClassToString(grid_class) +
                             "\"; this name is Houdini's default for " + other_name});
}

/// The outer structure of the file is checked first, because OpenVDB trusts the sizes that stand in
/// it. All grids are loaded at once: the rules for half floats and points look at values.
openvdb::GridPtrVecPtr read_grids(const fs::path& path, openvdb::MetaMap::Ptr& metadata)
{
    openvdb::initialize();
    require_whole_vdb(path);
    try {
        openvdb::io::File file(path.string());
        file.open(/*delayLoad=*/false);
        metadata = file.getMetadata();
        return file.getGrids();
    } catch (const std::exception& error) {
        throw ReadError(path.string() + ": cannot be read: " + error.what());
    }
}

} // namespace

/// ASCII letters are compared directly: isalpha depends on the locale, and with some it takes
/// letters that Houdini refuses.
bool is_houdini_name(const std::string& name)
{
    const auto is_letter = [](unsigned char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
    };
    return !name.empty() && is_letter(static_cast<unsigned char>(name[0])) &&
           std::all_of(name.begin(), name.end(),
                       [&](unsigned char c) { return is_letter(c) || (c >= '0' && c <= '9'); });
}

const std::vector<std::string>& vdb_convention_rules()
{
    // In the order of the documentation. The tests break each rule of this list on purpose, so a
    // rule without a test shows.
    static const std::vector<std::string> rules{"no-grids",
                                                "creator",
                                                "name",
                                                "unique-name",
                                                "name-for-class",
                                                "type",
                                                "class",
                                                "level-set",
                                                "fog-volume",
                                                "staggered",
                                                "vector-type",
                                                "vector-meaning",
                                                "half",
                                                "half-range",
                                                "own-metadata",
                                                "value-type",
                                                "metadata-type",
                                                "metadata-name",
                                                "metadata-clash",
                                                "is-bool",
                                                "dictionary",
                                                "global-metadata",
                                                "global-tuple",
                                                "viewport-group",
                                                "attribute-type",
                                                "attribute-name",
                                                "attribute-stride",
                                                "attribute-clash",
                                                "integer-vector",
                                                "position",
                                                "role",
                                                "group-name"};
    return rules;
}

std::vector<VdbViolation> check_vdb_conventions(const fs::path& path)
{
    openvdb::MetaMap::Ptr metadata;
    const openvdb::GridPtrVecPtr grids = read_grids(path, metadata);
    VdbViolations found;
    if (metadata)
        check_file_metadata(*metadata, found);
    if (grids->empty())
        found.push_back({"no-grids", "", "", "the file has no grids"});
    std::set<std::string> names;
    TypesByName types;
    for (const openvdb::GridBase::Ptr& grid : *grids) {
        check_name(*grid, names, found);
        // After check_name, so that only earlier grids count and the first of several equal names
        // is not blamed.
        names.insert(grid->getName());
        check_grid_metadata(*grid, types, found);
        if (!is_houdini_tree(grid->type()))
            found.push_back(
                {"type", grid->getName(), "",
                 "the value type is " + grid->valueType() + ", which Houdini has no grids of"});
        check_values(*grid, found);
        check_point_attributes(*grid, types, found);
    }
    return found;
}

std::string to_text(const VdbViolation& violation)
{
    std::string text = violation.grid.empty() && violation.rule != "name"
                           ? std::string("the file")
                           : "grid \"" + violation.grid + "\"";
    if (!violation.element.empty())
        text += ", \"" + violation.element + "\"";
    return text + ": " + violation.rule + ": " + violation.detail;
}

} // namespace vdb_shell
