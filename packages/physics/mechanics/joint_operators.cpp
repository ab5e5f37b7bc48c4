#include "physics/mechanics/joint_operators.hpp"

#include "assembly/assembler.hpp"
#include "assembly/tip_cell.hpp"
#include "base/host_table.hpp"
#include "physics/mechanics/joint_face.hpp"

#include <type_traits>

namespace sprekk::physics {

using assembly::Loop;

namespace {

/// Face means of psi for the nodes of a side, in the order of face.nodes. If the fracture ends at another one, the tip
/// is on one side only.
assembly::FaceValues tip_shares(const mesh::Mesh& mesh, const mesh::Mesh::FractureFace& face, int side,
                                const std::shared_ptr<assembly::TipRules>& rules) {
  assembly::FaceValues shares{};
  const LocalIndex cell = face.cell[side];
  if (!assembly::has_tip(mesh, cell)) return shares;
  const int n = mesh::n_face_nodes(mesh.shape), local_face = face.local_face[side];
  const auto means = mesh::for_corners(
      mesh.shape, [&](auto shape) { return assembly::TipCell<shape()>(mesh, cell, rules).face_means(local_face); });
  for (int k = 0; k < n; ++k) {
    const int node = mesh::face_nodes(mesh.shape)[local_face][k];
    for (int l = 0; l < n; ++l)
      if (face.nodes[side][l] == mesh.cells[cell * mesh.nodes_per_cell() + node]) shares[l] = means[k];
  }
  return shares;
}

template <class Face>
class OperatorsOf final : public JointOperators<Face::dim> {
 public:
  static constexpr int dim = Face::dim, n = Face::n;
  using Points = laws::JointPoints<dim>;

  OperatorsOf(const assembly::Context& context, const std::vector<int>& fields, int power_to,
              const ConstView<Real**>& rest)
      : faces_(context, Loop::fracture_faces, {fields[2]}, fields, Faces::Positions::keep) {
    set_shares(*context.mesh());
    face_.rest = rest;
    if (power_to < 0) return;
    sliding_ = std::make_unique<Sliding>(context, Loop::fracture_faces, std::vector{power_to}, fields,
                                         Sliding::Positions::keep);
    std::vector<Real> area;
    for (const auto& face : context.mesh()->fracture_faces) area.push_back(face.area);
    area_ = assembly::to_device(area, "area");
  }

  void add_residual(const Points& points, const assembly::State& state, const assembly::Rows& r) const override {
    faces_.add_residual(at(points), state, r);
  }
  void add_jacobian(const Points& points, const assembly::State& state, fields::BlockMatrix& J) override {
    faces_.add_jacobian(at(points), state, J);
  }
  void add_power(const Points& points, const assembly::State& state, const assembly::Rows& r) const override {
    sliding_->add_residual({at(points), area_, state.rate}, state, r);
  }
  void add_power_jacobian(const Points& points, const assembly::State& state, fields::BlockMatrix& J) override {
    sliding_->add_jacobian({at(points), area_, state.rate}, state, J);
  }

  View<laws::JointPoint<dim>*> evaluate(const Points& points, const assembly::State& state) const override {
    const Face face = at(points);
    const View<laws::JointPoint<dim>*> all("points", faces_.n_entities());
    faces_.for_each(
        face, state, KOKKOS_LAMBDA(int f, const Real(&x)[Face::Columns::size]) { all(f) = face.point(f, x); });
    return all;
  }

 private:
  using Faces = assembly::Assembler<Face>;
  using Sliding = assembly::Assembler<SlidingFace<Face>>;

  Face at(const Points& points) const {
    Face face = face_;
    face.points = points;
    return face;
  }

  void set_shares(const mesh::Mesh& mesh) {
    const LocalIndex n_faces = mesh.n_owned_fracture_faces;
    constexpr bool tips = Face::Columns::n > 3;
    const base::HostTable<Real**> share("share", n_faces, n), tip_share("tip share", tips ? n_faces : 0, 2 * n);
    std::vector<Real> bubble_mean;
    const auto rules = std::make_shared<assembly::TipRules>();
    for (LocalIndex f = 0; f < n_faces; ++f) {
      const auto& face = mesh.fracture_faces[f];
      const LocalIndex cell = face.cell[mesh::minus];
      const int local_face = face.local_face[mesh::minus];
      const auto shares = assembly::mean_shares(mesh, cell, local_face);
      for (int k = 0; k < n; ++k) share(f, k) = shares[k];
      bubble_mean.push_back(assembly::bubble_mean(mesh, cell, local_face));
      for (int side = 0; side < 2 && tips; ++side) {
        const auto of_tips = tip_shares(mesh, face, side, rules);
        for (int k = 0; k < n; ++k) tip_share(f, side * n + k) = of_tips[k];
      }
    }
    face_.share = share.on_device();
    face_.tip_share = tip_share.on_device();
    face_.bubble_mean = assembly::to_device(bubble_mean, "bubble mean");
  }

  Face face_;
  Faces faces_;
  std::unique_ptr<Sliding> sliding_;  // null: no power of friction
  ConstView<Real*> area_;             // [local face] m^2; only with sliding_
};

}  // namespace

template <int dim>
std::unique_ptr<JointOperators<dim>> make_joint_operators(const assembly::Context& context,
                                                          const std::vector<int>& fields, int power_to,
                                                          const ConstView<Real**>& rest) {
  const auto make = [&](auto n, auto tips) -> std::unique_ptr<JointOperators<dim>> {
    return std::make_unique<OperatorsOf<JointFace<dim, n(), tips()>>>(context, fields, power_to, rest);
  };
  const auto of_nodes = [&](auto n) { return make(n, std::false_type()); };
  const auto with_tips = [&](auto n) { return fields.size() > 3 ? make(n, std::true_type()) : of_nodes(n); };
  const int n = mesh::n_face_nodes(context.mesh()->shape);
  if constexpr (dim == 2) {
    if (n == 2) return with_tips(std::integral_constant<int, 2>());
    return of_nodes(std::integral_constant<int, 3>());
  } else {
    if (n == 3) return with_tips(std::integral_constant<int, 3>());
    if (n == 4) return with_tips(std::integral_constant<int, 4>());
    if (n == 6) return of_nodes(std::integral_constant<int, 6>());
    return of_nodes(std::integral_constant<int, 9>());
  }
}

template std::unique_ptr<JointOperators<2>> make_joint_operators<2>(const assembly::Context&, const std::vector<int>&,
                                                                    int, const ConstView<Real**>&);
template std::unique_ptr<JointOperators<3>> make_joint_operators<3>(const assembly::Context&, const std::vector<int>&,
                                                                    int, const ConstView<Real**>&);

}  // namespace sprekk::physics
