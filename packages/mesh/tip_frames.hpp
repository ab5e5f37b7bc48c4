// Frames at the tips of fractures.
#pragma once

#include "mesh/facets.hpp"

#include <array>
#include <unordered_map>
#include <vector>

namespace sprekk::mesh {

/// Axes at the local tips of a mesh (Mesh::tip): ahead of the fracture, along its normal, along its front. Refers to
/// the mesh.
class TipFrames {
 public:
  explicit TipFrames(const Mesh& mesh);

  /// Sets the axes at a tip that is a corner of a local cell, unit vectors; in 2D without the third. The direction of
  /// the front is that of the front edge of the cell at this tip. Without such an edge, it is the mean direction of the
  /// front edges around the tip. Other fronts do not count. Returns false if no fracture is known to end there, e.g. at
  /// a node tied to a tip.
  bool find(LocalIndex cell, LocalIndex tip, std::array<Vector, 3>& axes) const;

 private:
  struct Frame {
    Vector normal{}, behind{}, along{};  // not of unit length; along = ahead x normal
    std::vector<LocalIndex> next;        // other end nodes of the front edges
  };
  Vector from_to(LocalIndex a, LocalIndex b) const;
  void add(const Mesh::FractureFace& face, int k);
  Vector front(LocalIndex cell, LocalIndex tip, const std::vector<LocalIndex>& next) const;

  const Mesh& mesh_;
  std::unordered_map<LocalIndex, Frame> frames_;
};

}  // namespace sprekk::mesh
