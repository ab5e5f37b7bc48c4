// Modules for tests of the framework: springs in cells, glue between fracture sides, hardening at nodes.
#pragma once

#include <memory>
#include <string>

#include "assembly/assembler.hpp"
#include "assembly/capabilities.hpp"
#include "assembly/system.hpp"
#include "mesh/distribute.hpp"
#include "mesh/extents.hpp"
#include "unit/assembly/dense.hpp"
#include "unit/mesh/meshes.hpp"

namespace sprekk::test {

using assembly::Declaration;
using assembly::Loop;
using mesh::Shape;

/// r_a = k sum_b (u_a - u_b) over the nodes b of the cell.
template <Shape shape>
struct SpringCell {
  static constexpr int dim = mesh::dimension(shape), n = mesh::n_nodes(shape);
  using Columns = assembly::Slots<assembly::Slot<n, dim>>;
  using Rows = Columns;
  Real k = 2.5;

  KOKKOS_INLINE_FUNCTION void residual(int, const Real (&x)[n * dim], Real (&r)[n * dim]) const {
    for (int row = 0; row < n * dim; ++row) {
      r[row] = 0;
      for (int b = 0; b < n; ++b) r[row] += k * (x[row] - x[b * dim + row % dim]);
    }
  }
  KOKKOS_INLINE_FUNCTION void jacobian(int, const Real (&)[n * dim], Real (&J)[n * dim][n * dim]) const {
    for (int row = 0; row < n * dim; ++row)
      for (int column = 0; column < n * dim; ++column)
        J[row][column] = row % dim != column % dim ? 0 : row == column ? k * (n - 1) : -k;
  }
};

/// Linear module. Declares "displacement" with the scales E = 100 Pa and L = 2 m. The load on every node is `force` *
/// t^power in direction x.
template <Shape shape>
class Springs final : public assembly::Module, public assembly::Loads {
 public:
  static constexpr int dim = mesh::dimension(shape);
  Real force = 0, power = 0;

  std::string name() const override { return "springs"; }
  Declaration declare(const mesh::Mesh& mesh) const override {
    Declaration d;
    d.unknowns = {{{"displacement", fields::Entity::node, dim, "m"},
                   "displacement",
                   {{"stress", mesh::typical_face_area(mesh)}},
                   assembly::NearNullSpace::rigid_motions}};
    d.couplings = {{Loop::cells, "displacement", {"displacement"}}};
    d.scales = {{"stress", 1e-10}, {"displacement", 2e-12}};
    d.relations = {{"stress", 50, "displacement"}, {"displacement", 0.02, "stress"}};
    d.outputs = {{{"displacement", "m", fields::Entity::node, dim}, [this](const assembly::State& state) {
                    return std::vector<Real>(state.x[u_].data(), state.x[u_].data() + state.x[u_].extent(0));
                  }}};
    d.linear = true;
    return d;
  }
  void bind(const assembly::Context& context) override {
    u_ = context.field("displacement");
    using Assembler = assembly::Assembler<SpringCell<shape>>;
    cells_ = std::make_unique<Assembler>(context, Loop::cells, std::vector<int>{u_}, std::vector<int>{u_},
                                         Assembler::Positions::once);
  }
  void residual(const assembly::State& state, const assembly::Rows& r) const override {
    cells_->add_residual({}, state, r);
    const auto rows = r[u_];
    const Real pull = force * std::pow(state.t, power);
    Kokkos::parallel_for(
        "pull", Kokkos::RangePolicy<Execution>(0, rows.extent(0) / dim),
        KOKKOS_LAMBDA(int i) { rows(i * dim) -= pull; });
  }
  void jacobian(const assembly::State& state, fields::BlockMatrix& J) const override {
    cells_->add_jacobian({}, state, J);
  }
  assembly::Scales loads(Real t) const override { return {{"stress", std::abs(force * std::pow(t, power))}}; }
  bool constant_load() const override { return power == 0; }

 private:
  int u_ = -1;
  std::unique_ptr<assembly::Assembler<SpringCell<shape>>> cells_;
};

/// Residual r = q - (j + j^3 + q_old), with the sum j of the jumps at the nodes of the face.
template <Shape shape>
struct GlueFace {
  static constexpr int dim = mesh::dimension(shape), n = mesh::n_face_nodes(shape);
  using Columns = assembly::Slots<assembly::Slot<2 * n, dim>, assembly::Slot<1, dim>>;
  using Rows = assembly::Slots<assembly::Slot<1, dim>>;
  View<Real**> old;
  Real wrong = 0;  ///< error of the derivative in the jump

  KOKKOS_INLINE_FUNCTION Real jump(const Real (&x)[Columns::size], int i) const {
    Real j = 0;
    for (int a = 0; a < n; ++a) j += x[(n + a) * dim + i] - x[a * dim + i];
    return j;
  }
  KOKKOS_INLINE_FUNCTION void residual(int f, const Real (&x)[Columns::size], Real (&r)[dim]) const {
    for (int i = 0; i < dim; ++i) {
      const Real j = jump(x, i);
      r[i] = x[2 * n * dim + i] - (j + j * j * j + old(f, i));
    }
  }
  KOKKOS_INLINE_FUNCTION void jacobian(int, const Real (&x)[Columns::size], Real (&J)[dim][Columns::size]) const {
    for (int i = 0; i < dim; ++i) {
      const Real j = jump(x, i);
      for (auto& value : J[i]) value = 0;
      for (int a = 0; a < n; ++a) {
        J[i][a * dim + i] = 1 + 3 * j * j + wrong;
        J[i][(n + a) * dim + i] = -(1 + 3 * j * j + wrong);
      }
      J[i][2 * n * dim + i] = 1;
    }
  }
};

/// Nonlinear module. Declares "glue" on fracture faces and reads "displacement". History: the last committed glue.
template <Shape shape>
class Glue final : public assembly::Module, public assembly::Steps, public assembly::Errors {
 public:
  static constexpr int dim = mesh::dimension(shape);
  Real wrong = 0;                 ///< error of the derivative in the displacement
  bool reads_undeclared = false;  ///< the residual reads the displacement once more than declared

  std::string name() const override { return "glue"; }
  Declaration declare(const mesh::Mesh&) const override {
    Declaration d;
    assembly::Unknown q{{"glue", fields::Entity::fracture_face, dim, "Pa"}, "stress", {{"stress"}}};
    q.local_group = "face";
    d.unknowns = {q};
    d.couplings = {{Loop::fracture_faces, "glue", {"displacement", "glue"}}};
    if (reads_undeclared) d.couplings = {{Loop::fracture_faces, "glue", {"glue"}}};
    d.history = {{"old glue", fields::Entity::fracture_face, dim}};
    return d;
  }
  void bind(const assembly::Context& context) override {
    q_ = context.field("glue");
    using Assembler = assembly::Assembler<GlueFace<shape>>;
    faces_ =
        std::make_unique<Assembler>(context, Loop::fracture_faces, std::vector<int>{q_},
                                    std::vector<int>{context.field("displacement"), q_}, Assembler::Positions::keep);
  }
  void residual(const assembly::State& state, const assembly::Rows& r) const override {
    faces_->add_residual({state.history[0], wrong}, state, r);
  }
  void jacobian(const assembly::State& state, fields::BlockMatrix& J) const override {
    faces_->add_jacobian({state.history[0], wrong}, state, J);
  }
  void commit(assembly::State& state) const override {
    for (std::size_t f = 0; f < state.history[0].extent(0); ++f)
      for (int i = 0; i < dim; ++i) state.history[0](f, i) = state.x[q_](f * dim + i);
  }
  void measure(const assembly::State& state, const assembly::Scales& scales,
               std::vector<fields::Measure>& out) const override {
    Real largest = 0;
    for (std::size_t i = 0; i < state.x[q_].extent(0); ++i) largest = std::max(largest, std::abs(state.x[q_](i)));
    out.push_back({"largest glue", largest / scales.at("stress")});
  }
  bool symmetric(const assembly::State&) const override { return false; }

 private:
  int q_ = -1;
  std::unique_ptr<assembly::Assembler<GlueFace<shape>>> faces_;
};

/// r_i = u_i^3 for all nodes of the cell.
template <Shape shape>
struct HardeningCell {
  using Columns = typename SpringCell<shape>::Columns;
  using Rows = Columns;
  static constexpr int size = Columns::size;
  KOKKOS_INLINE_FUNCTION void residual(int, const Real (&x)[size], Real (&r)[size]) const {
    for (int i = 0; i < size; ++i) r[i] = x[i] * x[i] * x[i];
  }
  KOKKOS_INLINE_FUNCTION void jacobian(int, const Real (&x)[size], Real (&J)[size][size]) const {
    for (int i = 0; i < size; ++i)
      for (int j = 0; j < size; ++j) J[i][j] = i == j ? 3 * x[i] * x[i] : 0;
  }
};

/// Nonlinear module that adds to the rows of "displacement".
template <Shape shape>
class Hardening final : public assembly::Module {
 public:
  std::string name() const override { return "hardening"; }
  Declaration declare(const mesh::Mesh&) const override {
    Declaration d;
    d.couplings = {{Loop::cells, "displacement", {"displacement"}}};
    return d;
  }
  void bind(const assembly::Context& context) override {
    using Assembler = assembly::Assembler<HardeningCell<shape>>;
    const int u = context.field("displacement");
    cells_ = std::make_unique<Assembler>(context, Loop::cells, std::vector<int>{u}, std::vector<int>{u},
                                         Assembler::Positions::keep);
  }
  void residual(const assembly::State& state, const assembly::Rows& r) const override {
    cells_->add_residual({}, state, r);
  }
  void jacobian(const assembly::State& state, fields::BlockMatrix& J) const override {
    cells_->add_jacobian({}, state, J);
  }

 private:
  std::unique_ptr<assembly::Assembler<HardeningCell<shape>>> cells_;
};

/// Returns a constant condition on "displacement"; components without a value are free.
inline assembly::DirichletCondition constrain(const mesh::Mesh& mesh, const std::string& name,
                                              const std::string& boundary,
                                              std::vector<std::optional<base::Expression>> values) {
  const auto& names = mesh.boundary_names;
  values.resize(mesh.dim());
  return {name, "displacement", static_cast<int>(std::find(names.begin(), names.end(), boundary) - names.begin()),
          std::move(values)};
}

using Modules = std::vector<std::unique_ptr<assembly::Module>>;

inline std::unique_ptr<assembly::System> make_system(RCP<const mesh::Mesh> mesh, Modules modules,
                                                     const std::vector<assembly::DirichletCondition>& conditions = {}) {
  return std::make_unique<assembly::System>(mesh, std::move(modules), conditions, rcp(new base::Timers));
}

}  // namespace sprekk::test
