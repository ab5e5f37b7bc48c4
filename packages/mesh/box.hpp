// Structured meshes of a rectangle or a box, with plane fractures on mesh planes.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "mesh/mesh.hpp"

namespace sprekk::base {
class Section;
}

namespace sprekk::mesh {

/// Parameters of a box mesh. The number of components of the corners determines the dimension.
struct BoxMesh {
  /// Axis-parallel rectangle (2D: segment). Its corners differ in all directions except one.
  struct Fracture {
    std::vector<Real> lower_corner, upper_corner;       ///< metre, before the rotation; on mesh planes
    std::optional<std::vector<Real>> reference_normal;  ///< see orient(); before the rotation
    bool swap_sides = false;
    void describe(base::Section& section);
  };

  /// Axis-parallel box. The region consists of the cells with their centre in the box.
  struct Region {
    std::vector<Real> lower_corner, upper_corner;  ///< metre, before the rotation
    void describe(base::Section& section);
  };

  std::string cell = "quadrilateral";
  std::vector<Real> lower_corner{0, 0}, upper_corner{1, 1};  ///< metre, before the rotation
  std::vector<int> cells{1, 1};                              ///< squares or cubes in each direction
  int order = 1;                                             ///< order of the cells: 1 or 2
  int refinements = 0;                                       ///< see describe_refinements(); make_box() ignores it
  std::string tips = "enriched";          ///< treatment of crack tips, see describe_tips(); make_box() ignores it
  std::map<std::string, Region> regions;  ///< in addition to "bulk"; in overlaps the last name applies
  std::map<std::string, Fracture> fractures;
  Real rotation = 0;                         ///< degree, counter-clockwise about the origin (3D: about the axis)
  std::vector<Real> rotation_axis{0, 0, 1};  ///< 3D; through the origin
  std::optional<int> renumbering_seed;       ///< see renumbered()
  std::vector<std::string> periodic;         ///< directions x, y, z with tied opposite sides, see tie_periodic()
  void describe(base::Section& section);
};

/// Declares the entry `periodic` of a mesh section: the tied sides. A repeated name is an error.
void describe_periodic(base::Section& section, std::vector<std::string>& periodic, const std::string& meaning);

/// Declares the entry `refinements` of a mesh section: number of uniform refinements of the distributed mesh.
/// Refinement requires an empty `periodic`.
void describe_refinements(base::Section& section, int& refinements, const std::vector<std::string>& periodic);

/// Declares the entry `tips` of a mesh section: treatment of crack tips.
void describe_tips(base::Section& section, std::string& tips);

/// Makes the mesh of a box. Each square is cut into two triangles with alternating diagonals, each cube into six Kuhn
/// tetrahedra.
///
/// Regions: "bulk", then those of the parameters. Boundaries: "west" (x-), "east" (x+), "south" (y-), "north" (y+),
/// "bottom" (z-), "top" (z+), named before the rotation. Fractures are in the order of their names. They are split and
/// oriented (see split()) after the rotation. Throws an Error for inconsistent parameters, for fractures that overlap,
/// lie on the boundary, or are not on a mesh plane.
GlobalMesh make_box(const BoxMesh& box);

}  // namespace sprekk::mesh
