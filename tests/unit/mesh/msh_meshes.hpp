// Gmsh meshes of the tests, and a small mesh as text.
#pragma once

#include <fstream>
#include <sstream>
#include <string>

#include "mesh/msh_reader.hpp"
#include "meshes.hpp"
#include "source_dir.hpp"

namespace sprekk::mesh::testing {

inline std::string path_of(const std::string& name) {
  return tests::source_dir() + "/tests/data/meshes/" + name + ".msh";
}

inline std::string content_of(const std::string& name) {
  std::ifstream file(path_of(name), std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

/// Returns options with the fractures f1 ... fn, without orientation.
inline MshOptions fractures(int n) {
  MshOptions options;
  for (int f = 1; f <= n; ++f) options.fractures["f" + std::to_string(f)] = {};
  return options;
}

inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  EXPECT_NE(at, std::string::npos) << "the text has no " << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

/// Two adjacent unit squares with the fracture "f1" between them and the boundary "west".
inline const std::string two_squares =
    "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n"
    "$PhysicalNames\n3\n1 1 \"f1\"\n1 2 \"west\"\n2 3 \"old rock\"\n$EndPhysicalNames\n"
    "$Nodes\n6\n1 0 0 0\n2 1 0 0\n3 2 0 0\n4 0 1 0\n5 1 1 0\n6 2 1 0\n$EndNodes\n"
    "$Elements\n4\n20 1 2 1 1 2 5\n21 1 2 2 2 1 4\n10 3 2 3 1 1 2 5 4\n11 3 2 3 1 2 3 6 5\n$EndElements\n";

/// Mesh `two_squares` in format 4.1.
inline const std::string two_squares_4 =
    "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n"
    "$PhysicalNames\n3\n1 1 \"f1\"\n1 2 \"west\"\n2 3 \"old rock\"\n$EndPhysicalNames\n"
    "$Entities\n0 2 1 0\n1 1 0 0 1 1 0 1 1 0\n2 0 0 0 0 1 0 1 2 0\n7 0 0 0 2 1 0 1 3 0\n$EndEntities\n"
    "$Nodes\n1 6 1 6\n2 7 0 6\n1\n2\n3\n4\n5\n6\n0 0 0\n1 0 0\n2 0 0\n0 1 0\n1 1 0\n2 1 0\n$EndNodes\n"
    "$Elements\n3 4 10 21\n1 1 1 1\n20 2 5\n1 2 1 1\n21 1 4\n2 7 3 2\n10 1 2 5 4\n11 2 3 6 5\n$EndElements\n";

}  // namespace sprekk::mesh::testing
