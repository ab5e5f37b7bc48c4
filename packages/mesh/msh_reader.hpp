// Meshes from gmsh.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "mesh/split.hpp"

namespace sprekk::mesh {

struct MshOptions {
  /// The physical groups that are fractures, with what is known of their normals. In 2D these are groups of lines, in
  /// 3D of triangles or quadrilaterals, between cells.
  std::map<std::string, Orientation> fractures;
  /// Of the cells, 1 or 2; absent: as in the file. A mesh of order 1 is raised to 2 with straight edges, see
  /// raise_order().
  std::optional<int> order;
};

/// The mesh in a gmsh file of version 2.2 or 4.1, text or binary, with cells of one shape, of order 1 or 2.
///
/// Elements of the highest dimension are the cells; the physical groups of that dimension are the regions ("bulk" if
/// there is none), those of one dimension less are the boundaries and, if `options` names them, the fractures, along
/// which the mesh is split(). A group without a name is called by its number. 2D meshes lie in a plane z = constant,
/// which is dropped. Nodes of no cell are dropped; nodes and cells keep the order of the file. Cells that are inside
/// out are mirrored.
///
/// Throws an Error that names the file and the line, element or group if the file is damaged or of another version, has
/// elements of another kind, or is no conforming mesh: a cell without volume, twisted or twice there, cells that
/// overlap or touch without sharing nodes, a boundary inside of the mesh, a fracture that is unknown, on the boundary
/// or not made of cell faces, or if `options` ask for order 1 of cells of order 2. Not collective.
GlobalMesh read_msh(const std::string& path, const MshOptions& options = {});

/// The same from the content of the file; `file` names it in messages.
GlobalMesh parse_msh(std::string_view text, const std::string& file, const MshOptions& options = {});

}  // namespace sprekk::mesh
