// SPDX-License-Identifier: Apache-2.0
#pragma once

// Names of OpenVDB's grids for declarations. Including <openvdb/openvdb.h> costs a source four
// seconds of parsing and three of code that every object gets a copy of (GCC 12, OpenVDB 10.0.1),
// so headers include this, and sources that look into a grid include what they need.

#include <openvdb/Types.h>

#include <memory>

namespace openvdb
{
OPENVDB_USE_VERSION_NAMESPACE
namespace OPENVDB_VERSION_NAME
{

template <typename TreeType> class Grid;
class GridBase;

namespace tree
{
template <typename RootNodeType> class Tree;
template <typename ChildType> class RootNode;
template <typename ChildType, Index Log2Dim> class InternalNode;
template <typename ValueType, Index Log2Dim> class LeafNode;
} // namespace tree

using FloatTree = tree::Tree<
    tree::RootNode<tree::InternalNode<tree::InternalNode<tree::LeafNode<float, 3>, 4>, 5>>>;
using FloatGrid = Grid<FloatTree>;

} // namespace OPENVDB_VERSION_NAME
} // namespace openvdb

namespace vdb_shell
{

/// The same type as openvdb::FloatGrid::Ptr.
using FloatGridPtr = std::shared_ptr<openvdb::FloatGrid>;
/// Of any type of values.
using GridBasePtr = std::shared_ptr<openvdb::GridBase>;

} // namespace vdb_shell
