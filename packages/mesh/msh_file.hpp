// What a gmsh file says: its numbers checked one by one, not yet a mesh.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "mesh/facets.hpp"

namespace sprekk::mesh {

/// A type of element that the reader knows.
struct MshElementType {
  int number;        ///< gmsh's
  const char* name;  ///< with the number of nodes
  int dim, n_corners, n_nodes;
  std::optional<Shape> shape;  ///< of elements that may be cells
};

/// The element type with gmsh's number, or nullptr if the reader does not know it; its name, also if not.
const MshElementType* find_msh_element_type(int number);
std::string msh_element_name(int number);

/// For each node of a cell the place of that node in gmsh's element.
std::vector<int> nodes_in_msh(Shape shape);

/// Nodes, elements and physical groups of a gmsh file.
struct MshFile {
  struct Element {
    const MshElementType* type;
    GlobalIndex tag;         ///< gmsh's number
    int groups;              ///< index into group_sets
    int entity;              ///< number of the geometrical entity; 0: not told
    std::size_t first_node;  ///< in element_nodes
  };
  /// A line of the section $Fractures, which Sprekk's own meshes of networks have and gmsh passes over: `group entity
  /// "name"`, then pairs of `"entry" "value"` that the fracture has of its own.
  struct Fracture {
    int group;   ///< number of the physical group, the set
    int entity;  ///< of the elements that are its faces; several fractures of one name are one
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

  /// The group's name, or its number where it has none.
  std::string group_name(int dim, int number) const;
};

/// Reads a gmsh file of version 2.2 or 4.1, text or binary, from `text`; `file` names it in messages. What is allocated
/// is proportional to the text. Throws an Error that names the file, the section, the line (binary: the byte), and the
/// number of the node or element, if something is missing, is not a number, or cannot be. Not collective.
MshFile parse_msh_file(std::string_view text, const std::string& file);

/// The same from the file at `path`; throws an Error, too, if there is none, or if it is of another kind or version.
MshFile read_msh_file(const std::string& path);

}  // namespace sprekk::mesh
