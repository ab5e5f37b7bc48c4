#include "physics/stress_recovery.hpp"

#include "assembly/geometry.hpp"
#include "assembly/loop.hpp"

#include <Teuchos_CommHelpers.hpp>
#include <Teuchos_LAPACK.hpp>

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace sprekk::physics {

using mesh::Shape;

namespace {

/// The points of a cell where the stress is most accurate, or at least not worst: the centre at order 1, 2 points per
/// direction or dim + 1 on simplices at order 2.
template <Shape shape>
struct SamplePoints {
  static constexpr int dim = mesh::dimension(shape);
  static constexpr bool simplex = mesh::is_simplex(shape);
  static constexpr int n = mesh::order(shape) == 1 ? 1 : simplex ? dim + 1 : 1 << dim;

  static void at(int p, Real (&xi)[dim]) {
    assembly::ReferenceCell<shape>::centre(xi);
    if (n == 1) return;
    const Real near = dim == 2 ? 2.0 / 3.0 : 0.58541019662496845446, far = dim == 2 ? 1.0 / 6.0 : (1 - near) / 3;
    for (int i = 0; i < dim; ++i) xi[i] = simplex ? (p == i + 1 ? near : far) : assembly::Gauss<2>::point((p >> i) & 1);
  }
};

/// Symmetric tensors as their components XX, YY[, ZZ], XY[, YZ, XZ].
template <int dim>
struct Symmetric {
  static constexpr int n = dim * (dim + 1) / 2;
  using Values = std::array<Real, n>;
  static constexpr int row(int k) { return k < dim ? k : k == 4 ? 1 : 0; }
  static constexpr int column(int k) { return k < dim ? k : k == 3 || dim == 2 ? 1 : 2; }
  /// a : b
  static Real product(const Values& a, const Values& b) {
    Real sum = 0;
    for (int k = 0; k < n; ++k) sum += (k < dim ? 1 : 2) * a[k] * b[k];
    return sum;
  }
  static Values stress(const laws::Elasticity& law, const Values& strain) {
    return scaled(strain, 2 * law.G, law.lambda);
  }
  static Values strain(const laws::Elasticity& law, const Values& stress) {
    return scaled(stress, 1 / (2 * law.G), -law.lambda / (2 * law.G * (dim * law.lambda + 2 * law.G)));
  }

 private:
  /// a v + b tr(v) I
  static Values scaled(const Values& v, Real a, Real b) {
    Real trace = 0;
    for (int i = 0; i < dim; ++i) trace += v[i];
    Values result;
    for (int k = 0; k < n; ++k) result[k] = a * v[k] + (k < dim ? b * trace : 0);
    return result;
  }
};

template <Shape shape>
class Recovery final : public StressRecovery {
 public:
  static constexpr int dim = mesh::dimension(shape), order = mesh::order(shape);
  static constexpr int n_nodes = mesh::n_nodes(shape), n_corners = mesh::n_corners(shape);
  static constexpr int n_linear = dim + 1, n_terms = order == 1 ? n_linear : n_linear + dim * (dim + 1) / 2;
  using Cell = assembly::ReferenceCell<shape>;
  using Corners = assembly::ReferenceCell<mesh::linear(shape)>;
  using Samples = SamplePoints<shape>;
  using Rule = assembly::Quadrature<shape, order + 1>;
  using Tensor = Symmetric<dim>;
  using Values = typename Tensor::Values;
  using Terms = std::array<Real, n_terms>;
  /// A tensor for every term of every patch, [patch](tensor component, term).
  using Polynomials = std::vector<std::array<Terms, Tensor::n>>;

  Recovery(RCP<const mesh::Mesh> mesh, const fields::Layout& displacement, std::vector<laws::Elasticity> elasticity,
           std::vector<int> elasticity_of_cell)
      : mesh_(mesh),
        displacement_(displacement),
        elasticity_(std::move(elasticity)),
        elasticity_of_cell_(std::move(elasticity_of_cell)) {
    find_patches();
    factor();
  }

  StressError operator()(const fields::Vector& displacement) const override {
    fields::Vector u(displacement_.ghosted()), forces(displacement_.ghosted());
    u.doImport(displacement, *displacement_.import(), Tpetra::REPLACE);
    StressError result;
    Real squares[2] = {}, all[2];
    {
      const auto u_view = u.getLocalViewHost(Tpetra::Access::ReadOnly);
      const auto force_view = forces.getLocalViewHost(Tpetra::Access::ReadWrite);
      const auto stress = fitted(u_view);
      Polynomials moments(stress.size(), std::array<Terms, Tensor::n>{});
      for (LocalIndex c = 0; c < mesh_->n_owned_cells; ++c) {
        Real square[3] = {};
        add_cell(c, u_view, stress, moments, force_view, square);
        result.density.push_back(square[0] / square[2]);
        for (int k = 0; k < 2; ++k) squares[k] += square[k];
      }
      sum_over_ranks(moments);
      solve(moments);
      for (LocalIndex c = 0; c < mesh_->n_owned_cells; ++c) add_recovered(c, moments, force_view);
    }
    Teuchos::reduceAll(*mesh_->comm, Teuchos::REDUCE_SUM, 2, squares, all);
    result.error = std::sqrt(all[0]);
    result.stress = std::sqrt(all[1]);
    result.forces = rcp(new fields::Vector(displacement_.owned()));
    result.forces->doExport(forces, *displacement_.import(), Tpetra::ADD);
    return result;
  }

 private:
  struct Patch {
    std::array<Real, dim> centre;
    Real size = 0;
    std::array<Real, n_terms * n_terms> factor{};  // Cholesky, of the normal equations
  };

  /// Geometry at a point of a cell.
  struct Point {
    Real N[n_nodes], g[n_nodes][dim], volume;
    std::array<Real, dim> x{};

    Point(const mesh::Mesh& mesh, LocalIndex cell, const Real (&xi)[dim]) {
      Real X[n_nodes][dim], dN[n_nodes][dim];
      assembly::gather_host<shape>(mesh, cell, X);
      Cell::shape_functions(xi, N);
      Cell::gradients(xi, dN);
      const assembly::CellPoint<shape> point(X, dN);
      volume = point.volume;
      for (int a = 0; a < n_nodes; ++a) {
        point.gradient(dN[a], g[a]);
        for (int i = 0; i < dim; ++i) x[i] += N[a] * X[a][i];
      }
    }
  };

  const laws::Elasticity& law(LocalIndex cell) const {
    return elasticity_[elasticity_of_cell_.empty() ? mesh_->cell_region[cell] : elasticity_of_cell_[cell]];
  }
  LocalIndex unknown(LocalIndex cell, int a) const { return mesh_->free_node(mesh_->cells[cell * n_nodes + a]) * dim; }
  GlobalIndex patch_id(LocalIndex cell, int corner) const {
    return mesh_->node_id[mesh_->cells[cell * n_nodes + corner]] *
               static_cast<GlobalIndex>(mesh_->region_names.size()) +
           mesh_->cell_region[cell];
  }
  /// The patch around a corner of a local cell; -1 where no owned cell needs it.
  int patch(LocalIndex cell, int corner) const { return patch_of_corner_[cell * n_corners + corner]; }

  template <class Vector>
  Values stress(LocalIndex cell, const Point& point, const Vector& u) const {
    Values strain{};
    for (int a = 0; a < n_nodes; ++a)
      for (int k = 0; k < Tensor::n; ++k) {
        const int i = Tensor::row(k), j = Tensor::column(k);
        strain[k] += (u(unknown(cell, a) + i, 0) * point.g[a][j] + u(unknown(cell, a) + j, 0) * point.g[a][i]) / 2;
      }
    return Tensor::stress(law(cell), strain);
  }

  /// Adds the forces factor * s : eps(v) of a stress s at a point.
  template <class Vector>
  void add_forces(LocalIndex cell, const Point& point, const Values& s, Real factor, const Vector& forces) const {
    for (int a = 0; a < n_nodes; ++a)
      for (int k = 0; k < Tensor::n; ++k) {
        const int i = Tensor::row(k), j = Tensor::column(k);
        forces(unknown(cell, a) + i, 0) += factor * s[k] * point.g[a][j];
        if (i != j) forces(unknown(cell, a) + j, 0) += factor * s[k] * point.g[a][i];
      }
  }

  /// 1, the coordinates from the centre of the patch, their products.
  static Terms terms(const Patch& patch, const std::array<Real, dim>& x) {
    Terms q{1};
    for (int i = 0; i < dim; ++i) q[1 + i] = (x[i] - patch.centre[i]) / patch.size;
    for (int k = n_linear; k < n_terms; ++k)
      q[k] = q[1 + Tensor::row(k - n_linear)] * q[1 + Tensor::column(k - n_linear)];
    return q;
  }

  /// Calls visit(point) for the sample points of a local cell.
  template <class Visit>
  void for_each_sample(LocalIndex cell, const Visit& visit) const {
    Real xi[dim];
    for (int p = 0; p < Samples::n; ++p) {
      Samples::at(p, xi);
      visit(Point(*mesh_, cell, xi));
    }
  }

  void find_patches() {
    std::vector<GlobalIndex> ids;
    std::unordered_map<GlobalIndex, int> number;
    for (LocalIndex c = 0; c < mesh_->n_owned_cells; ++c)
      for (int k = 0; k < n_corners && !assembly::has_tip(*mesh_, c); ++k) {
        const auto [at, is_new] = number.emplace(patch_id(c, k), static_cast<int>(patches_.size()));
        if (!is_new) continue;
        ids.push_back(at->first);
        patches_.emplace_back();
        std::copy_n(&mesh_->coordinates[mesh_->cells[c * n_nodes + k] * dim], dim, patches_.back().centre.begin());
      }
    for (LocalIndex c = 0; c < mesh_->n_cells(); ++c)
      for (int k = 0; k < n_corners; ++k) {
        const auto found = number.find(patch_id(c, k));
        const bool none = found == number.end() || assembly::has_tip(*mesh_, c);
        patch_of_corner_.push_back(none ? -1 : found->second);
      }
    const auto unknown = Teuchos::OrdinalTraits<Tpetra::global_size_t>::invalid();
    map_ = rcp(
        new const fields::Map(unknown, Teuchos::ArrayView<const GlobalIndex>(ids.data(), ids.size()), 0, mesh_->comm));
    const auto unique = Tpetra::createOneToOne(map_);
    import_ = rcp(new const fields::Import(unique, map_));
  }

  /// Normal equations of the fit. A multiple of the square of the highest terms is minimised, too: it decides where
  /// there are too few points, and leaves fields of lower order as they are.
  void factor() {
    const auto each = [&](const auto& visit) {
      for (LocalIndex c = 0; c < mesh_->n_cells(); ++c)
        for (int k = 0; k < n_corners; ++k)
          if (const int p = patch(c, k); p >= 0)
            for_each_sample(c, [&](const Point& point) { visit(patches_[p], point); });
    };
    each([](Patch& patch, const Point& point) {
      Real square = 0;
      for (int i = 0; i < dim; ++i) square += (point.x[i] - patch.centre[i]) * (point.x[i] - patch.centre[i]);
      patch.size = std::max(patch.size, std::sqrt(square));
    });
    each([](Patch& patch, const Point& point) {
      const Terms q = terms(patch, point.x);
      for (int r = 0; r < n_terms; ++r)
        for (int s = 0; s < n_terms; ++s) patch.factor[r * n_terms + s] += q[r] * q[s];
      for (int r = order == 1 ? 1 : n_linear; r < n_terms; ++r) patch.factor[r * n_terms + r] += regularisation;
    });
    for (auto& patch : patches_) {
      int info = 0;
      Teuchos::LAPACK<int, Real>().POTRF('L', n_terms, patch.factor.data(), n_terms, &info);
      SPREKK_CHECK(info == 0, "stress recovery: the fit around the node at ({}, {}, ...) is singular", patch.centre[0],
                   patch.centre[1]);
    }
  }

  void solve(Polynomials& right_sides) const {
    for (std::size_t p = 0; p < patches_.size(); ++p) {
      int info = 0;
      Teuchos::LAPACK<int, Real>().POTRS('L', n_terms, Tensor::n, patches_[p].factor.data(), n_terms,
                                         right_sides[p][0].data(), n_terms, &info);
    }
  }

  /// The polynomials of the stress of u.
  template <class Vector>
  Polynomials fitted(const Vector& u) const {
    Polynomials result(patches_.size(), std::array<Terms, Tensor::n>{});
    for (LocalIndex c = 0; c < mesh_->n_cells(); ++c) {
      for_each_sample(c, [&](const Point& point) {
        const Values s = stress(c, point, u);
        for (int k = 0; k < n_corners; ++k)
          if (const int p = patch(c, k); p >= 0) add(s, 1, terms(patches_[p], point.x), result[p]);
      });
    }
    solve(result);
    return result;
  }

  static void add(const Values& s, Real factor, const Terms& q, std::array<Terms, Tensor::n>& polynomial) {
    for (int k = 0; k < Tensor::n; ++k)
      for (int r = 0; r < n_terms; ++r) polynomial[k][r] += factor * s[k] * q[r];
  }
  static void evaluate(const std::array<Terms, Tensor::n>& polynomial, Real factor, const Terms& q, Values& s) {
    for (int k = 0; k < Tensor::n; ++k)
      for (int r = 0; r < n_terms; ++r) s[k] += factor * polynomial[k][r] * q[r];
  }

  /// Adds to the squares |s* - s_h|^2, |s*|^2 and the volume of a cell; the moments of C^-1 (s* - s_h) with the terms
  /// of the patches; and the forces - integral (s* - s_h) : eps(v).
  template <class View, class Forces>
  void add_cell(LocalIndex c, const View& u, const Polynomials& fit, Polynomials& moments, const Forces& forces,
                Real (&square)[3]) const {
    Real xi[dim], weight[n_corners];
    std::array<Terms, n_corners> q;
    const bool trusted = assembly::has_tip(*mesh_, c);
    for (int p = 0; p < Rule::n; ++p) {
      const Real reference = Rule::at(p, xi);
      const Point point(*mesh_, c, xi);
      const Real volume = reference * point.volume;
      Corners::shape_functions(xi, weight);
      Values recovered{}, difference;
      const Values s = stress(c, point, u);
      if (trusted) {
        square[1] += volume * Tensor::product(s, Tensor::strain(law(c), s));
        square[2] += volume;
        continue;
      }
      for (int k = 0; k < n_corners; ++k) {
        q[k] = terms(patches_[patch(c, k)], point.x);
        evaluate(fit[patch(c, k)], weight[k], q[k], recovered);
      }
      for (int k = 0; k < Tensor::n; ++k) difference[k] = recovered[k] - s[k];
      const Values strain = Tensor::strain(law(c), difference);
      square[0] += volume * Tensor::product(difference, strain);
      square[1] += volume * Tensor::product(recovered, Tensor::strain(law(c), recovered));
      square[2] += volume;
      for (int k = 0; k < n_corners; ++k) add(strain, volume * weight[k], q[k], moments[patch(c, k)]);
      add_forces(c, point, difference, -volume, forces);
    }
  }

  /// Adds the forces integral (s* - s_h) : C^-1 s(v)*, for solved moments.
  template <class Forces>
  void add_recovered(LocalIndex c, const Polynomials& moments, const Forces& forces) const {
    if (assembly::has_tip(*mesh_, c)) return;
    for_each_sample(c, [&](const Point& point) {
      Values strain{};
      for (int k = 0; k < n_corners; ++k)
        evaluate(moments[patch(c, k)], 1, terms(patches_[patch(c, k)], point.x), strain);
      add_forces(c, point, Tensor::stress(law(c), strain), 1, forces);
    });
  }

  /// Adds up what the ranks have for each patch.
  void sum_over_ranks(Polynomials& values) const {
    const int n = Tensor::n * n_terms;
    fields::MultiVector here(map_, n), unique(import_->getSourceMap(), n);
    copy(values, here, [](Real& value, Real& entry) { entry = value; });
    unique.doExport(here, *import_, Tpetra::ADD);
    here.doImport(unique, *import_, Tpetra::REPLACE);
    copy(values, here, [](Real& value, Real& entry) { value = entry; });
  }
  template <class Copy>
  static void copy(Polynomials& values, fields::MultiVector& vectors, const Copy& one) {
    const auto view = vectors.getLocalViewHost(Tpetra::Access::ReadWrite);
    for (std::size_t p = 0; p < values.size(); ++p)
      for (int k = 0; k < Tensor::n; ++k)
        for (int r = 0; r < n_terms; ++r) one(values[p][k][r], view(p, k * n_terms + r));
  }

  /// Per patch, with coordinates scaled by its size.
  static constexpr Real regularisation = order == 1 ? 1 : 0.06;

  RCP<const mesh::Mesh> mesh_;
  const fields::Layout& displacement_;
  std::vector<laws::Elasticity> elasticity_;
  std::vector<int> elasticity_of_cell_;
  std::vector<Patch> patches_;        // around the corners of owned cells
  std::vector<int> patch_of_corner_;  // [local cell, corner], see patch()
  RCP<const fields::Map> map_;        // of the patches; other ranks may have the same
  RCP<const fields::Import> import_;
};

}  // namespace

std::unique_ptr<StressRecovery> make_stress_recovery(RCP<const mesh::Mesh> mesh, const fields::Layout& displacement,
                                                     std::vector<laws::Elasticity> elasticity,
                                                     std::vector<int> elasticity_of_cell) {
  const Shape shape = mesh->shape;
  return mesh::for_shape(shape, [&](auto s) -> std::unique_ptr<StressRecovery> {
    return std::make_unique<Recovery<s()>>(mesh, displacement, std::move(elasticity), std::move(elasticity_of_cell));
  });
}

}  // namespace sprekk::physics
