// Reader of gmsh meshes.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "mesh/split.hpp"

namespace sprekk::mesh {

struct MshOptions {
  /// Physical groups that are fractures, with the orientation of their normals. The groups contain lines (2D) or
  /// triangles or quadrilaterals (3D) between cells.
  std::map<std::string, Orientation> fractures;
  /// Order of the cells, 1 or 2; absent: as in the file. Cells of order 1 are raised to order 2 with straight edges,
  /// see raise_order().
  std::optional<int> order;
};

/// Reads the mesh in a gmsh file of version 2.2 or 4.1, text or binary. All cells must have one shape, of order 1 or 2.
///
/// * Cells: elements of the highest dimension. Cells with reversed orientation are mirrored.
/// * Regions: physical groups of cells; "bulk" if there is none.
/// * Boundaries: physical groups of one dimension less. Those named in `options` are fractures, and the mesh is split()
///   along them.
/// * Names: groups without a name have their number as name.
/// * Nodes: nodes without a cell are dropped. Nodes and cells remain in the order of the file. 2D meshes lie in a plane
///   z = constant; z is dropped.
///
/// Throws an Error that names the file and the line, element or group, in these cases:
/// * the file is damaged, has another version, or contains unsupported elements;
/// * a cell has no volume, is twisted or is repeated; cells overlap, or touch without common nodes;
/// * a boundary lies inside the mesh; a fracture is unknown, on the boundary, or not made of cell faces;
/// * `options` require order 1 for cells of order 2.
///
/// Not collective.
GlobalMesh read_msh(const std::string& path, const MshOptions& options = {});

/// Reads the mesh from the content of a file, like read_msh(); messages contain the name `file`.
GlobalMesh parse_msh(std::string_view text, const std::string& file, const MshOptions& options = {});

}  // namespace sprekk::mesh
