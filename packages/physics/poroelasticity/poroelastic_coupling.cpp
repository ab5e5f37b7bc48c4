#include "physics/poroelasticity/poroelastic_coupling.hpp"

#include "assembly/assembler.hpp"
#include "mesh/extents.hpp"
#include "mesh/facets.hpp"
#include "physics/hybrid_diffusion.hpp"
#include "physics/volume_work.hpp"
#include "physics/coupling_volumes.hpp"

#include <algorithm>

namespace sprekk::physics {

using assembly::Loop;
using assembly::Slot;

namespace {

/// A fluid that pushes a side of a fracture face, and the share of the side in how far the face has opened.
///
/// | symbol    | shape                       | unit     |                                                     |
/// | x         | displacements [m], p, b     | m, Pa, m | unknowns                                            |
/// | r         | forces [m], row of b        | N, m^3 (2D: m^2) | -p dW/du, share |f| b - W                   |
/// | volume    | [entity, m]                 | m^2      | dW/du                                               |
/// | part      | [entity]                    | m^2      | share |f|                                           |
template <class... Displacements>
struct Opening {
  using Columns = assembly::Slots<Displacements..., Slot<1, 1>, Slot<1, 1>>;
  using Rows = assembly::Slots<Displacements..., Slot<1, 1>>;
  static constexpr int m = Rows::size - 1, last = sizeof...(Displacements);
  static constexpr bool couples(int row, int column) { return (row == last) != (column == last); }
  View<Real**> volume;
  ConstView<Real*> part;

  KOKKOS_INLINE_FUNCTION void residual(int e, const Real (&x)[m + 2], Real (&r)[m + 1]) const {
    r[m] = part(e) * x[m + 1];
    for (int k = 0; k < m; ++k) {
      r[k] = -volume(e, k) * x[m];
      r[m] -= volume(e, k) * x[k];
    }
  }
  KOKKOS_INLINE_FUNCTION void jacobian(int e, const Real (&)[m + 2], Real (&J)[m + 1][m + 2]) const {
    for (auto& row : J)
      for (Real& value : row) value = 0;
    J[m][m + 1] = part(e);
    for (int k = 0; k < m; ++k) J[k][m] = J[m][k] = -volume(e, k);
  }
};

/// The flow of a pressure's rate of change against oscillation: T(beta)/dt (p - p_j - (p_0 - p_0j)), see make_. T is of
/// beta, zero in rows of fractures.
template <Shape shape>
using StabilisedCell = KeptFlow<mesh::n_faces(shape), assembly::Slots<Slot<1, 1>, Slot<mesh::n_faces(shape), 1>>>;

template <Shape shape>
class PoroelasticCoupling final : public assembly::Module {
 public:
  static constexpr int dim = mesh::dimension(shape), n = mesh::n_nodes(shape), n_faces = mesh::n_faces(shape);

  PoroelasticCoupling(const mesh::Mesh& mesh, PoroelasticCouplingParameters parameters)
      : parameters_(std::move(parameters)),
        fractures_(!mesh.fracture_names.empty()),
        tips_(mesh.n_global_enriched > 0) {}

  std::string name() const override { return "poroelastic coupling"; }
  std::string fingerprint() const override { return parameters_.initial.text(); }

  assembly::Declaration declare(const mesh::Mesh& mesh) const override {
    assembly::Declaration d;
    const Real area = mesh::typical_face_area(mesh);
    const auto work = [&](Loop loop, const char* displacement) {
      d.couplings.push_back({loop, displacement, {"pressure"}});
      d.couplings.push_back({loop, "pressure", {displacement}});
    };
    const auto open = [&](Loop loop, const char* displacement) {
      d.couplings.push_back({loop, displacement, {"face pressure"}});
      d.couplings.push_back({loop, "widening", {displacement, "widening"}});
    };
    work(Loop::cells, "displacement");
    if (fractures_) {
      assembly::Unknown widening{
          {"widening", fields::Entity::fracture_face, 1, "m"}, "displacement", {{"displacement", area}}};
      widening.local_group = "fracture face";
      d.unknowns = {widening};
      work(Loop::fracture_sides, "side bubble");
      open(Loop::fracture_sides, "displacement");
      open(Loop::fracture_sides, "side bubble");
    }
    if (tips_) {
      work(Loop::tip_cells, "tip displacement");
      open(Loop::tip_sides, "tip displacement");
    }
    for (const char* row : {"pressure", "face pressure"}) {
      d.couplings.push_back({Loop::cells, row, {"pressure", "face pressure"}});
      d.sizes.push_back({row, {"displacement", area, true}});
    }
    d.relations = {{"stress", 1, "pressure"}, {"pressure", 1, "stress"}};
    d.schur = {"pressure"};
    d.stores = true;
    d.history = {{"volume", fields::Entity::cell, 1}, {"exchange", fields::Entity::facet, 1}};
    return d;
  }

  void bind(const assembly::Context& context) override;
  void residual(const assembly::State& state, const assembly::Rows& r) const override {
    add_rates(state, r, state.rate);
    for_each_opening(*this, [&](const auto& part) { part.assembler->add_residual(part.op, state, r); });
    for (int k = 0; k < 2; ++k) {
      const auto rows = r[pressures_[k]];
      const auto old = state.history[k];
      const Real rate = state.rate;
      Kokkos::parallel_for(
          "old", Kokkos::RangePolicy<Execution>(0, rows.extent(0)),
          KOKKOS_LAMBDA(int i) { rows(i) -= rate * old(i, 0); });
    }
  }
  void jacobian(const assembly::State& state, fields::BlockMatrix& J) const override;
  void artificial(const assembly::State& state, const assembly::Rows& rows) const override {
    stabilised_.assembler->add_residual(stabilised_.at(1), state, rows);
  }
  void add_schur(const assembly::State& state, const assembly::Rows& diagonal) const override {
    const auto rows = diagonal[pressures_[0]];
    const auto schur = schur_;
    const Real rate = state.rate;
    Kokkos::parallel_for(
        "schur", Kokkos::RangePolicy<Execution>(0, rows.extent(0)),
        KOKKOS_LAMBDA(int i) { rows(i) += rate * schur(i); });
  }

  void initial(const assembly::Rows& x) const override {
    put_initial(*mesh_, parameters_.initial, x[pressures_[0]], x[pressures_[1]]);
  }

  /// Rates count from the state that is there, also in cells that are new.
  void take_over(assembly::State& state) const override { commit(state); }

  /// What was in the rows of pressures, times dt.
  void commit(assembly::State& state) const override {
    assembly::Rows volumes;
    for (const auto& x : state.x) volumes.emplace_back("volumes", x.extent(0));
    add_rates(state, volumes, 1);
    for (int k = 0; k < 2; ++k) {
      const auto kept = state.history[k];
      const auto now = volumes[pressures_[k]];
      Kokkos::parallel_for(
          "keep", Kokkos::RangePolicy<Execution>(0, kept.extent(0)), KOKKOS_LAMBDA(int i) { kept(i, 0) = now(i); });
    }
  }

 private:
  using Nodes = Slot<n, dim>;
  using OfNodes = VolumeWork<Nodes>;
  using OfBubble = VolumeWork<Slot<1, dim>>;
  using OfSide = Opening<Nodes, Slot<1, dim>>;
  using Stabilised = StabilisedCell<shape>;
  template <class Op>
  struct Part {
    Op op;
    std::unique_ptr<assembly::Assembler<Op>> assembler;

    void bind(const assembly::Context& context, Loop loop, const std::vector<int>& rows,
              const std::vector<int>& columns) {
      using Assembler = assembly::Assembler<Op>;
      assembler = std::make_unique<Assembler>(context, loop, rows, columns, Assembler::Positions::keep);
    }
    Op at(Real rate) const {
      Op moved = op;
      moved.rate = rate;
      return moved;
    }
  };

  /// Calls visit(part) for all parts with rates that there are.
  template <class Self, class Visit>
  static void for_each_rate(Self& self, const Visit& visit) {
    visit(self.cells_);
    visit(self.stabilised_);
    if (self.fractures_) visit(self.bubbles_);
    if (self.tips_) visit(self.tip_cells_);
  }
  /// The same for those of fractures.
  template <class Self, class Visit>
  static void for_each_opening(Self& self, const Visit& visit) {
    if (self.fractures_) visit(self.sides_);
    if (self.tips_) visit(self.tip_sides_);
  }

  void add_rates(const assembly::State& state, const assembly::Rows& r, Real rate) const {
    for_each_rate(*this, [&](const auto& part) { part.assembler->add_residual(part.at(rate), state, r); });
  }

  Real initial(const mesh::Vector& x) const { return parameters_.initial(x, 0); }
  Real mean_initial(LocalIndex cell) const {
    return assembly::cell_mean(*mesh_, cell, [&](const auto& x) { return initial(x); })[1];
  }
  Real biot(LocalIndex cell) const { return parameters_.biot.of_cell(*mesh_, cell); }
  /// alpha^2/(lambda + 2G)
  Real softness(LocalIndex cell) const {
    const auto& law = parameters_.elasticity.of_cell(*mesh_, cell);
    return biot(cell) * biot(cell) / (law.lambda + 2 * law.G);
  }

  void build_cells();
  void build_stabilisation();
  void build_sides();
  void build_tips();

  PoroelasticCouplingParameters parameters_;
  bool fractures_, tips_;  // the mesh has some; enriched ones
  RCP<const mesh::Mesh> mesh_;
  std::array<int, 2> pressures_{};  // blocks of pressure, face pressure
  ConstView<Real*> schur_;          // [owned cell] alpha^2 V/(lambda + 2G), m^3/Pa: what fixes the stress, of V_K
  Part<OfNodes> cells_, tip_cells_;
  Part<Opening<Nodes>> tip_sides_;
  Part<OfBubble> bubbles_;
  Part<OfSide> sides_;
  Part<Stabilised> stabilised_;
};

template <Shape shape>
void PoroelasticCoupling<shape>::bind(const assembly::Context& context) {
  mesh_ = context.mesh();
  const int u = context.field("displacement");
  const auto [p, trace] = pressures_ = {context.field("pressure"), context.field("face pressure")};
  cells_.bind(context, Loop::cells, {u, p}, {u, p});
  stabilised_.bind(context, Loop::cells, {p, trace}, {p, trace});
  build_cells();
  build_stabilisation();
  if (!fractures_) return;
  const int beta = context.field("side bubble"), b = context.field("widening");
  bubbles_.bind(context, Loop::fracture_sides, {beta, p}, {beta, p});
  sides_.bind(context, Loop::fracture_sides, {u, beta, b}, {u, beta, trace, b});
  build_sides();
  if (!tips_) return;
  const int q = context.field("tip displacement");
  tip_cells_.bind(context, Loop::tip_cells, {q, p}, {q, p});
  tip_sides_.bind(context, Loop::tip_sides, {q, b}, {q, trace, b});
  build_tips();
}

template <Shape shape>
void PoroelasticCoupling<shape>::jacobian(const assembly::State& state, fields::BlockMatrix& J) const {
  for_each_rate(*this, [&](const auto& part) { part.assembler->add_jacobian(part.at(state.rate), state, J); });
  for_each_opening(*this, [&](const auto& part) { part.assembler->add_jacobian(part.op, state, J); });
}

template <Shape shape>
void PoroelasticCoupling<shape>::build_cells() {
  cells_.op.volume = cell_volumes<shape>(*mesh_, [&](LocalIndex cell) { return biot(cell); });
  std::vector<Real> reference, schur;
  for (LocalIndex c = 0; c < mesh_->n_cells(); ++c) {
    const auto [volume, mean] = assembly::cell_mean(*mesh_, c, [&](const auto& x) { return initial(x); });
    reference.push_back(mean);
    if (c < mesh_->n_owned_cells) schur.push_back(softness(c) * volume);
  }
  cells_.op.reference = assembly::to_device(reference, "initial pressure");
  schur_ = assembly::to_device(schur, "schur");
}

/// Faces of fractures get no share: what would flow through them is spread over the others.
template <Shape shape>
void PoroelasticCoupling<shape>::build_stabilisation() {
  constexpr int n_corners = mesh::n_corners(shape);
  std::vector<int> closed(mesh_->n_cells() * n_faces, 0);
  for (const auto& [f, side] : assembly::fracture_sides(*mesh_)) {
    const auto& face = mesh_->fracture_faces[f];
    closed[face.cell[side] * n_faces + face.local_face[side]] = 1;
  }
  const bool falls = !parameters_.initial.is_constant();
  const View<Real**> T_device("T", mesh_->n_cells(), n_faces * n_faces),
      lift_device("lift", falls ? mesh_->n_cells() : 0, n_faces);
  const auto T = Kokkos::create_mirror_view(T_device), lift = Kokkos::create_mirror_view(lift_device);
  Real X[n][dim];
  for (LocalIndex c = 0; c < mesh_->n_cells(); ++c) {
    assembly::gather_host<shape>(*mesh_, c, X);
    const CellFaces<shape> faces(X);
    if (biot(c) == 0) continue;
    laws::Mobility beta;
    for (int i = 0; i < dim; ++i)
      for (int j = 0; j < dim; ++j)
        for (int k = 0; k < n_corners; ++k)
          beta.value[i][j] += softness(c) * faces.corners[k][i] * faces.corners[k][j] / n_corners;
    FlowMatrix<shape> matrix(faces, beta, parameters_.scheme);
    for (int e = 0; e < n_faces; ++e)
      if (closed[c * n_faces + e]) matrix.close(e);
    for (int i = 0; i < n_faces; ++i)
      for (int j = 0; j < n_faces; ++j) T(c, i * n_faces + j) = matrix.T[i][j];
    const Real mean = falls ? mean_initial(c) : 0;
    for (int j = 0; j < n_faces && falls; ++j) {
      lift(c, j) = assembly::face_mean(*mesh_, c, j, [&](const auto&, const auto& x) { return initial(x); }) - mean;
    }
  }
  Kokkos::deep_copy(T_device, T);
  Kokkos::deep_copy(lift_device, lift);
  stabilised_.op = {.T = T_device, .lift = lift_device};
}

template <Shape shape>
void PoroelasticCoupling<shape>::build_sides() {
  bubbles_.op.volume = bubble_volumes<shape>(*mesh_, [&](LocalIndex cell) { return biot(cell); });
  sides_.op.volume = side_volumes<shape>(*mesh_);
  std::vector<Real> reference, halves;
  for (const auto& [f, side] : assembly::fracture_sides(*mesh_)) {
    reference.push_back(mean_initial(mesh_->fracture_faces[f].cell[side]));
    halves.push_back(mesh_->fracture_faces[f].area / 2);
  }
  bubbles_.op.reference = assembly::to_device(reference, "initial pressure");
  sides_.op.part = assembly::to_device(halves, "half of the area");
}

template <Shape shape>
void PoroelasticCoupling<shape>::build_tips() {
  tip_cells_.op.volume = tip_cell_volumes<shape>(*mesh_, [&](LocalIndex cell) { return biot(cell); });
  tip_sides_.op.volume = tip_side_volumes<shape>(*mesh_);
  std::vector<Real> reference;
  for (const LocalIndex cell : assembly::tip_cells(*mesh_)) reference.push_back(mean_initial(cell));
  tip_cells_.op.reference = assembly::to_device(reference, "initial pressure");
  tip_sides_.op.part = assembly::to_device(std::vector<Real>(tip_sides_.op.volume.extent(0), 0), "none of the area");
}

}  // namespace

std::unique_ptr<assembly::Module> make_poroelastic_coupling(const mesh::Mesh& mesh,
                                                            PoroelasticCouplingParameters parameters) {
  return mesh::for_shape(mesh.shape, [&](auto s) -> std::unique_ptr<assembly::Module> {
    return std::make_unique<PoroelasticCoupling<s()>>(mesh, std::move(parameters));
  });
}

}  // namespace sprekk::physics
