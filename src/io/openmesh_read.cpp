// SPDX-License-Identifier: Apache-2.0
#include "io/openmesh_read.h"

#include <OpenMesh/Core/IO/IOManager.hh>
#include <OpenMesh/Core/IO/importer/BaseImporter.hh>
#include <OpenMesh/Core/IO/reader/PLYReader.hh>
#include <OpenMesh/Core/IO/reader/STLReader.hh>
#include <OpenMesh/Core/System/omstream.hh>

#include <locale>
#include <mutex>
#include <sstream>

namespace vdb_shell
{
namespace
{

namespace om = OpenMesh;

/// Collects what a reader finds. A half-edge mesh in its place would drop and duplicate what is not
/// manifold, before anyone could say so.
class Collector : public om::IO::BaseImporter
{
public:
    explicit Collector(PolygonSoup& soup) : soup_(soup) {}

    om::VertexHandle add_vertex(const om::Vec3f& p) override
    {
        soup_.points.emplace_back(p[0], p[1], p[2]);
        return om::VertexHandle(static_cast<int>(soup_.points.size()) - 1);
    }
    om::VertexHandle add_vertex() override { return add_vertex(om::Vec3f(0, 0, 0)); }
    void set_point(om::VertexHandle v, const om::Vec3f& p) override
    {
        soup_.points[static_cast<std::size_t>(v.idx())] = openvdb::Vec3s(p[0], p[1], p[2]);
    }
    om::FaceHandle add_face(const VHandles& corners) override
    {
        Corners face;
        face.reserve(corners.size());
        for (const om::VertexHandle& corner : corners)
            face.push_back(static_cast<std::uint32_t>(corner.idx()));
        soup_.faces.push_back(std::move(face));
        return om::FaceHandle(static_cast<int>(soup_.faces.size()) - 1);
    }
    std::size_t n_vertices() const override { return soup_.points.size(); }
    std::size_t n_faces() const override { return soup_.faces.size(); }
    std::size_t n_edges() const override { return 0; }

    // Nothing else of a file is wanted.
    om::HalfedgeHandle add_edge(om::VertexHandle, om::VertexHandle) override
    {
        return om::HalfedgeHandle();
    }
    om::FaceHandle add_face(om::HalfedgeHandle) override { return om::FaceHandle(); }
    void add_face_texcoords(om::FaceHandle, om::VertexHandle,
                            const std::vector<om::Vec2f>&) override
    {
    }
    void add_face_texcoords(om::FaceHandle, om::VertexHandle,
                            const std::vector<om::Vec3f>&) override
    {
    }
    void set_face_texindex(om::FaceHandle, int) override {}
    void set_halfedge(om::VertexHandle, om::HalfedgeHandle) override {}
    void set_normal(om::VertexHandle, const om::Vec3f&) override {}
    void set_normal(om::VertexHandle, const om::Vec3d&) override {}
    void set_color(om::VertexHandle, const om::Vec3uc&) override {}
    void set_color(om::VertexHandle, const om::Vec4uc&) override {}
    void set_color(om::VertexHandle, const om::Vec3f&) override {}
    void set_color(om::VertexHandle, const om::Vec4f&) override {}
    void set_texcoord(om::VertexHandle, const om::Vec2f&) override {}
    void set_status(om::VertexHandle, const om::Attributes::StatusInfo&) override {}
    void set_next(om::HalfedgeHandle, om::HalfedgeHandle) override {}
    void set_face(om::HalfedgeHandle, om::FaceHandle) override {}
    void request_face_texcoords2D() override {}
    void set_texcoord(om::HalfedgeHandle, const om::Vec2f&) override {}
    void set_texcoord(om::VertexHandle, const om::Vec3f&) override {}
    void set_texcoord(om::HalfedgeHandle, const om::Vec3f&) override {}
    void set_status(om::HalfedgeHandle, const om::Attributes::StatusInfo&) override {}
    void set_color(om::EdgeHandle, const om::Vec3uc&) override {}
    void set_color(om::EdgeHandle, const om::Vec4uc&) override {}
    void set_color(om::EdgeHandle, const om::Vec3f&) override {}
    void set_color(om::EdgeHandle, const om::Vec4f&) override {}
    void set_status(om::EdgeHandle, const om::Attributes::StatusInfo&) override {}
    void set_normal(om::FaceHandle, const om::Vec3f&) override {}
    void set_normal(om::FaceHandle, const om::Vec3d&) override {}
    void set_color(om::FaceHandle, const om::Vec3uc&) override {}
    void set_color(om::FaceHandle, const om::Vec4uc&) override {}
    void set_color(om::FaceHandle, const om::Vec3f&) override {}
    void set_color(om::FaceHandle, const om::Vec4f&) override {}
    void set_status(om::FaceHandle, const om::Attributes::StatusInfo&) override {}
    void add_texture_information(int, std::string) override {}

private:
    PolygonSoup& soup_;
};

/// Keeps an OpenMesh stream from printing.
class Muted
{
public:
    explicit Muted(om::mostream& stream) : stream_(stream), was_enabled_(stream.is_enabled())
    {
        stream_.disable();
    }
    ~Muted()
    {
        if (was_enabled_)
            stream_.enable();
    }
    Muted(const Muted&) = delete;
    Muted& operator=(const Muted&) = delete;

private:
    om::mostream& stream_;
    bool was_enabled_;
};

bool run_reader(const FileScan& scan, PolygonSoup& soup)
{
    // OpenMesh's readers are singletons that keep the state of the file in hand.
    static std::mutex one_at_a_time;
    const std::lock_guard<std::mutex> lock(one_at_a_time);
    const Muted errors(omerr()), log(omlog()), output(omout());
    std::istringstream stream(scan.stream);
    stream.imbue(std::locale::classic());
    Collector collector(soup);
    om::IO::Options options;
    if (scan.binary)
        options += om::IO::Options::Binary;
    return om::IO::IOManager().read(stream, scan.reader, collector, options);
}

void require_count(const std::string& name, const char* what, std::size_t delivered,
                   std::size_t expected)
{
    if (delivered != expected)
        refuse(name, "OpenMesh delivers " + std::to_string(delivered) + " " + what +
                         " where the file has " + std::to_string(expected));
}

} // namespace

PolygonSoup read_with_openmesh(const std::string& name, const FileScan& scan)
{
    PolygonSoup soup;
    soup.points.reserve(scan.points.size());
    soup.faces.reserve(scan.faces_passed_on());
    if (!run_reader(scan, soup))
        refuse(name, "OpenMesh cannot read it");
    require_count(name, "vertices", soup.points.size(), scan.points.size());
    require_count(name, "faces", soup.faces.size(), scan.faces_passed_on());
    std::size_t corners = 0;
    for (const Corners& face : soup.faces)
        corners += face.size();
    require_count(name, "corners of faces", corners, scan.corners_passed_on);
    for (std::size_t v = 0; v < soup.points.size(); ++v)
        if (soup.points[v] != scan.points[v])
            refuse(name, "OpenMesh reads vertex " + std::to_string(v) + " as " +
                             soup.points[v].str() + " where the file has " + scan.points[v].str());
    for (std::size_t f = 0; f < soup.faces.size(); ++f)
        for (const std::uint32_t corner : soup.faces[f])
            require_corner(name, {"face", f, 0}, corner, soup.points.size(),
                           std::to_string(corner));
    return soup;
}

} // namespace vdb_shell
