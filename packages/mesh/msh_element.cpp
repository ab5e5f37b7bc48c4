#include <algorithm>
#include <iterator>

#include "mesh/cell_geometry.hpp"
#include "mesh/msh_file.hpp"

namespace sprekk::mesh {
namespace {

constexpr MshElementType types[] = {{1, "2-node line", 1, 2, 2, {}},
                                    {2, "3-node triangle", 2, 3, 3, Shape::triangle},
                                    {3, "4-node quadrilateral", 2, 4, 4, Shape::quadrilateral},
                                    {4, "4-node tetrahedron", 3, 4, 4, Shape::tetrahedron},
                                    {5, "8-node hexahedron", 3, 8, 8, Shape::hexahedron},
                                    {8, "3-node line", 1, 2, 3, {}},
                                    {9, "6-node triangle", 2, 3, 6, Shape::triangle6},
                                    {10, "9-node quadrilateral", 2, 4, 9, Shape::quadrilateral9},
                                    {11, "10-node tetrahedron", 3, 4, 10, Shape::tetrahedron10},
                                    {12, "27-node hexahedron", 3, 8, 27, Shape::hexahedron27},
                                    {15, "point", 0, 1, 1, {}}};

/// Returns for each further node of the gmsh element the set of corners whose mean is this node.
std::vector<std::vector<int>> msh_corner_sets(Shape shape) {
  switch (shape) {
    case Shape::triangle6:
      return {{0, 1}, {1, 2}, {2, 0}};
    case Shape::quadrilateral9:
      return {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {0, 1, 2, 3}};
    case Shape::tetrahedron10:
      return {{0, 1}, {1, 2}, {2, 0}, {3, 0}, {2, 3}, {1, 3}};
    case Shape::hexahedron27:
      return {{0, 1},
              {0, 3},
              {0, 4},
              {1, 2},
              {1, 5},
              {2, 3},
              {2, 6},
              {3, 7},
              {4, 5},
              {4, 7},
              {5, 6},
              {6, 7},
              {0, 3, 2, 1},
              {0, 1, 5, 4},
              {0, 4, 7, 3},
              {1, 2, 6, 5},
              {2, 3, 7, 6},
              {4, 5, 6, 7},
              {0, 1, 2, 3, 4, 5, 6, 7}};
    default:
      return {};
  }
}

}  // namespace

const MshElementType* find_msh_element_type(int number) {
  const auto found =
      std::find_if(std::begin(types), std::end(types), [&](const auto& t) { return t.number == number; });
  return found == std::end(types) ? nullptr : found;
}

std::string msh_element_name(int number) {
  if (const auto* type = find_msh_element_type(number)) return type->name;
  constexpr std::pair<int, const char*> refused[] = {
      {6, "6-node prism"},           {7, "5-node pyramid"},      {13, "18-node prism"}, {14, "14-node pyramid"},
      {16, "8-node quadrilateral"},  {17, "20-node hexahedron"}, {18, "15-node prism"}, {19, "13-node pyramid"},
      {20, "9-node triangle"},       {21, "10-node triangle"},   {26, "4-node line"},   {29, "20-node tetrahedron"},
      {36, "16-node quadrilateral"}, {92, "64-node hexahedron"}};
  for (const auto& [other, name] : refused)
    if (other == number) return name;
  return "element of type " + std::to_string(number);
}

std::vector<int> nodes_in_msh(Shape shape) {
  std::vector<unsigned> in_msh(n_corners(shape));
  for (int k = 0; k < n_corners(shape); ++k) in_msh[k] = 1u << k;
  for (const auto& corners : msh_corner_sets(shape)) {
    in_msh.push_back(0);
    for (int corner : corners) in_msh.back() |= 1u << corner;
  }
  std::vector<int> result;
  for (unsigned corners : corners_of_nodes(shape))
    result.push_back(static_cast<int>(std::find(in_msh.begin(), in_msh.end(), corners) - in_msh.begin()));
  return result;
}

}  // namespace sprekk::mesh
