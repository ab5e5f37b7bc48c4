#include "mesh/alike_nodes.hpp"

#include "base/over_ranks.hpp"

#include <numeric>

namespace sprekk::mesh {

AlikeNodes::AlikeNodes(const GlobalMesh& mesh) : sets_(mesh.n_nodes()), number_(mesh.n_nodes()) {
  for (std::size_t node = 0; node < mesh.parent_node.size(); ++node)
    sets_.join(static_cast<GlobalIndex>(node), mesh.parent_node[node]);
  for (GlobalIndex node = mesh.n_free_nodes(); node < mesh.n_nodes(); ++node) sets_.join(node, mesh.free_node(node));
  std::iota(number_.begin(), number_.end(), GlobalIndex{0});
  to_largest(number_);
}

AlikeNodes::AlikeNodes(const Mesh& mesh)
    : sets_(mesh.n_nodes()),
      number_(mesh.node_id),
      comm_(mesh.comm),
      exchange_(std::in_place, mesh.node_id, mesh.n_owned_nodes, mesh.comm) {
  for (const auto& face : mesh.fracture_faces)
    for (int k = 0; k < n_face_nodes(mesh.shape) && face.cell[minus] >= 0 && face.cell[plus] >= 0; ++k)
      sets_.join(face.nodes[minus][k], face.nodes[plus][k]);
  to_largest(number_);
}

void AlikeNodes::to_largest(std::vector<GlobalIndex>& values) {
  std::vector<GlobalIndex> before;
  do {
    before = values;
    for (std::size_t node = 0; node < values.size(); ++node) {
      auto& largest = values[sets_.find(static_cast<GlobalIndex>(node))];
      largest = std::max(largest, values[node]);
    }
    for (std::size_t node = 0; node < values.size(); ++node)
      values[node] = values[sets_.find(static_cast<GlobalIndex>(node))];
    if (exchange_) exchange_->to_largest(values);
  } while (exchange_ && any(values != before));
}

bool AlikeNodes::any(bool here) const { return comm_.is_null() ? here : base::on_any_rank(*comm_, here); }

}  // namespace sprekk::mesh
