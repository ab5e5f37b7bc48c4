// Nodes that are one node of the mesh before it was split and tied.
#pragma once

#include <optional>
#include <vector>

#include "mesh/exchange.hpp"
#include "mesh/mesh.hpp"
#include "mesh/union_find.hpp"

namespace sprekk::mesh {

/// Sets of nodes that are copies of one another or tied to each other. Of a distributed mesh, which has no tied nodes,
/// the sets reach over the ranks; construction, to_largest() and any() are collective.
class AlikeNodes {
 public:
  explicit AlikeNodes(const GlobalMesh& mesh);
  explicit AlikeNodes(const Mesh& mesh);

  /// The number of a node's set.
  GlobalIndex operator[](GlobalIndex node) const { return number_[node]; }

  /// Gives all nodes of a set the largest of their values.
  void to_largest(std::vector<GlobalIndex>& values);

  /// Whether it is so on any rank.
  bool any(bool here) const;

 private:
  UnionFind sets_;
  std::vector<GlobalIndex> number_;
  RCP<const Comm> comm_;  // of a distributed mesh
  std::optional<GhostExchange> exchange_;
};

}  // namespace sprekk::mesh
