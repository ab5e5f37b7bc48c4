// A fracture network as a scene describes it: fractures in a domain, of which apps/mesh makes a mesh of gmsh.
#pragma once

#include "base/parameters.hpp"
#include "base/types.hpp"

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace sprekk::model {

/// What `sprekk mesh` reads. Angles in degree; x points east, y north, z up.
struct Network {
  /// A polyline or a plane polygon.
  struct Points {
    std::vector<Real> points;
    void describe(base::Section& section);
  };

  /// A box, a polygon (2D) or a polyhedron (3D).
  struct Body {
    std::vector<Real> lower_corner, upper_corner;
    std::vector<Real> corners;
    std::map<std::string, Points> faces;
    void describe(base::Section& section);
  };

  struct Domain : Body {
    std::vector<std::string> sides;  ///< names of the sides of a polygon, from corner 0 to 1 on
    void describe(base::Section& section);
  };

  struct Ellipse {
    std::vector<Real> centre, radii;
    Real strike = 0, dip = 0, rake = 0;
    void describe(base::Section& section);
  };

  /// Fractures at random.
  struct Random {
    int number = 0, seed = 1, corners = 12;
    Real shortest = 0, longest = 0, exponent = 2.5;
    Real strike = 0, dip = 0, concentration = 0;
    void describe(base::Section& section);
  };

  /// Fractures that are one physical group of the mesh, or surfaces that cells keep to.
  struct Set {
    std::optional<std::string> file;  ///< relative to the scene's file
    std::optional<std::string> format;
    std::vector<std::string> layers;  ///< of the file; empty: all
    std::optional<Real> unit;         ///< of coordinates in the file, in metres
    std::map<std::string, Points> lines, polygons;
    std::map<std::string, Ellipse> ellipses;
    std::optional<Random> random;
    void describe(base::Section& section);
  };

  std::optional<Domain> domain;  ///< or in the file of a set
  std::map<std::string, Set> fractures, constraints;
  std::map<std::string, Body> regions;
  Real relative_size = 0.1;
  std::optional<Real> size, size_at_tips, size_at_intersections, size_at_boundary;
  Real growth = 0.5;
  std::optional<Real> tolerance, minimum_distance;
  Real minimum_angle = 2;
  int most_cells = 10000000;
  std::string unusable = "refused";  ///< or "left out"
  void describe(base::Section& section);

  /// Makes names of files absolute, which are relative to `folder`.
  void resolve_files(const std::string& folder);
};

/// The network of the scene at `path`, of which nothing else is read: its `Mesh file > network` with all defaults as
/// XML. Throws an Error with a line for each thing that is wrong. Collective.
std::string network_description(const Comm& comm, const std::string& path, const std::vector<std::string>& overrides);

}  // namespace sprekk::model
