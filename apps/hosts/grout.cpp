#include "grout.hpp"

#include "assembly/assembler.hpp"

namespace hosts {

using namespace sprekk;
using assembly::Loop;
using mesh::Shape;

namespace {

/// The grout at one side of one fracture face; each side has half of the grout. Everything in it is constant.
///
/// | symbol | shape                            | unit     |                                                      |
/// | x      | u [node, dim], beta [dim], p     | m, m, Pa | unknowns                                             |
/// | r      | rows of the same                 | N, N, m^3 |                                                     |
/// | area   | [side, node dim + dim]           | m^2      | s |f| n_i times the node's or bubble's part in the mean, |
/// |        |                                  |          | s = 1 on side plus, -1 on side minus                 |
/// | soft   | [side]                           | m^3/Pa   | |f| h/(2 K)                                          |
template <Shape shape>
struct GroutedSide {
  using Cell = assembly::ReferenceCell<shape>;
  static constexpr int dim = Cell::dim, n = Cell::n_nodes, p = n * dim + dim;
  using Columns = assembly::Slots<assembly::Slot<n, dim>, assembly::Slot<1, dim>, assembly::Slot<1, 1>>;
  using Rows = Columns;

  View<Real**> area;
  View<Real*> soft;

  KOKKOS_INLINE_FUNCTION void residual(int side, const Real (&x)[Columns::size], Real (&r)[Rows::size]) const {
    r[p] = -soft(side) * x[p];
    for (int c = 0; c < p; ++c) {
      r[c] = -area(side, c) * x[p];
      r[p] -= area(side, c) * x[c];
    }
  }

  KOKKOS_INLINE_FUNCTION void jacobian(int side, const Real (&)[Columns::size],
                                       Real (&J)[Rows::size][Columns::size]) const {
    for (auto& row : J)
      for (Real& value : row) value = 0;
    for (int c = 0; c < p; ++c) J[c][p] = J[p][c] = -area(side, c);
    J[p][p] = -soft(side);
  }
};

template <Shape shape>
class Grout final : public assembly::Module {
 public:
  using Op = GroutedSide<shape>;
  using Assembler = assembly::Assembler<Op>;
  static constexpr int dim = Op::dim;

  explicit Grout(const GroutParameters& parameters) : parameters_(parameters) {}

  std::string name() const override { return "grout"; }

  assembly::Declaration declare() const override {
    const auto face = fields::Entity::fracture_face;
    assembly::Declaration d;
    assembly::Unknown pressure{
        {"grout pressure", face, 1, "Pa"}, assembly::Quantity::stress, assembly::Quantity::volume};
    pressure.local_group = parameters_.local_group;
    d.unknowns = {pressure};
    // Rows of nodes belong to their ranks: so the loop is over sides, which visits ghosts, and not over faces.
    for (const char* row : {"displacement", "side bubble"})
      d.couplings.push_back({Loop::fracture_sides, row, {"grout pressure"}});
    d.couplings.push_back({Loop::fracture_sides, "grout pressure", {"displacement", "side bubble", "grout pressure"}});
    d.outputs = {{"grout pressure", "Pa", face, 1}};
    d.linear = true;
    return d;
  }

  void bind(const assembly::Context& context) override {
    const auto& mesh = *context.mesh();
    p_ = context.field("grout pressure");
    n_faces_ = mesh.n_owned_fracture_faces;
    const std::vector<int> blocks = {context.field("displacement"), context.field("side bubble"), p_};
    sides_ = std::make_unique<Assembler>(context, Loop::fracture_sides, blocks, blocks, Assembler::Positions::once);
    const auto sides = assembly::fracture_sides(mesh);
    op_ = std::make_unique<Op>(Op{View<Real**>("area", sides.size(), Op::p), View<Real*>("soft", sides.size())});
    const auto area = Kokkos::create_mirror_view(op_->area);
    const auto soft = Kokkos::create_mirror_view(op_->soft);
    for (std::size_t s = 0; s < sides.size(); ++s) {
      const auto& face = mesh.fracture_faces[sides[s][0]];
      const int side = sides[s][1], local_face = face.local_face[side];
      const Real signed_area = side == mesh::plus ? face.area : -face.area;
      const auto shares = assembly::mean_shares<shape>(mesh, face.cell[side], local_face);
      for (int i = 0; i < dim; ++i) {
        const Real normal = signed_area * face.frame[0][i];
        for (int k = 0; k < mesh::n_face_nodes(shape); ++k)
          area(s, mesh::face_nodes(shape)[local_face][k] * dim + i) = normal * shares[k];
        area(s, Op::n * dim + i) = normal * Op::Cell::bubble_mean;
      }
      soft(s) = face.area * parameters_.thickness / (2 * parameters_.bulk_modulus);
    }
    Kokkos::deep_copy(op_->area, area);
    Kokkos::deep_copy(op_->soft, soft);
  }

  void residual(const assembly::State& state, const assembly::Rows& r) const override {
    sides_->add_residual(*op_, state, r);
  }
  void jacobian(const assembly::State& state, fields::BlockMatrix& J) const override {
    sides_->add_jacobian(*op_, state, J);
  }
  void output(const assembly::State& state, std::vector<assembly::OutputField>& fields) const override {
    const auto p = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), state.x[p_]);
    fields[0].values.assign(&p(0), &p(0) + n_faces_);
  }

 private:
  GroutParameters parameters_;
  int p_ = 0;
  LocalIndex n_faces_ = 0;
  std::unique_ptr<Op> op_;
  std::unique_ptr<Assembler> sides_;
};

}  // namespace

std::unique_ptr<assembly::Module> make_grout(Shape shape, const GroutParameters& parameters) {
  return mesh::for_shape(
      shape, [&](auto s) -> std::unique_ptr<assembly::Module> { return std::make_unique<Grout<s()>>(parameters); });
}

}  // namespace hosts
