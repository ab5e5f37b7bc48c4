#include "physics/mechanics/stress_recovery.hpp"

#include "base/over_ranks.hpp"
#include "estimate/recovery_patches.hpp"
#include "physics/mechanics/bubble_stiffness.hpp"
#include "physics/mechanics/tip_modes.hpp"

#include <array>
#include <cmath>
#include <unordered_map>

namespace sprekk::physics {

using mesh::Shape;

namespace {

template <Shape shape>
class Recovery final : public StressRecovery {
 public:
  using Patches = estimate::RecoveryPatches<shape, TipModes<mesh::dimension(shape), mesh::order(shape)>>;
  using Cell = typename Patches::Cell;
  using Tensor = typename Patches::Tensor;
  using Values = typename Patches::Values;
  using Fits = typename Patches::Fits;
  using Point = typename Patches::Point;
  static constexpr int dim = Patches::dim, order = Patches::order, n_nodes = Patches::n_nodes,
                       n_corners = Patches::n_corners;

  Recovery(RCP<const mesh::Mesh> mesh, const ByField<const fields::Layout*>& layouts,
           fields::Properties<laws::Elasticity> elasticity)
      : mesh_(mesh), layouts_(layouts), elasticity_(std::move(elasticity)), patches_(mesh, {*mesh, elasticity_}) {
    if (layouts[bubble]) find_bubbles();
  }

  StressError operator()(const ByField<RCP<const fields::Vector>>& displacement) const override {
    std::vector<fields::Vector> vectors, forces;
    Displacement u;
    Forces to;
    for (std::size_t k = 0; k < layouts_.size(); ++k) {
      const auto& layout = *(layouts_[k] ? layouts_[k] : layouts_[nodal]);
      vectors.emplace_back(layout.ghosted());
      forces.emplace_back(layout.ghosted());
      if (layouts_[k]) vectors[k].doImport(*displacement[k], *layout.import(), Tpetra::REPLACE);
      u[k] = vectors[k].getLocalViewHost(Tpetra::Access::ReadOnly);
      to[k] = forces[k].getLocalViewHost(Tpetra::Access::ReadWrite);
    }
    StressError result;
    std::array<Real, 2> squares{};
    const auto fit = fitted(u);
    Fits moments(fit.size());
    for (LocalIndex c = 0; c < mesh_->n_owned_cells; ++c) {
      Real square[3] = {};
      add_cell(c, u, fit, moments, to, square);
      result.energy.push_back(square[0]);
      result.density.push_back(square[0] / square[2]);
      for (int k = 0; k < 2; ++k) squares[k] += square[k];
    }
    patches_.sum_over_ranks(moments);
    patches_.solve(moments);
    for (LocalIndex c = 0; c < mesh_->n_owned_cells; ++c) add_recovered(c, moments, to);
    u = {};
    to = {};  // views must be released before the vectors are changed
    const auto all = base::sum_over_ranks(*mesh_->comm, squares);
    result.error = std::sqrt(all[0]);
    result.stress = std::sqrt(all[1]);
    for (std::size_t k = 0; k < layouts_.size(); ++k) {
      if (!layouts_[k]) continue;
      result.forces[k] = rcp(new fields::Vector(layouts_[k]->owned()));
      result.forces[k]->doExport(forces[k], *layouts_[k]->import(), Tpetra::ADD);
    }
    return result;
  }

 private:
  using Displacement = ByField<typename fields::Vector::dual_view_type::t_host::const_type>;
  using Forces = ByField<typename fields::Vector::dual_view_type::t_host>;

  /// Face function of a side in its cell.
  struct Bubble {
    int local_face;
    LocalIndex unknown;
    Real stiffness;  // alpha
  };

  const laws::Elasticity& law(LocalIndex cell) const { return elasticity_.of_cell(*mesh_, cell); }
  Values stress_of(LocalIndex cell, const Values& strain) const {
    return Tensor::isotropic(strain, 2 * law(cell).G, law(cell).lambda);
  }
  Values strain_of(LocalIndex cell, const Values& stress) const {
    const auto [G, lambda] = law(cell);
    return Tensor::isotropic(stress, 1 / (2 * G), -lambda / (2 * G * (dim * lambda + 2 * G)));
  }
  LocalIndex unknown(LocalIndex cell, int a) const { return mesh_->free_node(patches_.node(cell, a)) * dim; }
  LocalIndex tip_unknown(LocalIndex cell, int a) const { return mesh_->enriched[patches_.node(cell, a)] * dim; }
  /// Adds the strain of field values times a function with gradient g.
  template <class View>
  static void add_strain(const View& values, LocalIndex first, const Real (&g)[dim], Values& strain) {
    for (int k = 0; k < Tensor::n; ++k) {
      const int i = Tensor::row(k), j = Tensor::column(k);
      strain[k] += (values(first + i, 0) * g[j] + values(first + j, 0) * g[i]) / 2;
    }
  }
  /// Stress of nodes and tips at a point.
  Values stress(LocalIndex cell, const Point& point, const Displacement& u) const {
    Values strain{};
    for (int a = 0; a < n_nodes; ++a) {
      add_strain(u[nodal], unknown(cell, a), point.g[a], strain);
      if (point.enriched && tip_unknown(cell, a) >= 0) add_strain(u[tip], tip_unknown(cell, a), point.g_tip[a], strain);
    }
    return stress_of(cell, strain);
  }
  Values bubble_strain(LocalIndex cell, const Point& point, const Displacement& u) const {
    Values strain{};
    Real g[dim];
    for (const auto& b : bubbles_of(cell)) {
      point.bubble(b.local_face, g);
      add_strain(u[bubble], b.unknown, g, strain);
    }
    return strain;
  }

  /// Adds factor * s g to the forces on a function with gradient g.
  template <class View>
  static void add_force(const View& forces, LocalIndex first, const Real (&g)[dim], const Values& s, Real factor) {
    for (int k = 0; k < Tensor::n; ++k) {
      const int i = Tensor::row(k), j = Tensor::column(k);
      forces(first + i, 0) += factor * s[k] * g[j];
      if (i != j) forces(first + j, 0) += factor * s[k] * g[i];
    }
  }
  /// Adds the forces factor * s : eps(v) of a stress s at a point, on nodes and tips.
  void add_forces(LocalIndex cell, const Point& point, const Values& s, Real factor, const Forces& to) const {
    for (int a = 0; a < n_nodes; ++a) {
      add_force(to[nodal], unknown(cell, a), point.g[a], s, factor);
      if (point.enriched && tip_unknown(cell, a) >= 0)
        add_force(to[tip], tip_unknown(cell, a), point.g_tip[a], s, factor);
    }
  }

  void add_bubble_forces(LocalIndex cell, const Point& point, const Values& s, Real factor, const Forces& to) const {
    Real g[dim];
    for (const auto& b : bubbles_of(cell)) {
      point.bubble(b.local_face, g);
      add_force(to[bubble], b.unknown, g, s, factor);
    }
  }

  /// Calls visit(point, volume, weights) at quadrature points of a cell, with the weights of its patches.
  template <class Visit>
  void for_each_point(LocalIndex cell, const Visit& visit) const {
    const auto at = [&](const Real(&xi)[dim], Real reference) {
      const Point point(*mesh_, cell, xi, patches_.tip_cell(cell));
      visit(point, reference * point.map.volume, patches_.weights(cell, xi));
    };
    Real xi[dim];
    const auto visit_all = [&](const auto& rule) {
      for (int p = 0; p < rule.n; ++p) {
        const Real reference = rule.at(p, xi);
        at(xi, reference);
      }
    };
    if (!assembly::has_tip(*mesh_, cell))
      return bubbles_of(cell).empty() ? visit_all(assembly::Quadrature<shape, order + 1>())
                                      : visit_all(assembly::BubbleQuadrature<shape>());
    if constexpr (order == 1) {
      patches_.tip_cell(cell)->for_each_reference_point(at);
    } else {
      Real X[n_nodes][dim];
      assembly::gather_host<shape>(*mesh_, cell, X);
      visit_all(assembly::CurvedQuadrature<shape, 4>(X));
    }
  }

  void find_bubbles() {
    for (const auto& [f, side] : assembly::fracture_sides(*mesh_)) {
      const auto& face = mesh_->fracture_faces[f];
      const LocalIndex cell = face.cell[side];
      bubbles_[cell].push_back({face.local_face[side], (f * 2 + side) * dim,
                                bubble_stiffness<shape>(*mesh_, cell, face.local_face[side], law(cell))});
    }
    for (auto& [cell, bubbles] : bubbles_)
      for (auto& b : bubbles) b.stiffness *= static_cast<Real>(bubbles.size());
  }
  const std::vector<Bubble>& bubbles_of(LocalIndex cell) const {
    static const std::vector<Bubble> none;
    const auto found = bubbles_.find(cell);
    return found == bubbles_.end() ? none : found->second;
  }

  /// Fits the functions of the patches to the stress of a displacement.
  Fits fitted(const Displacement& u) const {
    Fits result(patches_.size());
    for (LocalIndex c = 0; c < mesh_->n_cells(); ++c)
      patches_.for_each_sample(c, [&](const Point& point) {
        Values s = stress(c, point, u);
        const Values bulge = stress_of(c, bubble_strain(c, point, u));
        for (int k = 0; k < Tensor::n; ++k) s[k] += bulge[k];
        patches_.for_each_patch(c, [&](int p) { patches_.functions(c, p, point).add(s, 1, result[p]); });
      });
    patches_.solve(result);
    return result;
  }

  /// Computes |s* - s_h|^2, |s*|^2 and the volume of a cell. With d = s* - s_h - s_b, adds the moments of C^-1 d with
  /// the functions of the patches, and the forces - integral d : eps(v). The forces on bubbles are
  ///   - integral (s* - s_h) : eps(v) + alpha beta.
  void add_cell(LocalIndex c, const Displacement& u, const Fits& fit, Fits& moments, const Forces& to,
                Real (&square)[3]) const {
    const auto& bubbles = bubbles_of(c);
    for (const auto& b : bubbles)
      for (int i = 0; i < dim; ++i) to[bubble](b.unknown + i, 0) += b.stiffness * u[bubble](b.unknown + i, 0);
    for_each_point(c, [&](const Point& point, Real volume, const std::array<Real, n_corners>& weight) {
      std::array<typename Patches::Functions, n_corners> f;
      Values recovered{}, difference;
      const Values s = stress(c, point, u);
      for (int k = 0; k < n_corners; ++k)
        if (const int p = patches_.patch(c, k); weight[k] > 0) {
          f[k] = patches_.functions(c, p, point);
          f[k].evaluate(fit[p], weight[k], recovered);
        }
      for (int k = 0; k < Tensor::n; ++k) difference[k] = recovered[k] - s[k];
      square[0] += volume * Tensor::product(difference, strain_of(c, difference));
      square[1] += volume * Tensor::product(recovered, strain_of(c, recovered));
      square[2] += volume;
      add_bubble_forces(c, point, difference, -volume, to);
      const Values bulge = bubble_strain(c, point, u);
      Values strain = strain_of(c, difference);
      for (int k = 0; k < Tensor::n; ++k) strain[k] -= bulge[k];
      for (int k = 0; k < n_corners; ++k)
        if (const int p = patches_.patch(c, k); weight[k] > 0) f[k].add(strain, volume * weight[k], moments[p]);
      add_forces(c, point, stress_of(c, strain), -volume, to);
    });
  }

  /// Adds the forces integral (s* - s_h) : C^-1 s(v)* for solved moments.
  void add_recovered(LocalIndex c, const Fits& moments, const Forces& to) const {
    patches_.for_each_sample(c, [&](const Point& point) {
      Values strain{};
      patches_.for_each_patch(c, [&](int p) { patches_.functions(c, p, point).evaluate(moments[p], 1, strain); });
      add_forces(c, point, stress_of(c, strain), 1, to);
      add_bubble_forces(c, point, stress_of(c, strain), 1, to);
    });
  }

  RCP<const mesh::Mesh> mesh_;
  ByField<const fields::Layout*> layouts_;
  fields::Properties<laws::Elasticity> elasticity_;
  Patches patches_;
  std::unordered_map<LocalIndex, std::vector<Bubble>> bubbles_;  // of local cells
};

}  // namespace

std::unique_ptr<StressRecovery> make_stress_recovery(RCP<const mesh::Mesh> mesh,
                                                     const ByField<const fields::Layout*>& layouts,
                                                     fields::Properties<laws::Elasticity> elasticity) {
  const Shape shape = mesh->shape;
  return mesh::for_shape(shape, [&](auto s) -> std::unique_ptr<StressRecovery> {
    return std::make_unique<Recovery<s()>>(mesh, layouts, std::move(elasticity));
  });
}

}  // namespace sprekk::physics
