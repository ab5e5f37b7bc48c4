// Patches of cells around nodes, and the recovery of symmetric tensors from samples on them.
#pragma once

#include "assembly/loop.hpp"
#include "assembly/tip_cell.hpp"
#include "base/check.hpp"
#include "base/symmetric.hpp"

#include <Teuchos_LAPACK.hpp>

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <vector>

namespace sprekk::estimate {

/// Sample points of a cell, at or near the points of highest accuracy of gradients. Order 1: the centre. Order 2: two
/// points per direction, or the edge midpoints of simplices. Cells with a tip: two points per direction, or dim + 1
/// interior points of simplices.
template <mesh::Shape shape>
struct SamplePoints {
  static constexpr int dim = mesh::dimension(shape);
  static constexpr bool simplex = mesh::is_simplex(shape);

  static int n(bool tip) {
    if (mesh::order(shape) == 1 && !tip) return 1;
    return !simplex ? 1 << dim : tip ? dim + 1 : dim * (dim + 1) / 2;
  }
  static void at(int p, bool tip, Real (&xi)[dim]) {
    if (n(tip) == 1) return assembly::ReferenceCell<shape>::centre(xi);
    int from = 0, to = 1;  // corners of edge p
    for (int edge = 0; edge < p; ++edge)
      if (++to > dim) to = ++from + 1;
    const Real near = dim == 2 ? 2.0 / 3.0 : 0.58541019662496845446, far = (1 - near) / dim;
    for (int i = 0; i < dim; ++i)
      if (!simplex)
        xi[i] = assembly::Gauss<2>::point((p >> i) & 1);
      else if (tip)
        xi[i] = p == i + 1 ? near : far;
      else
        xi[i] = from == i + 1 || to == i + 1 ? 0.5 : 0;
  }
};

/// Patches and their functions. A patch consists of the cells of one region that share a corner node. Cells with a tip
/// belong only to the patches of their tips (mesh::Mesh::tip). The functions are polynomials of the order of
/// the cells for all components. At tips they are linear functions and crack modes. The coefficients are fitted to
/// samples by least squares. `TipModes`: `n`, the number of crack modes, and `at(cell, tip, x)`, an optional array of
/// their values around the tip `tip` at the point x of a local cell.
template <mesh::Shape shape, class TipModes>
class RecoveryPatches {
 public:
  static constexpr int dim = mesh::dimension(shape), order = mesh::order(shape);
  static constexpr int n_nodes = mesh::n_nodes(shape), n_corners = mesh::n_corners(shape);
  static constexpr int n_linear = dim + 1, n_terms = order == 1 ? n_linear : n_linear + dim * (dim + 1) / 2;
  static constexpr int n_modes = TipModes::n;
  using Cell = assembly::ReferenceCell<shape>;
  using Corners = assembly::ReferenceCell<mesh::linear(shape)>;
  using Tip = assembly::TipCell<mesh::linear(shape)>;
  using Tensor = base::Symmetric<dim>;
  using Values = typename Tensor::Values;
  using Terms = std::array<Real, n_terms>;
  using Polynomial = std::array<Terms, Tensor::n>;
  using Modes = std::array<Values, n_modes>;
  /// Coefficients of the functions of a patch.
  struct Fit {
    Polynomial polynomial{};
    std::array<Real, n_modes> modes{};
  };
  using Fits = std::vector<Fit>;  // [patch]

  /// Geometry at a point of a cell.
  struct Point {
    Real xi[dim], g[n_nodes][dim], g_tip[n_nodes][dim] = {};
    std::array<Real, dim> x{};
    bool enriched = false;
    assembly::CellPoint<shape> map;

    Point(const mesh::Mesh& mesh, LocalIndex cell, const Real (&xi)[dim], const Tip* tip)
        : Point(Nodes(mesh, cell, xi), xi, tip) {}
    /// Computes the spatial gradient of the face function of a face of the cell.
    void bubble(int local_face, Real (&gradient)[dim]) const {
      Real db[dim];
      Cell::bubble(local_face, xi, db);
      map.gradient(db, gradient);
    }

   private:
    struct Nodes {
      Real X[n_nodes][dim], dN[n_nodes][dim];
      Nodes(const mesh::Mesh& mesh, LocalIndex cell, const Real (&xi)[dim]) {
        assembly::gather_host<shape>(mesh, cell, X);
        Cell::gradients(xi, dN);
      }
    };
    Point(const Nodes& nodes, const Real (&at)[dim], const Tip* tip) : enriched(tip), map(nodes.X, nodes.dN) {
      Real N[n_nodes];
      std::copy_n(at, dim, xi);
      Cell::shape_functions(xi, N);
      for (int a = 0; a < n_nodes; ++a) {
        map.gradient(nodes.dN[a], g[a]);
        for (int i = 0; i < dim; ++i) x[i] += N[a] * nodes.X[a][i];
      }
      if constexpr (order == 1) {
        if (!tip) return;
        typename Tip::Values values;
        tip->at(xi, values);
        std::copy(&values.grad_psi[0][0], &values.grad_psi[0][0] + n_nodes * dim, &g_tip[0][0]);
      }
    }
  };

  /// Values of the functions of a patch at a point of one of its cells.
  struct Functions {
    Terms terms;
    Modes modes{};
    bool singular = false;

    void add(const Values& s, Real factor, Fit& fit) const {
      add(s, factor, fit.polynomial);
      for (int m = 0; singular && m < n_modes; ++m) fit.modes[m] += factor * Tensor::product(modes[m], s);
    }
    void add(const Values& s, Real factor, Polynomial& polynomial) const {
      for (int k = 0; k < Tensor::n; ++k)
        for (int r = 0; r < n_terms; ++r) polynomial[k][r] += factor * s[k] * terms[r];
    }
    void evaluate(const Fit& fit, Real factor, Values& s) const {
      evaluate(fit.polynomial, factor, s);
      for (int m = 0; singular && m < n_modes; ++m)
        for (int k = 0; k < Tensor::n; ++k) s[k] += factor * fit.modes[m] * modes[m][k];
    }
    void evaluate(const Polynomial& polynomial, Real factor, Values& s) const {
      for (int k = 0; k < Tensor::n; ++k)
        for (int r = 0; r < n_terms; ++r) s[k] += factor * polynomial[k][r] * terms[r];
    }
  };

  /// Builds the patches. Throws an Error if a fit is singular. Collective.
  RecoveryPatches(RCP<const mesh::Mesh> mesh, TipModes tip_modes) : mesh_(mesh), tip_modes_(std::move(tip_modes)) {
    if constexpr (order == 1)
      for (const LocalIndex cell : assembly::tip_cells(*mesh)) tip_cells_.emplace(cell, Tip(*mesh, cell));
    find_patches();
    find_inside();
    factor();
    fit_modes();
  }

  std::size_t size() const { return patches_.size(); }
  const Tip* tip_cell(LocalIndex cell) const {
    const auto found = tip_cells_.find(cell);
    return found == tip_cells_.end() ? nullptr : &found->second;
  }
  LocalIndex node(LocalIndex cell, int a) const { return mesh_->cells[cell * n_nodes + a]; }
  /// Patch around a corner of a local cell; -1: no owned cell needs it, or the cell has a tip elsewhere.
  int patch(LocalIndex cell, int corner) const { return patch_of_corner_[cell * n_corners + corner]; }

  /// Weights of the patches of an owned cell at a reference point. They sum to 1. They are proportional to the linear
  /// shape functions of the corners in the interior of their patches; without such corners, of all corners.
  std::array<Real, n_corners> weights(LocalIndex cell, const Real (&xi)[dim]) const {
    Real N[n_corners], sum = 0;
    Corners::shape_functions(xi, N);
    const auto first = is_inside_.begin() + cell * n_corners;
    const bool any = std::any_of(first, first + n_corners, [](char inside) { return inside != 0; });
    std::array<Real, n_corners> result{};
    for (int k = 0; k < n_corners; ++k)
      if (patch(cell, k) >= 0 && (first[k] || !any)) sum += result[k] = N[k];
    for (Real& weight : result) weight /= sum;
    return result;
  }

  /// Calls visit(patch) for the patches of a local cell.
  template <class Visit>
  void for_each_patch(LocalIndex cell, const Visit& visit) const {
    for (int k = 0; k < n_corners; ++k)
      if (const int p = patch(cell, k); p >= 0) visit(p);
  }
  /// Calls visit(point) for the sample points of a local cell.
  template <class Visit>
  void for_each_sample(LocalIndex cell, const Visit& visit) const {
    const bool tip = assembly::has_tip(*mesh_, cell);
    Real xi[dim];
    for (int p = 0; p < SamplePoints<shape>::n(tip); ++p) {
      SamplePoints<shape>::at(p, tip, xi);
      visit(Point(*mesh_, cell, xi, tip_cell(cell)));
    }
  }

  /// Functions of patch p at a point of one of its cells.
  Functions functions(LocalIndex cell, int p, const Point& point) const {
    Functions f{terms(patches_[p], point.x)};
    if (patches_[p].tip < 0) return f;
    const auto& tip = tips_[patches_[p].tip];
    if (tip.factor[0] == 0) return f;
    f.singular = true;
    f.modes = tip_modes_.at(cell, tip.node, point.x).value();
    for (int m = 0; m < n_modes; ++m) {
      f.evaluate(tip.fit[m], -1, f.modes[m]);
      for (int k = 0; k < Tensor::n; ++k) {
        for (int l = 0; l < m; ++l) f.modes[m][k] -= tip.factor[l * n_modes + m] * f.modes[l][k];
        f.modes[m][k] /= tip.factor[m * n_modes + m];
      }
    }
    return f;
  }
  /// Computes the coefficients from the sums over samples.
  void solve(Fits& fits) const {
    for (std::size_t p = 0; p < fits.size(); ++p) solve(static_cast<int>(p), fits[p].polynomial);
  }

  /// Sums the fits of each patch over all ranks. Collective.
  void sum_over_ranks(Fits& fits) const {
    constexpr int n = sizeof(Fit) / sizeof(Real);
    static_assert(n == Tensor::n * n_terms + n_modes);
    fields::MultiVector here(map_, n), unique(import_->getSourceMap(), n);
    const auto copy = [&](const auto& one) {
      const auto view = here.getLocalViewHost(Tpetra::Access::ReadWrite);
      for (std::size_t p = 0; p < fits.size(); ++p)
        for (int k = 0; k < n; ++k) {
          auto& fit = fits[p];
          constexpr int n_polynomial = Tensor::n * n_terms;
          one(k < n_polynomial ? fit.polynomial[k / n_terms][k % n_terms] : fit.modes[k - n_polynomial], view(p, k));
        }
    };
    copy([](Real& value, Real& entry) { entry = value; });
    unique.doExport(here, *import_, Tpetra::ADD);
    here.doImport(unique, *import_, Tpetra::REPLACE);
    copy([](Real& value, Real& entry) { value = entry; });
  }

 private:
  struct Patch {
    std::array<Real, dim> centre;
    std::array<Real, dim> size{};                  // largest distances of samples from the centre, per direction
    std::array<Real, n_terms * n_terms> factor{};  // Cholesky factor of the normal equations
    int tip = -1;                                  // number in tips_; -1: no tip
  };
  /// Crack modes of a patch. Their polynomial fits are subtracted, and they are orthonormalised at the samples.
  struct TipPatch {
    LocalIndex node;
    std::array<Polynomial, n_modes> fit{};
    std::array<Real, n_modes * n_modes> factor{};  // Cholesky factor of their products; zero: no modes
  };

  GlobalIndex patch_id(LocalIndex cell, int corner) const {
    return mesh_->node_id[node(cell, corner)] * static_cast<GlobalIndex>(mesh_->region_names.size()) +
           mesh_->cell_region[cell];
  }
  bool is_tip(LocalIndex cell, int corner) const { return !mesh_->tip.empty() && mesh_->tip[node(cell, corner)]; }
  /// Polynomial terms: 1, the scaled coordinates relative to the centre, and their products. At tips the modes replace
  /// the products.
  static Terms terms(const Patch& patch, const std::array<Real, dim>& x) {
    Terms q{1};
    for (int i = 0; i < dim; ++i) q[1 + i] = (x[i] - patch.centre[i]) / patch.size[i];
    for (int k = n_linear; k < n_terms && patch.tip < 0; ++k)
      q[k] = q[1 + Tensor::row(k - n_linear)] * q[1 + Tensor::column(k - n_linear)];
    return q;
  }

  /// Calls visit(cell, point, patch) for all samples of all patches.
  template <class Visit>
  void for_each(const Visit& visit) const {
    for (LocalIndex c = 0; c < mesh_->n_cells(); ++c)
      for_each_sample(c, [&](const Point& point) { for_each_patch(c, [&](int p) { visit(c, point, p); }); });
  }

  void find_patches() {
    std::vector<GlobalIndex> ids;
    std::unordered_map<GlobalIndex, int> number;
    const auto has_patch = [&](LocalIndex c, int k) { return is_tip(c, k) || !assembly::has_tip(*mesh_, c); };
    for (LocalIndex c = 0; c < mesh_->n_owned_cells; ++c)
      for (int k = 0; k < n_corners; ++k) {
        if (!has_patch(c, k)) continue;
        const auto [at, is_new] = number.emplace(patch_id(c, k), static_cast<int>(patches_.size()));
        if (!is_new) continue;
        ids.push_back(at->first);
        auto& patch = patches_.emplace_back();
        std::copy_n(&mesh_->coordinates[node(c, k) * dim], dim, patch.centre.begin());
        if (!is_tip(c, k)) continue;
        patch.tip = static_cast<int>(tips_.size());
        tips_.push_back({node(c, k)});
      }
    for (LocalIndex c = 0; c < mesh_->n_cells(); ++c)
      for (int k = 0; k < n_corners; ++k) {
        const auto found = number.find(patch_id(c, k));
        patch_of_corner_.push_back(found == number.end() || !has_patch(c, k) ? -1 : found->second);
      }
    const auto unknown = Teuchos::OrdinalTraits<Tpetra::global_size_t>::invalid();
    map_ = rcp(
        new const fields::Map(unknown, Teuchos::ArrayView<const GlobalIndex>(ids.data(), ids.size()), 0, mesh_->comm));
    const auto unique = Tpetra::createOneToOne(map_);
    import_ = rcp(new const fields::Import(unique, map_));
  }

  /// Finds the corners of owned cells in the interior of their patch: neither on a fracture nor on a region border.
  void find_inside() {
    std::vector<int> region(mesh_->n_nodes(), -1);  // region of the cells; -2: on a region border
    for (LocalIndex c = 0; c < mesh_->n_cells(); ++c)
      for (int k = 0; k < n_corners; ++k) {
        int& first = region[node(c, k)];
        first = first == -1 || first == mesh_->cell_region[c] ? mesh_->cell_region[c] : -2;
      }
    for (const auto& [f, side] : assembly::fracture_sides(*mesh_)) {
      const auto& face = mesh_->fracture_faces[f];
      for (int k = 0; k < mesh::n_face_corners(shape); ++k)
        region[node(face.cell[side], mesh::face_nodes(shape)[face.local_face[side]][k])] = -2;
    }
    for (LocalIndex c = 0; c < mesh_->n_owned_cells; ++c)
      for (int k = 0; k < n_corners; ++k)
        is_inside_.push_back(patch(c, k) >= 0 && !is_tip(c, k) && region[node(c, k)] >= 0);
  }

  /// Factors the normal equations. A multiple of the squared highest-order coefficients is added. It makes the fit
  /// unique with few samples and leaves fields of lower order unchanged.
  void factor() {
    for_each([&](LocalIndex, const Point& point, int p) {
      auto& patch = patches_[p];
      for (int i = 0; i < dim; ++i) patch.size[i] = std::max(patch.size[i], std::abs(point.x[i] - patch.centre[i]));
    });
    for (auto& patch : patches_) {
      const Real largest = *std::max_element(patch.size.begin(), patch.size.end());
      for (Real& size : patch.size) size = std::max(size, 1e-3 * largest);
    }
    for_each([&](LocalIndex, const Point& point, int p) {
      auto& patch = patches_[p];
      const Terms q = terms(patch, point.x);
      for (int r = 0; r < n_terms; ++r)
        for (int s = 0; s < n_terms; ++s) patch.factor[r * n_terms + s] += q[r] * q[s];
      for (int r = order == 1 ? 1 : n_linear; r < n_terms; ++r) patch.factor[r * n_terms + r] += regularisation;
    });
    for (auto& patch : patches_)
      SPREKK_CHECK(cholesky<n_terms>(patch.factor), "recovery: the fit around the node at ({}, {}, ...) is singular",
                   patch.centre[0], patch.centre[1]);
  }

  template <int n>
  static bool cholesky(std::array<Real, n * n>& matrix) {
    int info = 0;
    Teuchos::LAPACK<int, Real>().POTRF('L', n, matrix.data(), n, &info);
    return info == 0;
  }
  void solve(int p, Polynomial& right_sides) const {
    int info = 0;
    Teuchos::LAPACK<int, Real>().POTRS('L', n_terms, Tensor::n, patches_[p].factor.data(), n_terms,
                                       right_sides[0].data(), n_terms, &info);
  }
  /// Fits polynomials to the modes at tips, and factors the products of the remainders.
  void fit_modes() {
    const auto for_each_mode = [&](const auto& visit) {
      if (!tips_.empty())
        for_each([&](LocalIndex c, const Point& point, int p) {
          if (patches_[p].tip < 0) return;
          auto& tip = tips_[patches_[p].tip];
          if (const auto raw = tip_modes_.at(c, tip.node, point.x))
            visit(Functions{terms(patches_[p], point.x)}, *raw, tip);
        });
    };
    for_each_mode([](const Functions& f, const Modes& raw, TipPatch& tip) {
      for (int m = 0; m < n_modes; ++m) f.add(raw[m], 1, tip.fit[m]);
    });
    for (std::size_t p = 0; p < patches_.size(); ++p)
      if (patches_[p].tip >= 0)
        for (auto& polynomial : tips_[patches_[p].tip].fit) solve(static_cast<int>(p), polynomial);
    for_each_mode([](const Functions& f, const Modes& raw, TipPatch& tip) {
      for (int m = 0; m < n_modes; ++m) {
        Values rest = raw[m];
        f.evaluate(tip.fit[m], -1, rest);
        for (int l = 0; l < n_modes; ++l) tip.factor[m * n_modes + l] += Tensor::product(rest, raw[l]);
      }
    });
    for (auto& tip : tips_)
      if (!cholesky<n_modes>(tip.factor)) tip.factor[0] = 0;
  }

  /// Regularisation per sample, in coordinates scaled by the patch size. For order 2 it is larger on tetrahedra,
  /// because the quadratic terms follow the errors of the samples of these cells more closely.
  static constexpr Real regularisation = order == 1 ? 0.3 : shape == mesh::Shape::tetrahedron10 ? 0.06 : 0.01;

  RCP<const mesh::Mesh> mesh_;
  TipModes tip_modes_;
  std::unordered_map<LocalIndex, Tip> tip_cells_;  // local cells with tip functions
  std::vector<Patch> patches_;                     // around the corners of owned cells
  std::vector<TipPatch> tips_;
  std::vector<char> is_inside_;       // [owned cell, corner]
  std::vector<int> patch_of_corner_;  // [local cell, corner], see patch()
  RCP<const fields::Map> map_;        // map of the patches; several ranks may share a patch
  RCP<const fields::Import> import_;
};

}  // namespace sprekk::estimate
