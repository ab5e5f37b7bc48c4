// Fracture network in a scene: fractures in a domain, meshed with gmsh by apps/mesh.
#pragma once

#include "base/parameters.hpp"
#include "base/types.hpp"

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace sprekk::model {

/// Input of `sprekk mesh`. Angles are in degrees; x points east, y north, z up.
struct Network {
  /// Polyline or plane polygon.
  struct Points {
    std::vector<Real> points;
    void describe(base::Section& section);
  };

  /// Box, polygon (2D) or polyhedron (3D).
  struct Body {
    std::vector<Real> lower_corner, upper_corner;
    std::vector<Real> corners;
    std::map<std::string, Points> faces;
    void describe(base::Section& section);
  };

  struct Domain : Body {
    std::vector<std::string> sides;  ///< names of the sides of a polygon; the first side is from corner 0 to 1
    void describe(base::Section& section);
  };

  struct Ellipse {
    std::vector<Real> centre, radii;
    Real strike = 0, dip = 0, rake = 0;
    void describe(base::Section& section);
  };

  /// Random fractures.
  struct Random {
    int number = 0, seed = 1, corners = 12;
    Real shortest = 0, longest = 0, exponent = 2.5;
    Real strike = 0, dip = 0, concentration = 0;
    void describe(base::Section& section);
  };

  /// Fractures that form one physical group of the mesh, or surfaces to which the cells conform.
  struct Set {
    std::optional<std::string> file;  ///< relative to the scene file
    std::optional<std::string> format;
    std::vector<std::string> layers;  ///< layers of the file; empty: all
    std::optional<Real> unit;         ///< unit of the coordinates in the file, m
    std::vector<Real> window;         ///< lowest and highest corner of a box that crops the file, m; empty: none
    std::optional<int> corners;       ///< of the polygon of an ellipse or a disc
    std::map<std::string, Points> lines, polygons;
    std::map<std::string, Ellipse> ellipses;
    std::optional<Random> random;
    void describe(base::Section& section);
  };

  std::optional<Domain> domain;  ///< absent: in the file of a set
  std::map<std::string, Set> fractures, constraints;
  std::map<std::string, Body> regions;
  Real relative_size = 0.1;
  std::optional<Real> size, size_at_tips, size_at_intersections, size_at_boundary;
  Real growth = 0.5;
  std::optional<Real> tolerance, minimum_distance;
  Real minimum_angle = 2;
  int maximum_cells = 10000000;
  std::string unusable = "refused";  ///< or "left out"
  std::string repair = "report";     ///< or "join", "drop"
  void describe(base::Section& section);

  /// Makes file names absolute; they are relative to `folder`.
  void resolve_files(const std::string& folder);
};

/// Reads the network of the scene at `path` and nothing else. Returns its `Mesh file > network` with all defaults as
/// XML. The entry "entries of joints" contains the names of entries that files of fractures may set, the section
/// "choices of joints" the words that some of them take. Throws an Error with a line for each mistake. Collective.
std::string network_description(const Comm& comm, const std::string& path, const std::vector<std::string>& overrides);

}  // namespace sprekk::model
