// Content of a gmsh file: every number is checked, but no mesh is built yet.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "mesh/facets.hpp"

namespace sprekk::mesh {

/// Element type supported by the reader.
struct MshElementType {
  int number;        ///< number in gmsh
  const char* name;  ///< name with the number of nodes
  int dim, n_corners, n_nodes;
  std::optional<Shape> shape;  ///< for elements that may be cells
};

/// find_msh_element_type() returns the type with a gmsh number, or nullptr for unsupported types. msh_element_name()
/// returns its name, also for unsupported types.
const MshElementType* find_msh_element_type(int number);
std::string msh_element_name(int number);

/// Returns for each node of a cell its position in the gmsh element.
std::vector<int> nodes_in_msh(Shape shape);

/// Nodes, elements and physical groups of a gmsh file.
struct MshFile {
  struct Element {
    const MshElementType* type;
    GlobalIndex tag;         ///< element number in gmsh
    int groups;              ///< index into group_sets
    int entity;              ///< number of the geometrical entity; 0 if the file has none
    std::size_t first_node;  ///< index into element_nodes
  };
  /// Line of the section $Fractures: `group entity "name"`, then pairs `"entry" "value"` of the fracture. Sprekk writes
  /// this section into meshes of networks; gmsh ignores it.
  struct Fracture {
    int group;   ///< number of the physical group, which is the set
    int entity;  ///< entity of its faces; lines with equal names form one fracture
    std::string name;
    std::map<std::string, std::string> properties;
  };
  std::map<std::pair<int, int>, std::string> group_names;  ///< by dimension and number
  std::vector<Fracture> fractures;
  std::vector<GlobalIndex> node_tags;
  std::vector<Vector> points;  ///< [node]
  std::vector<Element> elements;
  std::vector<GlobalIndex> element_nodes;    ///< indices into points, in gmsh's order
  std::vector<std::vector<int>> group_sets;  ///< numbers of physical groups

  /// Name of the group, or its number as text if it has no name.
  std::string group_name(int dim, int number) const;
};

/// Reads a gmsh file of version 2.2 or 4.1, text or binary, from `text`. Messages contain the name `file`. The
/// allocated memory is proportional to the text. Throws an Error if something is missing, not a number, or impossible.
/// The Error names the file, the section, the line (binary: the byte), and the node or element. Not collective.
MshFile parse_msh_file(std::string_view text, const std::string& file);

/// Reads the file at `path`, like parse_msh_file(). Throws an Error also for a missing file, another format or version.
MshFile read_msh_file(const std::string& path);

}  // namespace sprekk::mesh
