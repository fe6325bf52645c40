// SPDX-License-Identifier: Apache-2.0

// Reads the groups of one class of elements, in both spellings: a byte per element, or runs of
// counts and flags. A group is kept as one flag per element. Ordered groups have an order that
// there is no place for, so they are named as unread rather than read as something else. Every
// group must tell of exactly as many elements as there are, for a shorter one would leave the last
// to chance.

#include "geometry_parts.h"

#include "vdb_shell/io/read_file.h"

#include <set>

namespace vdb_shell::houdini
{
namespace
{

/// Runs: counts and flags in turn. Each count is bounded by the elements that are still to come, so
/// the runs cannot make the vector longer than the geometry allows.
std::vector<bool> from_runs(const Value& value, std::size_t elements, const Where& where)
{
    std::vector<bool> members;
    members.reserve(elements);
    const List& runs = list_of(value, where, "boolRLE");
    if (runs.size() % 2 != 0)
        where.fail("\"boolRLE\" has " + std::to_string(runs.size()) +
                   " entries where counts and flags in turn are needed");
    for (std::size_t i = 0; i < runs.size(); i += 2) {
        const std::size_t count = count_of(runs[i], where, "boolRLE", elements - members.size());
        members.insert(members.end(), count, flag_of(runs[i + 1], where, "boolRLE"));
    }
    return members;
}

std::vector<bool> from_bytes(const Value& value, const Where& where)
{
    // An array of bits is taken as well, as it tells the same.
    if (std::holds_alternative<Booleans>(value.data))
        return std::get<Booleans>(value.data);
    std::vector<bool> members;
    for (const std::int64_t byte : integers_of(value, where, "i8")) {
        if (byte != 0 && byte != 1)
            where.fail("\"i8\" has " + std::to_string(byte) + " where 0 or 1 is needed");
        members.push_back(byte == 1);
    }
    return members;
}

} // namespace

std::vector<Group> read_groups(const Value& value, std::size_t elements, const Where& where,
                               const char* kind, Budget& budget, std::vector<std::string>& unread)
{
    std::vector<Group> groups;
    std::set<std::string> seen;
    if (is_empty(value))
        return groups;
    // std::vector<bool> takes a bit for each element; that is what a group costs in memory.
    constexpr unsigned kBitsPerByte = 8;
    for (const Value& entry : list_of(value, where, kind)) {
        const List& parts = list_of(entry, where.inside(kind), "group");
        if (parts.size() != 2)
            where.inside(kind).fail("a group of " + std::to_string(parts.size()) +
                                    " parts where 2 are needed");
        Group group;
        group.name =
            text_of(Fields(parts[0], where.inside(kind)).at("name"), where.inside(kind), "name");
        const std::string title = std::string(kind) + " " + vdb_shell::quoted(group.name);
        const Where inside = where.inside(title);
        const Fields body(parts[1], inside);
        const Fields selection(body.at("selection"), inside);
        const Value* unordered = selection.find("unordered");
        if (!unordered) {
            unread.push_back(title + ", which is ordered");
            continue;
        }
        // Groups are found by name, so of two equal ones only the first would ever be seen.
        if (!seen.insert(group.name).second)
            inside.fail("it is there twice");
        // A group of runs takes a few bytes in the file whatever the number of elements, so a file
        // could ask for any number of large groups.
        budget.spend(elements / kBitsPerByte, inside);
        const Fields stored(*unordered, inside);
        if (const Value* runs = stored.find("boolRLE"))
            group.members = from_runs(*runs, elements, inside);
        else
            group.members = from_bytes(stored.at("i8"), inside);
        if (group.members.size() != elements)
            inside.fail("it tells of " + std::to_string(group.members.size()) + " elements of " +
                        std::to_string(elements));
        groups.push_back(std::move(group));
    }
    return groups;
}

} // namespace vdb_shell::houdini
