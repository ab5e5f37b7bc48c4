// Structured meshes of a rectangle or a box, with plane fractures along mesh planes.
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

/// Parameters of a box mesh. The length of the corners fixes the dimension.
struct BoxMesh {
  /// An axis-parallel rectangle (2D: segment): its corners differ in all directions but one.
  struct Fracture {
    std::vector<Real> lower_corner, upper_corner;       ///< metre, before the rotation; on mesh planes
    std::optional<std::vector<Real>> reference_normal;  ///< see orient(); before the rotation
    bool swap_sides = false;
    void describe(base::Section& section);
  };

  /// An axis-parallel box; cells whose centre lies in it belong to the region.
  struct Region {
    std::vector<Real> lower_corner, upper_corner;  ///< metre, before the rotation
    void describe(base::Section& section);
  };

  std::string cell = "quadrilateral";
  std::vector<Real> lower_corner{0, 0}, upper_corner{1, 1};  ///< metre, before the rotation
  std::vector<int> cells{1, 1};                              ///< squares or cubes in each direction
  int order = 1;                                             ///< of the cells: 1 or 2
  int refinements = 0;                                       ///< see describe_refinements(); no matter to make_box()
  std::string tips = "enriched";          ///< what is done about crack tips, see describe(); no matter to make_box()
  std::map<std::string, Region> regions;  ///< besides "bulk"; of several that hold a cell the last by name counts
  std::map<std::string, Fracture> fractures;
  Real rotation = 0;                         ///< degree, counter-clockwise about the origin (3D: about the axis)
  std::vector<Real> rotation_axis{0, 0, 1};  ///< 3D; through the origin
  std::optional<int> renumbering_seed;       ///< see renumbered()
  std::vector<std::string> periodic;  ///< directions x, y, z in which opposite sides are tied, see tie_periodic()
  void describe(base::Section& section);
};

/// The entry of any mesh's section that says which sides are tied, by names none of which may occur twice.
void describe_periodic(base::Section& section, std::vector<std::string>& periodic, const std::string& meaning);

/// The entry of any mesh's section that says how often cells are refined once they are distributed; `periodic` are its
/// entries of that name, which must be empty then.
void describe_refinements(base::Section& section, int& refinements, const std::vector<std::string>& periodic);

/// The entry of any mesh's section that says what is done about crack tips.
void describe_tips(base::Section& section, std::string& tips);

/// The mesh of a box. Squares are cut into two triangles with alternating diagonals, cubes into six Kuhn tetrahedra.
///
/// Region "bulk", then those of the parameters; boundaries "west" (x-), "east" (x+), "south" (y-), "north" (y+),
/// "bottom" (z-), "top" (z+), named before the rotation. Fractures in the order of their names, split and oriented (see
/// split()) after the rotation. Throws an Error if the parameters contradict each other, if a fracture leaves the mesh
/// planes or lies on the boundary, and if two fractures overlap.
GlobalMesh make_box(const BoxMesh& box);

}  // namespace sprekk::mesh
