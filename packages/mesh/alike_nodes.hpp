// Nodes that were one node before splitting and tying.
#pragma once

#include <optional>
#include <vector>

#include "mesh/exchange.hpp"
#include "mesh/mesh.hpp"
#include "mesh/union_find.hpp"

namespace sprekk::mesh {

/// Sets of nodes that are copies of each other or tied to each other. In a distributed mesh, which has no tied nodes,
/// sets extend over ranks. Its constructor, to_largest() and any() are then collective.
class AlikeNodes {
 public:
  explicit AlikeNodes(const GlobalMesh& mesh);
  explicit AlikeNodes(const Mesh& mesh);

  /// Number of the set of a node.
  GlobalIndex operator[](GlobalIndex node) const { return number_[node]; }

  /// Sets the values of all nodes of a set to their maximum.
  void to_largest(std::vector<GlobalIndex>& values);

  /// Returns true if `here` is true on any rank.
  bool any(bool here) const;

 private:
  UnionFind sets_;
  std::vector<GlobalIndex> number_;
  RCP<const Comm> comm_;  // null for a global mesh
  std::optional<GhostExchange> exchange_;
};

}  // namespace sprekk::mesh
