#include "physics/bulk_momentum.hpp"

#include "assembly/assembler.hpp"
#include "assembly/tip_cell.hpp"
#include "mesh/extents.hpp"

#include <algorithm>
#include <cmath>

namespace sprekk::physics {

using assembly::Loop;
using mesh::Shape;

namespace {

/// r = integral sigma(u) : grad N over one cell.
///
/// | symbol   | shape            | unit |                                   |
/// | x        | [node, dim]      | m    | displacement of the cell's nodes  |
/// | r        | [node, dim]      | N    | forces                            |
/// | geometry | see Geometry     | m    |                                   |
/// | law      | [cell]           | -    | number of the cell's material     |
/// | material | [number]         | Pa   | Lame's constants                  |
/// | reference | [node, node, dim, dim] | - | see reference_products()        |
template <Shape shape>
struct ElasticCell {
  using Cell = assembly::ReferenceCell<shape>;
  static constexpr int dim = Cell::dim, n = Cell::n_nodes;
  using Columns = assembly::Slots<assembly::Slot<n, dim>>;
  using Rows = Columns;

  assembly::Geometry geometry;
  ConstView<laws::Elasticity*> material;
  ConstView<int*> law;
  ConstView<Real[n][n][dim][dim]> reference = reference_products();

  /// Calls add(volume, g) at the quadrature points of a cell: the volume that the point stands for and the gradients in
  /// space of the shape functions.
  template <class Add>
  KOKKOS_INLINE_FUNCTION void for_each_point(int cell, const Add& add) const {
    Real X[n][dim];
    geometry.gather(cell, X);
    assembly::with_rule<shape, assembly::StiffnessQuadrature<shape>>(X, [&](const auto& rule) {
      Real xi[dim], dN[n][dim], g[n][dim];
      for (int q = 0; q < rule.n; ++q) {
        const Real weight = rule.at(q, xi);
        Cell::gradients(xi, dN);
        const assembly::CellPoint<shape> point(X, dN);
        for (int a = 0; a < n; ++a) point.gradient(dN[a], g[a]);
        add(weight * point.volume, g);
      }
    });
  }

  KOKKOS_INLINE_FUNCTION void stress(const Real (&g)[n][dim], const Real (&x)[n * dim], int number,
                                     Real (&sigma)[dim][dim]) const {
    Real H[dim][dim] = {};
    for (int a = 0; a < n; ++a)
      for (int i = 0; i < dim; ++i)
        for (int j = 0; j < dim; ++j) H[i][j] += x[a * dim + i] * g[a][j];
    material(number).stress(H, sigma);
  }

  KOKKOS_INLINE_FUNCTION void residual(int cell, const Real (&x)[n * dim], Real (&r)[n * dim]) const {
    for (Real& value : r) value = 0;
    for_each_point(cell, [&](Real volume, const Real(&g)[n][dim]) {
      Real sigma[dim][dim];
      stress(g, x, law(cell), sigma);
      for (int a = 0; a < n; ++a)
        for (int i = 0; i < dim; ++i)
          for (int j = 0; j < dim; ++j) r[a * dim + i] += volume * sigma[i][j] * g[a][j];
    });
  }

  KOKKOS_INLINE_FUNCTION void jacobian(int cell, const Real (&)[n * dim], Real (&K)[n * dim][n * dim]) const {
    const laws::Elasticity elasticity = material(law(cell));
    for_each_product(cell, K, [&](int a, int b, const Real(&M)[dim][dim]) {
      Real block[dim][dim];
      elasticity.stiffness(M, block);
      for (int i = 0; i < dim; ++i)
        for (int j = 0; j < dim; ++j) K[a * dim + i][b * dim + j] = K[b * dim + j][a * dim + i] = block[i][j];
    });
  }

  /// Calls use(a, b, M) for b >= a with M_ij = integral d_i N_a d_j N_b; blocks (a, b) of `work` are free after it.
  template <class Use>
  KOKKOS_INLINE_FUNCTION void for_each_product(int cell, Real (&work)[n * dim][n * dim], const Use& use) const {
    Real X[n][dim], M[dim][dim];
    geometry.gather(cell, X);
    if constexpr (assembly::StiffnessQuadrature<shape>::n == 1) {
      for_each_point(cell, [&](Real volume, const Real(&g)[n][dim]) {
        for (int a = 0; a < n; ++a)
          for (int b = a; b < n; ++b) {
            for (int i = 0; i < dim; ++i)
              for (int j = 0; j < dim; ++j) M[i][j] = volume * g[a][i] * g[b][j];
            use(a, b, M);
          }
      });
    } else if (Cell::is_affine(X)) {
      for_each_affine_product(X, use);
    } else {
      for (auto& row : work)
        for (Real& value : row) value = 0;
      for_each_point(cell, [&](Real volume, const Real(&g)[n][dim]) {
        for (int a = 0; a < n; ++a)
          for (int i = 0; i < dim; ++i) {
            const Real factor = volume * g[a][i];
            for (int b = a; b < n; ++b)
              for (int j = 0; j < dim; ++j) work[a * dim + i][b * dim + j] += factor * g[b][j];
          }
      });
      for (int a = 0; a < n; ++a)
        for (int b = a; b < n; ++b) {
          for (int i = 0; i < dim; ++i)
            for (int j = 0; j < dim; ++j) M[i][j] = work[a * dim + i][b * dim + j];
          use(a, b, M);
        }
    }
  }

  /// The same for an affine map of the reference cell.
  template <class Use>
  KOKKOS_INLINE_FUNCTION void for_each_affine_product(const Real (&X)[n][dim], const Use& use) const {
    Real xi[dim], dN[n][dim], half[dim][dim], M[dim][dim];
    Cell::centre(xi);
    Cell::gradients(xi, dN);
    const assembly::CellPoint<shape> point(X, dN);
    for (int a = 0; a < n; ++a)
      for (int b = a; b < n; ++b) {
        for (int k = 0; k < dim; ++k)
          for (int j = 0; j < dim; ++j) {
            half[k][j] = 0;
            for (int l = 0; l < dim; ++l) half[k][j] += point.volume * reference(a, b, k, l) * point.inverse[l][j];
          }
        for (int i = 0; i < dim; ++i)
          for (int j = 0; j < dim; ++j) {
            M[i][j] = 0;
            for (int k = 0; k < dim; ++k) M[i][j] += point.inverse[k][i] * half[k][j];
          }
        use(a, b, M);
      }
  }

  /// [node, node, component, component] integral of dN_a/dxi_k dN_b/dxi_l over the reference cell.
  static View<Real[n][n][dim][dim]> reference_products() {
    const View<Real[n][n][dim][dim]> products("reference products");
    const auto host = Kokkos::create_mirror_view(products);
    using Rule = assembly::StiffnessQuadrature<shape>;
    Real xi[dim], dN[n][dim];
    for (int q = 0; q < Rule::n; ++q) {
      const Real weight = Rule::at(q, xi);
      Cell::gradients(xi, dN);
      for (int a = 0; a < n; ++a)
        for (int b = 0; b < n; ++b)
          for (int k = 0; k < dim; ++k)
            for (int l = 0; l < dim; ++l) host(a, b, k, l) += weight * dN[a][k] * dN[b][l];
    }
    Kokkos::deep_copy(products, host);
    return products;
  }
};

template <Shape shape>
class BulkMomentum final : public assembly::Module {
 public:
  using Op = ElasticCell<shape>;
  static constexpr int dim = Op::dim, n = Op::n;

  explicit BulkMomentum(BulkMomentumParameters parameters) : parameters_(std::move(parameters)) {}

  std::string name() const override { return "bulk momentum"; }

  assembly::Declaration declare() const override {
    assembly::Declaration d;
    assembly::Unknown u{
        {"displacement", fields::Entity::node, dim, "m"}, assembly::Quantity::length, assembly::Quantity::force};
    u.rigid_body_modes = true;
    d.unknowns = {u};
    d.couplings = {{Loop::cells, "displacement", {"displacement"}}};
    d.outputs = {{"displacement", "m", fields::Entity::node, dim}, {"stress", "Pa", fields::Entity::cell, 6}};
    d.linear = true;
    return d;
  }

  void bind(const assembly::Context& context) override {
    mesh_ = context.mesh();
    const auto extents = mesh::domain_extents(*mesh_);
    size_ = *std::max_element(extents.begin(), extents.end());
    View<laws::Elasticity*> material("material", parameters_.elasticity.size());
    const auto host = Kokkos::create_mirror_view(material);
    std::copy(parameters_.elasticity.begin(), parameters_.elasticity.end(), host.data());
    Kokkos::deep_copy(material, host);
    op_ = std::make_unique<Op>(Op{context.geometry(), material, law_numbers(context)});
    displacement_ = context.field("displacement");
    if (mesh_->n_global_enriched > 0) tip_displacement_ = context.field("tip displacement");
    using Assembler = assembly::Assembler<Op>;
    cells_ = std::make_unique<Assembler>(context, Loop::cells, std::vector<int>{displacement_},
                                         std::vector<int>{displacement_}, Assembler::Positions::once);
    if (has_load()) load_ = View<Real*>("load", context.layout(displacement_).n_owned());
  }

  void residual(const assembly::State& state, const assembly::Rows& r) const override {
    cells_->add_residual(*op_, state, r);
    if (!has_load()) return;
    const auto rows = r[displacement_];
    const auto load = load_;
    Kokkos::parallel_for(
        "load", Kokkos::RangePolicy<Execution>(0, rows.extent(0)), KOKKOS_LAMBDA(int i) { rows(i) -= load(i); });
  }

  void jacobian(const assembly::State& state, fields::BlockMatrix& J) const override {
    cells_->add_jacobian(*op_, state, J);
  }

  bool constant_load() const override {
    const auto constant = [](const base::Expression& e) { return e.constant_in_time(); };
    bool all = parameters_.body_force.constant_in_time();
    for (const auto& traction : parameters_.tractions)
      all = all && std::all_of(traction.value.begin(), traction.value.end(), constant);
    return all;
  }

  void set_time(Real t, const assembly::Scales&) override {
    if (!has_load() || (loaded_ && constant_load())) return;
    const auto host = Kokkos::create_mirror_view(load_);
    Kokkos::deep_copy(host, 0.0);
    add_body_force(t, host);
    add_initial_stress(host);
    for (const auto& traction : parameters_.tractions) add_traction(traction, t, host);
    Kokkos::deep_copy(load_, host);
    loaded_ = true;
  }

  /// Largest traction, and largest body force at nodes times the size of the whole domain.
  Real load(Real t) const override {
    Real largest = 0;
    for (const auto& traction : parameters_.tractions)
      for (const auto& face : mesh_->boundary_faces)
        if (holds(traction, face))
          assembly::for_each_face_point<shape>(*mesh_, face.cell, face.local_face,
                                               [&](const auto&, Real, const auto& x) {
                                                 for (const auto& e : traction.value)
                                                   largest = std::max(largest, std::abs(e(x, t)));
                                               });
    if (parameters_.body_force.empty() && parameters_.initial_stress.empty()) return largest;
    Real force = 0;
    for (LocalIndex c = 0; c < mesh_->n_cells(); ++c) {
      std::array<Real, 3> x{};
      std::copy_n(mesh_->coordinates.begin() + mesh_->cells[c * n] * dim, dim, x.begin());
      for (int i = 0; i < dim; ++i) force = std::max(force, std::abs(parameters_.body_force(i, c, x, t)));
      largest = std::max(largest, largest_initial_stress(x));
    }
    return std::max(largest, force * size_);
  }

  void output(const assembly::State& state, std::vector<assembly::OutputField>& fields) const override {
    const auto u = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), state.x[displacement_]);
    for (LocalIndex node = 0; node < mesh_->n_nodes(); ++node)
      for (int i = 0; i < dim; ++i) fields[0].values.push_back(u(mesh_->free_node(node) * dim + i));
    const auto q = tip_displacement_ < 0
                       ? u
                       : Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), state.x[tip_displacement_]);
    for (LocalIndex c = 0; c < mesh_->n_owned_cells; ++c) add_stress(c, u, q, fields[1].values);
  }

 private:
  bool has_load() const {
    return !parameters_.body_force.empty() || !parameters_.tractions.empty() || !parameters_.initial_stress.empty();
  }
  bool holds(const BoundaryTraction& traction, const mesh::Mesh::BoundaryFace& face) const {
    return face.boundary == traction.boundary &&
           (traction.region < 0 || mesh_->cell_region[face.cell] == traction.region);
  }
  int law_of(LocalIndex cell) const {
    return parameters_.elasticity_of_cell.empty() ? mesh_->cell_region[cell] : parameters_.elasticity_of_cell[cell];
  }

  ConstView<int*> law_numbers(const assembly::Context& context) const {
    if (parameters_.elasticity_of_cell.empty()) return context.geometry().region;
    View<int*> numbers("law", mesh_->n_cells());
    const auto host = Kokkos::create_mirror_view(numbers);
    std::copy(parameters_.elasticity_of_cell.begin(), parameters_.elasticity_of_cell.end(), host.data());
    Kokkos::deep_copy(numbers, host);
    return numbers;
  }

  Real largest_initial_stress(const std::array<Real, 3>& x) const {
    Real largest = 0;
    for (const auto& component : parameters_.initial_stress.value)
      largest = std::max(largest, std::abs(component(x, 0)));
    return largest;
  }

  template <class Host>
  void add_body_force(Real t, const Host& load) const {
    if (parameters_.body_force.empty()) return;
    Real N[n];
    for (LocalIndex c = 0; c < mesh_->n_cells(); ++c)
      assembly::for_each_cell_point<shape>(*mesh_, c, [&](const Real(&xi)[dim], Real volume, const auto& x) {
        Op::Cell::shape_functions(xi, N);
        for (int i = 0; i < dim; ++i) {
          const Real force = volume * parameters_.body_force(i, c, x, t);
          for (int a = 0; a < n; ++a) add(load, mesh_->free_node(mesh_->cells[c * n + a]) * dim + i, N[a] * force);
        }
      });
  }

  template <class Host>
  void add_initial_stress(const Host& load) const {
    if (parameters_.initial_stress.empty()) return;
    Real X[n][dim], dN[n][dim], g[dim], sigma[dim][dim];
    for (LocalIndex c = 0; c < mesh_->n_cells(); ++c) {
      assembly::gather_host<shape>(*mesh_, c, X);
      assembly::for_each_cell_point<shape>(*mesh_, c, [&](const Real(&xi)[dim], Real volume, const auto& x) {
        parameters_.initial_stress.at(x, sigma);
        Op::Cell::gradients(xi, dN);
        const assembly::CellPoint<shape> point(X, dN);
        for (int a = 0; a < n; ++a) {
          point.gradient(dN[a], g);
          for (int i = 0; i < dim; ++i)
            for (int j = 0; j < dim; ++j)
              add(load, mesh_->free_node(mesh_->cells[c * n + a]) * dim + i, -volume * sigma[i][j] * g[j]);
        }
      });
    }
  }

  template <class Host>
  void add_traction(const BoundaryTraction& traction, Real t, const Host& load) const {
    for (const auto& face : mesh_->boundary_faces) {
      if (!holds(traction, face)) continue;
      const auto corners = mesh::face_nodes(shape)[face.local_face];
      assembly::for_each_face_point<shape>(
          *mesh_, face.cell, face.local_face, [&](const auto& N, Real area, const auto& x) {
            for (int i = 0; i < dim; ++i) {
              const Real force = area * traction.value[i](x, t);
              for (int k = 0; k < mesh::n_face_nodes(shape); ++k)
                add(load, mesh_->free_node(mesh_->cells[face.cell * n + corners[k]]) * dim + i, N[k] * force);
            }
          });
    }
  }

  template <class Host>
  static void add(const Host& load, LocalIndex row, Real value) {
    if (row < static_cast<LocalIndex>(load.extent(0))) load(row) += value;
  }

  /// Appends the stress at the centre of cell c; in 2D with the plane-strain sigma_zz.
  template <class Host>
  void add_stress(LocalIndex c, const Host& u, const Host& q, std::vector<Real>& values) const {
    Real X[n][dim], xi[dim], dN[n][dim], H[dim][dim] = {}, sigma[dim][dim];
    assembly::gather_host<shape>(*mesh_, c, X);
    Op::Cell::centre(xi);
    Op::Cell::gradients(xi, dN);
    const assembly::CellPoint<shape> point(X, dN);
    Real trace = 0;
    for (int a = 0; a < n; ++a) {
      Real g[dim];
      point.gradient(dN[a], g);
      for (int i = 0; i < dim; ++i)
        for (int j = 0; j < dim; ++j) H[i][j] += u(mesh_->free_node(mesh_->cells[c * n + a]) * dim + i) * g[j];
    }
    if constexpr (mesh::order(shape) == 1)
      if (assembly::has_tip(*mesh_, c)) {
        typename assembly::TipCell<shape>::Values v;
        assembly::TipCell<shape>(*mesh_, c).at(xi, v);
        for (int a = 0; a < n; ++a)
          if (const LocalIndex number = mesh_->enriched[mesh_->cells[c * n + a]]; number >= 0)
            for (int i = 0; i < dim; ++i)
              for (int j = 0; j < dim; ++j) H[i][j] += q(number * dim + i) * v.grad_psi[a][j];
      }
    const auto& law = parameters_.elasticity[law_of(c)];
    law.stress(H, sigma);
    for (int i = 0; i < dim; ++i) trace += H[i][i];
    if constexpr (dim == 2)
      values.insert(values.end(), {sigma[0][0], sigma[1][1], law.lambda * trace, sigma[0][1], 0, 0});
    else
      values.insert(values.end(), {sigma[0][0], sigma[1][1], sigma[2][2], sigma[0][1], sigma[1][2], sigma[0][2]});
    if (parameters_.initial_stress.empty()) return;
    std::array<Real, 3> x{};
    Real N[n];
    Op::Cell::shape_functions(xi, N);
    for (int a = 0; a < n; ++a)
      for (int i = 0; i < dim; ++i) x[i] += N[a] * X[a][i];
    for (std::size_t k = 0; k < parameters_.initial_stress.value.size(); ++k)
      values[values.size() - 6 + k] += parameters_.initial_stress.component(static_cast<int>(k), x);
  }

  BulkMomentumParameters parameters_;
  RCP<const mesh::Mesh> mesh_;
  int displacement_ = -1, tip_displacement_ = -1;
  bool loaded_ = false;
  Real size_ = 0;  // largest extent of the domain, m
  std::unique_ptr<Op> op_;
  std::unique_ptr<assembly::Assembler<Op>> cells_;
  View<Real*> load_;  // [owned row], N
};

}  // namespace

std::unique_ptr<assembly::Module> make_bulk_momentum(Shape shape, BulkMomentumParameters parameters) {
  return mesh::for_shape(shape, [&](auto s) -> std::unique_ptr<assembly::Module> {
    return std::make_unique<BulkMomentum<s()>>(std::move(parameters));
  });
}

}  // namespace sprekk::physics
