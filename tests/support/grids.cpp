// SPDX-License-Identifier: Apache-2.0
#include "support/grids.h"

#include <openvdb/io/File.h>
#include <openvdb/points/PointAttribute.h>
#include <openvdb/points/PointConversion.h>
#include <openvdb/points/PointGroup.h>
#include <openvdb/tools/LevelSetSphere.h>

namespace vdb_shell::test
{

using openvdb::points::PointDataTree;

openvdb::FloatGrid::Ptr sphere_level_set(float radius, float voxel_size)
{
    return openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(radius, openvdb::Vec3f(0.0f),
                                                                    voxel_size, 3.0f);
}

openvdb::GridBase::Ptr empty_grid(const std::string& value_type, const std::string& name)
{
    openvdb::initialize();
    const auto grid = openvdb::GridBase::createGrid("Tree_" + value_type + "_5_4_3");
    grid->setName(name);
    return grid;
}

void rewrite_vdb(const std::filesystem::path& path,
                 const std::function<void(openvdb::GridPtrVec&, openvdb::MetaMap&)>& change,
                 std::uint32_t compression)
{
    openvdb::io::File file(path.string());
    file.open(false);
    openvdb::GridPtrVec grids = *file.getGrids();
    openvdb::MetaMap metadata(*file.getMetadata());
    file.close();
    change(grids, metadata);
    openvdb::io::File out(path.string());
    out.setCompression(compression);
    out.write(grids, metadata);
}

openvdb::points::PointDataGrid::Ptr point_grid(const std::vector<openvdb::Vec3s>& positions,
                                               double voxel_size)
{
    using namespace openvdb::points;
    return createPointDataGrid<NullCodec, PointDataGrid>(
        positions, *openvdb::math::Transform::createLinearTransform(voxel_size));
}

template <typename T>
void append_attribute(PointDataTree& tree, const std::string& name, const T& value,
                      openvdb::Index stride)
{
    // Bytes are no attribute that OpenVDB knows by itself.
    if constexpr (std::is_same_v<T, std::uint8_t>)
        openvdb::points::TypedAttributeArray<T>::registerType();
    openvdb::points::appendAttribute<T>(tree, name, value, stride);
}
template void append_attribute(PointDataTree&, const std::string&, const std::uint8_t&,
                               openvdb::Index);
template void append_attribute(PointDataTree&, const std::string&, const std::int32_t&,
                               openvdb::Index);
template void append_attribute(PointDataTree&, const std::string&, const std::int64_t&,
                               openvdb::Index);
template void append_attribute(PointDataTree&, const std::string&, const float&, openvdb::Index);
template void append_attribute(PointDataTree&, const std::string&, const openvdb::Vec3s&,
                               openvdb::Index);
template void append_attribute(PointDataTree&, const std::string&, const openvdb::Vec3i&,
                               openvdb::Index);

void append_group(PointDataTree& tree, const std::string& name)
{
    openvdb::points::appendGroup(tree, name);
}

void rename_attribute(PointDataTree& tree, const std::string& from, const std::string& to)
{
    openvdb::points::renameAttribute(tree, from, to);
}

void drop_attribute(PointDataTree& tree, const std::string& name)
{
    openvdb::points::dropAttribute(tree, name);
}

} // namespace vdb_shell::test
