// SPDX-License-Identifier: Apache-2.0

// The rules for metadata of a .vdb that is to be read by Houdini: which keys and types become
// attributes of primitives or of the detail, and which are dropped or changed without a word. They
// come from the conversion code that OpenVDB publishes for Houdini and from Houdini's
// documentation; docs/vdb_conventions.md has the table, and says that Houdini itself was not run.
// Each function appends what breaks a rule and goes on, so one run names all of it.

#include "vdb_rules.h"

#include "vdb_shell/core/words.h"

#include <nlohmann/json.hpp>

#include <set>
#include <string_view>

namespace vdb_shell
{
namespace
{

using openvdb::GridBase;
using openvdb::Metadata;
using openvdb::MetaMap;

constexpr const char* kGlobalPrefix = "global:";
constexpr const char* kDictionaryPrefix = "dict_";

/// The keys that OpenVDB and Houdini themselves keep about a grid, with their types. They are held
/// against those types only, since none of them becomes an attribute of the user's. The names of
/// types are OpenVDB's, as they stand in the file.
const std::map<std::string, std::string>& own_keys()
{
    static const std::map<std::string, std::string> keys{
        {GridBase::META_GRID_NAME, "string"},
        {GridBase::META_GRID_CLASS, "string"},
        {GridBase::META_GRID_CREATOR, "string"},
        {GridBase::META_VECTOR_TYPE, "string"},
        {GridBase::META_SAVE_HALF_FLOAT, "bool"},
        {GridBase::META_IS_LOCAL_SPACE, "bool"},
        {GridBase::META_FILE_BBOX_MIN, "vec3i"},
        {GridBase::META_FILE_BBOX_MAX, "vec3i"},
        {GridBase::META_FILE_COMPRESSION, "string"},
        {GridBase::META_FILE_MEM_BYTES, "int64"},
        {GridBase::META_FILE_VOXEL_COUNT, "int64"},
        {GridBase::META_FILE_DELAYED_LOAD, "__delayedload"},
        {"value_type", "string"},
        {"group_viewport", "string"}};
    return keys;
}

/// The metadata that become attributes of the primitive or the detail.
bool becomes_attribute(const std::string& type)
{
    static const std::set<std::string> kept{"bool",  "float", "double", "int32", "int64", "string",
                                            "vec2i", "vec2s", "vec2d",  "vec3i", "vec3s", "vec3d",
                                            "vec4i", "vec4s", "vec4d",  "mat4s", "mat4d"};
    return kept.count(type) > 0;
}

/// The same for what stands under `global:`, which has fewer types. A vec3i is no longer one of
/// them: it would lose all but its first number.
bool becomes_detail(const std::string& type)
{
    static const std::set<std::string> kept{"bool",   "int32", "int64", "float",
                                            "double", "vec3s", "vec3d", "string"};
    return kept.count(type) > 0;
}

/// The type is tested first: str() gives some text for every type of metadata, and a number would
/// pass for JSON that is not an object, with a misleading message.
void check_dictionary(const std::string& grid, const std::string& key, const Metadata& value,
                      VdbViolations& found)
{
    if (value.typeName() != "string")
        found.push_back({"dictionary", grid, key,
                         "the type is " + value.typeName() + ", expected a string of JSON"});
    else if (!nlohmann::json::parse(value.str(), nullptr, false).is_object())
        found.push_back({"dictionary", grid, key,
                         "the string is not one JSON object; it becomes an empty dictionary"});
}

/// Metadata that become an attribute of Houdini under `key`. The rules are independent of each
/// other, so one entry may break several.
void check_entry(const std::string& grid, const std::string& key, const Metadata& value,
                 VdbViolations& found)
{
    const std::string type = value.typeName();
    if (!becomes_attribute(type))
        found.push_back({"metadata-type", grid, key, "the type is " + type + ", which is dropped"});
    if (!is_houdini_name(key))
        found.push_back({"metadata-name", grid, key,
                         "a name of letters, digits and _ is expected, no digit first"});
    if (begins_with(key, kDictionaryPrefix))
        check_dictionary(grid, key, value, found);
    // By that name Houdini takes an integer for a flag, and what is not 0 or 1 is lost when it
    // saves.
    if (begins_with(key, "is_") && (type == "int32" || type == "int64"))
        found.push_back(
            {"is-bool", grid, key, "the type is " + type + "; Houdini saves it as a bool"});
}

/// The place in `name[place]`, or -1 when there is none.
int tuple_place(const std::string& key)
{
    const std::size_t open = key.find('[');
    if (open == std::string::npos || key.back() != ']')
        return -1;
    const std::string digits = key.substr(open + 1, key.size() - open - 2);
    // Keeps std::stoi from throwing on a number that no tuple has.
    constexpr std::size_t kMostDigits = 6;
    if (digits.empty() || digits.size() > kMostDigits ||
        digits.find_first_not_of("0123456789") != std::string::npos)
        return -1;
    return std::stoi(digits);
}

void check_global(const GridBase& grid, const std::string& key, const Metadata& value,
                  VdbViolations& found)
{
    const std::string name = key.substr(std::string_view(kGlobalPrefix).size());
    // Houdini joins `name[0]`, `name[1]` and so on to one attribute with several components; `base`
    // is its name.
    const std::string base = name.substr(0, name.find('['));
    if (grid.valueType() != "ptdataidx32")
        found.push_back({"global-metadata", grid.getName(), key,
                         std::string("only grids of points turn ") + kGlobalPrefix +
                             " into detail attributes"});
    if (!becomes_detail(value.typeName()))
        found.push_back({"global-metadata", grid.getName(), key,
                         "the type is " + value.typeName() + ", which no detail attribute takes"});
    if (!is_houdini_name(base))
        found.push_back({"metadata-name", grid.getName(), key,
                         "a name of letters, digits and _ is expected, no digit first"});
    if (base == name)
        return;
    const int place = tuple_place(name);
    // Only the element before is looked up: by induction all elements from 0 on are there, or the
    // first gap has been named.
    const Metadata::ConstPtr before =
        place > 0 ? grid[kGlobalPrefix + base + "[" + std::to_string(place - 1) + "]"] : nullptr;
    if (place < 0)
        found.push_back({"global-tuple", grid.getName(), key, "[NUMBER] is expected at the end"});
    else if (place > 0 && (!before || before->typeName() != value.typeName()))
        found.push_back({"global-tuple", grid.getName(), key,
                         "element " + std::to_string(place - 1) +
                             " of the tuple is missing or of another type"});
}

void check_own_key(const GridBase& grid, const std::string& key, const Metadata& value,
                   const std::string& type, VdbViolations& found)
{
    if (value.typeName() != type) {
        found.push_back({"own-metadata", grid.getName(), key,
                         "the type is " + value.typeName() + ", expected " + type});
        return;
    }
    if (key == "value_type" && value.str() != grid.valueType())
        found.push_back({"value-type", grid.getName(), key,
                         "it says \"" + value.str() + "\", the grid has " + grid.valueType()});
}

} // namespace

void check_file_metadata(const MetaMap& metadata, VdbViolations& found)
{
    const Metadata::ConstPtr creator = metadata["creator"];
    if (!creator || creator->typeName() != "string" || creator->str().empty())
        found.push_back({"creator", "", "creator",
                         "expected a string that names the program which wrote the file"});
    for (auto entry = metadata.beginMeta(); entry != metadata.endMeta(); ++entry)
        // The creator is OpenVDB's own way to say who wrote the file, and has its rule above.
        if (entry->first != "creator" && entry->second)
            check_entry("", entry->first, *entry->second, found);
}

void check_grid_metadata(const GridBase& grid, TypesByName& types, VdbViolations& found)
{
    const std::string name = grid.getName();
    for (auto entry = grid.beginMeta(); entry != grid.endMeta(); ++entry) {
        const std::string& key = entry->first;
        if (!entry->second)
            continue;
        const Metadata& value = *entry->second;
        const auto own = own_keys().find(key);
        if (own != own_keys().end()) {
            check_own_key(grid, key, value, own->second, found);
            continue;
        }
        if (begins_with(key, kGlobalPrefix))
            check_global(grid, key, value, found);
        else
            check_entry(name, key, value, found);
        // All grids of a file become primitives of one geometry, where an attribute has one type.
        // The first grid that has the key decides; each later one of another type is named together
        // with it.
        const auto [first, is_new] =
            types.metadata.insert({key, TypesByName::Entry{value.typeName(), name}});
        if (!is_new && first->second.type != value.typeName())
            found.push_back({"metadata-clash", name, key,
                             "the type is " + value.typeName() + ", in grid \"" +
                                 first->second.grid + "\" it is " + first->second.type});
    }
}

} // namespace vdb_shell
