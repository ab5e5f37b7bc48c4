#include "physics/mechanics/interface_traction_balance.hpp"

#include "assembly/assembler.hpp"
#include "assembly/capabilities.hpp"
#include "base/host_table.hpp"
#include "mesh/extents.hpp"
#include "physics/mechanics/balanced_side.hpp"
#include "physics/mechanics/bubble_stiffness.hpp"

#include <algorithm>
#include <cmath>

namespace sprekk::physics {

using assembly::Loop;
using mesh::Shape;

namespace {

template <Shape shape>
class InterfaceTractionBalance final : public assembly::Module, public assembly::Loads {
 public:
  using Op = BalancedSide<shape>;
  static constexpr int dim = Op::dim, n = Op::n;

  explicit InterfaceTractionBalance(InterfaceTractionBalanceParameters parameters)
      : parameters_(std::move(parameters)) {}

  std::string name() const override { return "interface traction balance"; }

  assembly::Declaration declare(const mesh::Mesh& mesh) const override {
    assembly::Declaration d;
    assembly::Unknown bubble{{"side bubble", fields::Entity::fracture_face, 2 * dim, "m"},
                             "displacement",
                             {{"stress", mesh::typical_face_area(mesh)}}};
    bubble.local_group = "fracture face";
    d.unknowns = {bubble};
    d.couplings = {{Loop::fracture_sides, "displacement", {"side bubble", "traction"}},
                   {Loop::fracture_sides, "side bubble", {"displacement", "side bubble", "traction"}}};
    d.linear = true;
    if (!parameters_.fluid_pressure.empty())
      d.outputs = {{{"fluid pressure", "Pa", fields::Entity::fracture_face, 1}, [this](const assembly::State& state) {
                      std::vector<Real> values;
                      for_each_pressure(state.t, [&](Real p) { values.push_back(p); });
                      return values;
                    }}};
    return d;
  }

  void bind(const assembly::Context& context) override {
    mesh_ = context.mesh();
    const int u = context.field("displacement"), beta = context.field("side bubble"),
              lambda = context.field("traction");
    using Assembler = assembly::Assembler<Op>;
    sides_ = std::make_unique<Assembler>(context, Loop::fracture_sides, std::vector<int>{u, beta},
                                         std::vector<int>{u, beta, lambda}, Assembler::Positions::once);
    build_operator();
  }

  void residual(const assembly::State& state, const assembly::Rows& r) const override {
    sides_->add_residual(*op_, state, r);
  }
  void jacobian(const assembly::State& state, fields::BlockMatrix& J) const override {
    sides_->add_jacobian(*op_, state, J);
  }

  bool constant_load() const override {
    return parameters_.body_force.constant_in_time() && parameters_.fluid_pressure.constant_in_time();
  }

  /// Stress scale: largest fluid pressure.
  assembly::Scales loads(Real t) const override {
    Real largest = 0;
    for_each_pressure(t, [&](Real p) { largest = std::max(largest, std::abs(p)); });
    return {{"stress", largest}};
  }

  void set_time(Real t, const assembly::Scales&) override {
    set_pressure(t);
    const bool stressed = !parameters_.initial_stress.empty(), constant = parameters_.body_force.constant_in_time();
    if ((parameters_.body_force.empty() && !stressed) || (loaded_ && constant)) return;
    if (stressed) op_->nodal = View<Real**>("nodal", op_->force.extent(0), n * dim);
    const base::HostTable<Real**> force(op_->force), nodal(op_->nodal);
    Kokkos::deep_copy(force.host(), 0.0);
    const auto sides = assembly::fracture_sides(*mesh_);
    Real db[dim];
    for (std::size_t s = 0; s < sides.size(); ++s) {
      const auto& face = mesh_->fracture_faces[sides[s][0]];
      const int local_face = face.local_face[sides[s][1]];
      assembly::for_each_cell_point<shape>(
          *mesh_, face.cell[sides[s][1]], [&](const Real(&xi)[dim], Real volume, const auto& x) {
            const Real b = Op::Cell::bubble(local_face, xi, db);
            for (int i = 0; i < dim; ++i)
              force(s, i) += volume * b * parameters_.body_force(i, face.cell[sides[s][1]], x, t);
          });
      if (stressed)
        add_initial_stress(face, sides[s][1], Kokkos::subview(force.host(), s, Kokkos::ALL),
                           Kokkos::subview(nodal.host(), s, Kokkos::ALL));
    }
    force.on_device();
    nodal.on_device();
    loaded_ = true;
  }

 private:
  /// Calls visit(p) for every owned face if there is a fluid.
  template <class Visit>
  void for_each_pressure(Real t, const Visit& visit) const {
    if (parameters_.fluid_pressure.empty()) return;
    for (LocalIndex f = 0; f < mesh_->n_owned_fracture_faces; ++f)
      visit(mean_fluid_pressure(parameters_.fluid_pressure, *mesh_, mesh_->fracture_faces[f], mesh::minus, t));
  }

  void set_pressure(Real t) {
    const auto& fluid = parameters_.fluid_pressure;
    if (fluid.empty() || (op_->pressure.extent(0) > 0 && fluid.constant_in_time())) return;
    const auto sides = assembly::fracture_sides(*mesh_);
    std::vector<Real> pressure;
    for (const auto& [f, side] : sides) pressure.push_back(mean_bearing_pressure(fluid, *mesh_, f, side, t));
    op_->pressure = assembly::to_device(pressure, "pressure");
  }

  /// Adds the loads of the initial stress on the bubble and the nodes of one side.
  template <class Host>
  void add_initial_stress(const mesh::Mesh::FractureFace& face, int side, const Host& force, const Host& nodal) const {
    const LocalIndex cell = face.cell[side];
    const int local_face = face.local_face[side];
    const Real sign = side == mesh::plus ? 1 : -1;
    const auto& stress = parameters_.initial_stress;
    Real X[n][dim], dN[n][dim], db[dim], gb[dim], sigma[dim][dim];
    assembly::gather_host<shape>(*mesh_, cell, X);
    assembly::for_each_cell_point<shape>(*mesh_, cell, [&](const Real(&xi)[dim], Real volume, const auto& x) {
      stress.at(*mesh_, cell, x, sigma);
      Op::Cell::gradients(xi, dN);
      Op::Cell::bubble(local_face, xi, db);
      assembly::CellPoint<shape>(X, dN).gradient(db, gb);
      for (int i = 0; i < dim; ++i)
        for (int j = 0; j < dim; ++j) force(i) -= volume * sigma[i][j] * gb[j];
    });
    const auto mean = mean_initial_traction(stress, *mesh_, face, side);
    const auto nodes = mesh::face_nodes(shape)[local_face];
    assembly::for_each_face_point(*mesh_, cell, local_face, [&](const auto& N, Real area, const auto& x) {
      const auto traction = stress.traction(*mesh_, cell, x, face.frame[0]);
      for (int i = 0; i < dim; ++i) {
        const Real deviation = sign * area * (traction[i] - mean[i]);
        force(i) -= assembly::face_bubble(shape, N) * deviation;
        for (int k = 0; k < mesh::n_face_nodes(shape); ++k) nodal(nodes[k] * dim + i) -= N[k] * deviation;
      }
    });
  }

  void build_operator() {
    const auto sides = assembly::fracture_sides(*mesh_);
    op_ = std::make_unique<Op>(sides.size());
    std::vector<int> n_faces(mesh_->n_cells(), 0);  // number m of fracture faces of each cell
    for (const auto& [f, side] : sides) ++n_faces[mesh_->fracture_faces[f].cell[side]];
    const base::HostTable<Real***> coupling(op_->coupling), frame(op_->frame);
    const base::HostTable<Real**> push(op_->push);
    const base::HostTable<Real*> stiffness(op_->stiffness), bubble(op_->bubble);
    for (std::size_t s = 0; s < sides.size(); ++s) {
      const auto& face = mesh_->fracture_faces[sides[s][0]];
      const int side = sides[s][1], local_face = face.local_face[side];
      const LocalIndex cell = face.cell[side];
      const Real signed_area = side == mesh::plus ? face.area : -face.area;
      stiffness(s) = n_faces[cell] * bubble_stiffness<shape>(*mesh_, cell, local_face, law(cell));
      integrate(cell, local_face, Kokkos::subview(coupling.host(), s, Kokkos::ALL, Kokkos::ALL));
      bubble(s) = signed_area * assembly::bubble_mean(*mesh_, cell, local_face);
      const auto shares = assembly::mean_shares(*mesh_, cell, local_face);
      for (int k = 0; k < mesh::n_face_nodes(shape); ++k)
        push(s, mesh::face_nodes(shape)[local_face][k]) = signed_area * shares[k];
      for (int k = 0; k < dim; ++k)
        for (int i = 0; i < dim; ++i) frame(s, k, i) = face.frame[k][i];
    }
    coupling.on_device();
    frame.on_device();
    push.on_device();
    stiffness.on_device();
    bubble.on_device();
  }

  const laws::Elasticity& law(LocalIndex cell) const { return parameters_.elasticity.of_cell(*mesh_, cell); }

  /// Integrates the coupling of the bubble of a face with the nodes of the cell, coupling(i, a dim + j).
  template <class Coupling>
  void integrate(LocalIndex cell, int local_face, const Coupling& coupling) const {
    Real X[n][dim], dN[n][dim], db[dim];
    assembly::gather_host<shape>(*mesh_, cell, X);
    assembly::for_each_cell_point<shape>(*mesh_, cell, [&](const Real(&xi)[dim], Real volume, const auto&) {
      Op::Cell::gradients(xi, dN);
      Op::Cell::bubble(local_face, xi, db);
      const assembly::CellPoint<shape> point(X, dN);
      Real gb[dim], ga[dim];
      point.gradient(db, gb);
      for (int a = 0; a < n; ++a) {
        point.gradient(dN[a], ga);
        for (int i = 0; i < dim; ++i)
          for (int j = 0; j < dim; ++j) coupling(i, a * dim + j) += volume * law(cell).stiffness(gb, ga, i, j);
      }
    });
  }

  InterfaceTractionBalanceParameters parameters_;
  RCP<const mesh::Mesh> mesh_;
  bool loaded_ = false;
  std::unique_ptr<Op> op_;
  std::unique_ptr<assembly::Assembler<Op>> sides_;
};

}  // namespace

std::unique_ptr<assembly::Module> make_interface_traction_balance(Shape shape,
                                                                  InterfaceTractionBalanceParameters parameters) {
  return mesh::for_shape(shape, [&](auto s) -> std::unique_ptr<assembly::Module> {
    return std::make_unique<InterfaceTractionBalance<s()>>(std::move(parameters));
  });
}

}  // namespace sprekk::physics
