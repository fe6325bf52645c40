// SPDX-License-Identifier: Apache-2.0

// Reads topology and primitives: which point each vertex is at, and which vertices each primitive
// has. What it leaves true: every vertex belongs to exactly one primitive, all counts are those
// that the file declared, and vertices are numbered in the order of their primitives. Types other
// than closed polygons and tetrahedra are refused by name, since a surface without them would not
// be the one that was drawn. The forms of runs changed with Houdini 16; both are read.

#include "geometry_parts.h"

#include "vdb_shell/io/read_file.h"

#include <algorithm>
#include <numeric>

namespace vdb_shell::houdini
{
namespace
{

// Primitives come one by one or in runs of several spellings. All of them end as calls of
// Collector, which alone knows how many vertices and primitives there may be; so a new spelling
// cannot forget a test.

constexpr std::uint32_t kTetVertices = 4;

/// Collects primitives and their vertices, never more of either than the file declares.
class Collector
{
public:
    Collector(std::size_t vertices, std::size_t primitives, const Where& where)
        : vertex_count_(vertices), primitive_count_(primitives), where_(where), used_(vertices)
    {
    }

    void add(PrimitiveType type, const std::vector<std::int64_t>& vertices)
    {
        begin(type, vertices.size());
        for (const std::int64_t vertex : vertices)
            take(vertex);
    }

    /// `vertices` that follow each other from `first` on.
    void add_consecutive(PrimitiveType type, std::uint64_t first, std::uint64_t vertices)
    {
        begin(type, vertices);
        for (std::uint64_t i = 0; i < vertices; ++i)
            take(static_cast<std::int64_t>(first + i));
    }

    std::string next() const { return "primitive " + std::to_string(made_.size()); }
    std::size_t primitives_left() const { return primitive_count_ - made_.size(); }
    std::size_t vertex_count() const { return vertex_count_; }
    const Where& where() const { return where_; }

    /// Houdini keeps no vertex without a primitive, so one that is left over says that the file is
    /// damaged. With this test the order is a permutation: each vertex was taken at most once, and
    /// none is missing.
    void require_all() const
    {
        if (made_.size() != primitive_count_)
            where_.fail("it has " + std::to_string(made_.size()) + " primitives, it declares " +
                        std::to_string(primitive_count_));
        const auto unused = std::find(used_.begin(), used_.end(), false);
        if (unused != used_.end())
            where_.fail("vertex " + std::to_string(unused - used_.begin()) +
                        " belongs to no primitive");
    }

    std::vector<Primitive> take_primitives() { return std::move(made_); }
    std::vector<std::uint32_t> take_order() { return std::move(order_); }

private:
    /// Refuses before memory is taken: a run of a few bytes may declare more vertices than the file
    /// has bytes.
    void begin(PrimitiveType type, std::uint64_t vertices)
    {
        if (made_.size() == primitive_count_)
            where_.fail("it has more primitives than the " + std::to_string(primitive_count_) +
                        " that it declares");
        const bool tet = type == PrimitiveType::tetrahedron;
        if (vertices == 0 || vertices > vertex_count_ - order_.size() ||
            (tet && vertices != kTetVertices))
            where_.fail(next() + ": a " + (tet ? "tetrahedron" : "polygon") + " of " +
                        std::to_string(vertices) + " vertices, where " +
                        std::to_string(vertex_count_ - order_.size()) + " of " +
                        std::to_string(vertex_count_) + " are left");
        made_.push_back({type, static_cast<std::uint32_t>(vertices)});
    }
    void take(std::int64_t vertex)
    {
        const std::size_t primitive = made_.size() - 1;
        if (vertex < 0 || static_cast<std::uint64_t>(vertex) >= vertex_count_)
            where_.fail("primitive " + std::to_string(primitive) + ": vertex " +
                        std::to_string(vertex) + " of " + std::to_string(vertex_count_));
        if (used_[static_cast<std::size_t>(vertex)])
            where_.fail("primitive " + std::to_string(primitive) + ": vertex " +
                        std::to_string(vertex) + " belongs to an earlier primitive");
        used_[static_cast<std::size_t>(vertex)] = true;
        order_.push_back(static_cast<std::uint32_t>(vertex));
    }

    std::size_t vertex_count_, primitive_count_;
    Where where_;
    std::vector<bool> used_;
    std::vector<Primitive> made_;
    std::vector<std::uint32_t> order_;
};

[[noreturn]] void refuse_type(const Collector& into, const std::string& type)
{
    into.where().fail(into.next() + " is of type " + vdb_shell::quoted(type) +
                      "; only closed polygons and tetrahedra can be read");
}

/// An open polygon is a curve, and has no inside that a surface could be made of.
void require_closed(const Collector& into, const Fields& fields)
{
    const Value* closed = fields.find("closed");
    if (closed && !flag_of(*closed, into.where(), "closed"))
        into.where().fail(into.next() + " is an open polygon; only closed ones can be read");
}

/// The kind of run: "startvertex", "nprimitives" and, for polygons, their numbers of vertices.
void read_run(const Fields& fields, PrimitiveType type, Collector& into)
{
    const Where where = into.where().inside("the run at " + into.next());
    const Value* start = fields.find("startvertex", "s_v");
    const Value* count = fields.find("nprimitives", "n_p");
    if (!start || !count)
        where.fail("\"startvertex\" or \"nprimitives\" is missing");
    // Bounded by the number of vertices, so adding to it below cannot wrap; each vertex is held
    // against the limit again when it is taken.
    std::uint64_t vertex = count_of(*start, where, "startvertex", into.vertex_count());
    const std::size_t primitives = count_of(*count, where, "nprimitives", into.primitives_left());
    std::size_t made = 0;
    const auto add = [&](std::int64_t vertices, std::int64_t times) {
        // Bounds the loop before it starts, as `times` comes from the file.
        if (vertices < 0 || times < 0 || static_cast<std::uint64_t>(times) > primitives - made)
            where.fail(std::to_string(times) + " primitives of " + std::to_string(vertices) +
                       " vertices, where " + std::to_string(primitives - made) + " of " +
                       std::to_string(primitives) + " are left");
        for (std::int64_t i = 0; i < times; ++i, ++made) {
            into.add_consecutive(type, vertex, static_cast<std::uint64_t>(vertices));
            vertex += static_cast<std::uint64_t>(vertices);
        }
    };
    if (type == PrimitiveType::tetrahedron) {
        add(kTetVertices, static_cast<std::int64_t>(primitives));
    } else if (const Value* runs = fields.find("nvertices_rle", "r_v")) {
        // Pairs: a number of vertices, and how many primitives in a row have it.
        const auto& numbers = integers_of(*runs, where, "nvertices_rle");
        if (numbers.size() % 2 != 0)
            where.fail("\"nvertices_rle\" has " + std::to_string(numbers.size()) +
                       " entries where numbers and counts in turn are needed");
        for (std::size_t i = 0; i < numbers.size(); i += 2)
            add(numbers[i], numbers[i + 1]);
    } else if (const Value* sizes = fields.find("nvertices", "n_v")) {
        for (const std::int64_t vertices : integers_of(*sizes, where, "nvertices"))
            add(vertices, 1);
    } else {
        where.fail("\"nvertices\" and \"nvertices_rle\" are missing");
    }
    if (made != primitives)
        where.fail("it has " + std::to_string(made) + " primitives, \"nprimitives\" is " +
                   std::to_string(primitives));
}

/// The names that single primitives have, and old runs.
PrimitiveType type_of(const Collector& into, const std::string& name)
{
    if (name == "Poly")
        return PrimitiveType::polygon;
    if (name == "Tetrahedron")
        return PrimitiveType::tetrahedron;
    refuse_type(into, name);
}

/// The kind of run from before Houdini 16: fields that all primitives share, and for each primitive
/// a list of its other fields, whose names stand in "varyingfields" in the same order.
void read_old_run(const Fields& head, const Value& body, Collector& into)
{
    const Where where = into.where().inside("the run at " + into.next());
    const PrimitiveType type = type_of(into, text_of(head.at("runtype"), where, "runtype"));
    if (const Value* shared = head.find("uniformfields"))
        require_closed(into, Fields(*shared, where));
    std::size_t vertex_field = 0, closed_field = SIZE_MAX, fields = 0;
    bool has_vertex = false;
    for (const Value& field : list_of(head.at("varyingfields"), where, "varyingfields")) {
        const std::string& name = text_of(field, where, "varyingfields");
        if (name == "vertex") {
            vertex_field = fields;
            has_vertex = true;
        }
        if (name == "closed")
            closed_field = fields;
        ++fields;
    }
    if (!has_vertex)
        where.fail("\"varyingfields\" lacks \"vertex\"");
    if (is_empty(body))
        return;
    for (const Value& one : list_of(body, where, "the primitives")) {
        // The tree has made rows of a primitive whose fields are all lists of equally many numbers;
        // then the field is found by the width. That cannot be with "closed" among the fields,
        // which is a flag and no list.
        if (const auto* rows = std::get_if<Integers>(&one.data);
            rows && rows->width > 0 && rows->values.size() == fields * rows->width) {
            const auto first =
                rows->values.begin() + static_cast<std::ptrdiff_t>(vertex_field * rows->width);
            into.add(type, {first, first + static_cast<std::ptrdiff_t>(rows->width)});
            continue;
        }
        const List& parts = list_of(one, where, "a primitive");
        if (parts.size() != fields)
            where.fail(into.next() + " has " + std::to_string(parts.size()) + " fields of " +
                       std::to_string(fields));
        if (closed_field < fields && !flag_of(parts[closed_field], where, "closed"))
            where.fail(into.next() + " is an open polygon; only closed ones can be read");
        into.add(type, integers_of(parts[vertex_field], where, "vertex"));
    }
}

void read_entry(const Value& entry, Collector& into)
{
    const Where& where = into.where();
    const List& parts = list_of(entry, where.inside(into.next()), "primitives");
    if (parts.size() != 2)
        where.fail(into.next() + ": an entry of " + std::to_string(parts.size()) +
                   " parts where 2 are needed");
    const Where inside = where.inside(into.next());
    const Fields head(parts[0], inside);
    const std::string& type = text_of(head.at("type"), inside, "type");
    // p_r and t_r are short spellings of the same runs; of t_r no file from Houdini was found
    // (docs/houdini.md).
    if (type == "run")
        return read_old_run(head, parts[1], into);
    const Fields body(parts[1], inside);
    if (type == "Polygon_run" || type == "p_r")
        return read_run(body, PrimitiveType::polygon, into);
    if (type == "Tetrahedron_run" || type == "t_r")
        return read_run(body, PrimitiveType::tetrahedron, into);
    const PrimitiveType single = type_of(into, type);
    require_closed(into, body);
    into.add(single, integers_of(body.at("vertex"), inside, "vertex"));
}

std::vector<std::uint32_t> read_topology(const Value& value, std::size_t vertices,
                                         std::size_t points, const Where& where)
{
    const Fields topology(value, where);
    const Fields pointref(topology.at("pointref"), where);
    const auto& indices = integers_of(pointref.at("indices"), where, "indices");
    if (indices.size() != vertices)
        where.fail("\"indices\" has " + std::to_string(indices.size()) +
                   " entries, the file declares " + std::to_string(vertices) + " vertices");
    std::vector<std::uint32_t> result;
    result.reserve(vertices);
    for (std::size_t v = 0; v < vertices; ++v) {
        if (indices[v] < 0 || static_cast<std::uint64_t>(indices[v]) >= points)
            where.fail("vertex " + std::to_string(v) + " is at point " +
                       std::to_string(indices[v]) + " of " + std::to_string(points));
        result.push_back(static_cast<std::uint32_t>(indices[v]));
    }
    return result;
}

} // namespace

std::vector<std::uint32_t> read_primitives(const Value& topology, const Value& primitives,
                                           std::size_t vertex_count, std::size_t primitive_count,
                                           const Where& where, HoudiniGeometry& geometry)
{
    // Topology is by the file's own numbers of vertices; it is put into the new order below, when
    // that is known.
    const std::vector<std::uint32_t> vertex_point =
        read_topology(topology, vertex_count, geometry.points, where.inside("topology"));
    Collector collector(vertex_count, primitive_count, where);
    if (!is_empty(primitives))
        for (const Value& entry : list_of(primitives, where, "primitives"))
            read_entry(entry, collector);
    collector.require_all();
    geometry.primitives = collector.take_primitives();
    std::vector<std::uint32_t> order = collector.take_order();
    geometry.vertex_point.reserve(order.size());
    for (const std::uint32_t vertex : order)
        geometry.vertex_point.push_back(vertex_point[vertex]);
    // Files that Houdini wrote hold the vertices in order already, and then nothing need be moved.
    std::vector<std::uint32_t> unchanged(order.size());
    std::iota(unchanged.begin(), unchanged.end(), 0u);
    return order == unchanged ? std::vector<std::uint32_t>{} : order;
}

} // namespace vdb_shell::houdini
