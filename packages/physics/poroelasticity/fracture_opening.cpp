#include "physics/poroelasticity/fracture_opening.hpp"

#include "assembly/capabilities.hpp"
#include "assembly/divergence.hpp"
#include "assembly/geometry.hpp"
#include "assembly/term.hpp"
#include "mesh/extents.hpp"

namespace sprekk::physics {

using assembly::Loop;
using assembly::Slot;

namespace {

/// Fluid pressure on one side of a fracture face, and the contribution of this side to the widening of the face.
///
/// | symbol    | shape                       | unit     |                                                     |
/// | x         | displacements [m], p, b     | m, Pa, m | unknowns                                            |
/// | r         | forces [m], row of b        | N, m^3 (2D: m^2) | -alpha p dW/du, share |f| b - W             |
/// | volume    | [entity, m]                 | m^2      | dW/du                                               |
/// | part      | [entity]                    | m^2      | share |f|                                           |
/// | biot      | [entity]                    | -        | alpha                                               |
template <class... Displacements>
struct Opening {
  using Columns = assembly::Slots<Displacements..., Slot<1, 1>, Slot<1, 1>>;
  using Rows = assembly::Slots<Displacements..., Slot<1, 1>>;
  static constexpr int m = Rows::size - 1, last = sizeof...(Displacements);
  static constexpr bool couples(int row, int column) { return (row == last) != (column == last); }
  View<Real**> volume;
  ConstView<Real*> part, biot;

  KOKKOS_INLINE_FUNCTION void residual(int e, const Real (&x)[m + 2], Real (&r)[m + 1]) const {
    r[m] = part(e) * x[m + 1];
    for (int k = 0; k < m; ++k) {
      r[k] = -biot(e) * volume(e, k) * x[m];
      r[m] -= volume(e, k) * x[k];
    }
  }
  KOKKOS_INLINE_FUNCTION void jacobian(int e, const Real (&)[m + 2], Real (&J)[m + 1][m + 2]) const {
    for (auto& row : J)
      for (Real& value : row) value = 0;
    J[m][m + 1] = part(e);
    for (int k = 0; k < m; ++k) {
      J[k][m] = -biot(e) * volume(e, k);
      J[m][k] = -volume(e, k);
    }
  }
};

class FractureOpening final : public assembly::Module, public assembly::ContactFaces {
 public:
  FractureOpening(const mesh::Mesh& mesh, std::vector<Real> biot)
      : tips_(mesh.n_global_enriched > 0), biot_(std::move(biot)) {}

  std::string name() const override { return "fracture opening"; }

  assembly::Declaration declare(const mesh::Mesh& mesh) const override {
    assembly::Declaration d;
    const Real area = mesh::typical_face_area(mesh);
    assembly::Unknown widening{
        {"widening", fields::Entity::fracture_face, 1, "m"}, "displacement", {{"displacement", area}}};
    widening.local_group = "fracture face";
    d.unknowns = {widening};
    const auto open = [&](Loop loop, const char* displacement) {
      d.couplings.push_back({loop, displacement, {"face pressure"}});
      d.couplings.push_back({loop, "widening", {displacement, "widening"}});
    };
    open(Loop::fracture_sides, "displacement");
    open(Loop::fracture_sides, "side bubble");
    if (tips_) open(Loop::tip_sides, "tip displacement");
    d.relations = {{"stress", 1, "pressure"}, {"pressure", 1, "stress"}};
    d.stores = true;
    return d;
  }

  void bind(const assembly::Context& context) override {
    mesh_ = context.mesh();
    add_sides(context, *mesh_);
    if (tips_) add_tips(context, *mesh_);
  }
  void residual(const assembly::State& state, const assembly::Rows& r) const override {
    for (const auto& term : terms_) term.add_residual(state, r);
  }
  void jacobian(const assembly::State& state, fields::BlockMatrix& J) const override {
    for (const auto& term : terms_) term.add_jacobian(state, J);
  }
  void states(const assembly::State&, std::vector<char>&) const override {}
  /// The fluid resists opening and closure: it must flow along the fracture.
  void add_contact_constraints(const assembly::State&, std::vector<contact::Constraint>& constraints) const override {
    for (std::size_t f = 0; f < constraints.size(); ++f)
      if (biot_[f] > 0) constraints[f].resisted = mesh_->fracture_faces[f].frame[0];
  }

 private:
  void add_sides(const assembly::Context& context, const mesh::Mesh& mesh);
  void add_tips(const assembly::Context& context, const mesh::Mesh& mesh);

  RCP<const mesh::Mesh> mesh_;
  bool tips_;               // the mesh has enriched tips
  std::vector<Real> biot_;  // [local fracture face]
  std::vector<assembly::Term> terms_;
};

void FractureOpening::add_sides(const assembly::Context& context, const mesh::Mesh& mesh) {
  const int u = context.field("displacement"), beta = context.field("side bubble"), b = context.field("widening"),
            p = context.field("face pressure");
  std::vector<Real> halves, biot;
  for (const auto& [f, side] : assembly::fracture_sides(mesh)) {
    halves.push_back(mesh.fracture_faces[f].area / 2);
    biot.push_back(biot_[f]);
  }
  terms_.push_back(mesh::for_shape(mesh.shape, [&](auto shape) {
    constexpr int dim = mesh::dimension(shape());
    const Opening<Slot<mesh::n_nodes(shape()), dim>, Slot<1, dim>> op{assembly::side_volumes(mesh),
                                                                      assembly::to_device(halves, "half of the area"),
                                                                      assembly::to_device(biot, "Biot coefficient")};
    return assembly::Term(context, Loop::fracture_sides, {u, beta, b}, {u, beta, p, b}, true,
                          [op](const assembly::State&) { return op; });
  }));
}

void FractureOpening::add_tips(const assembly::Context& context, const mesh::Mesh& mesh) {
  const int q = context.field("tip displacement"), b = context.field("widening"), p = context.field("face pressure");
  const auto of_sides = assembly::tip_side_volumes(mesh);
  const auto part = assembly::to_device(std::vector<Real>(of_sides.extent(0), 0), "none of the area");
  const auto all = assembly::fracture_sides(mesh);
  std::vector<Real> of_tips;
  for (const LocalIndex s : assembly::tip_sides(mesh)) of_tips.push_back(biot_[all[s][0]]);
  const auto biot = assembly::to_device(of_tips, "Biot coefficient");
  terms_.push_back(mesh::for_corners(mesh.shape, [&](auto shape) {
    const Opening<Slot<mesh::n_nodes(shape()), mesh::dimension(shape())>> op{of_sides, part, biot};
    return assembly::Term(context, Loop::tip_sides, {q, b}, {q, p, b}, true,
                          [op](const assembly::State&) { return op; });
  }));
}

}  // namespace

std::unique_ptr<assembly::Module> make_fracture_opening(const mesh::Mesh& mesh, std::vector<Real> biot) {
  return std::make_unique<FractureOpening>(mesh, std::move(biot));
}

}  // namespace sprekk::physics
