#include "transport/hybrid_error.hpp"

#include "base/check.hpp"
#include "base/over_ranks.hpp"
#include "transport/hybrid_places.hpp"
#include "transport/transposed_form.hpp"

namespace sprekk::transport {

namespace {

template <Shape shape>
class Error final : public HybridError, PlaceSums {
 public:
  using Grid = HybridPlaces<shape>;
  using Flux = typename Grid::Flux;
  static constexpr int dim = Flux::dim, n = Flux::n;
  using InCell = typename Flux::InCell;
  using InFace = typename Flux::InFace;

  Error(RCP<const mesh::Mesh> mesh, const fields::Layout& cells, const fields::Layout& facets,
        ConstView<char*> constrained_facets, HybridErrorParameters parameters)
      : grid_(mesh, cells, facets, constrained_facets, std::move(parameters.flow)),
        storage_(std::move(parameters.storage)) {
    find_before();
    for (LocalIndex c = 0; varies() && c < grid_.mesh->n_owned_cells; ++c)
      grid_.cell_of_component.insert(grid_.cell_of_component.end(), n, c);
  }

  const std::vector<LocalIndex>& cells() const override { return grid_.cell_of_component; }
  std::size_t n_of_energy() const override { return grid_.n_of_energy; }

  Parts of_state(const fields::Vector& cells, const fields::Vector& facets, Real t,
                 const assembly::Rates& rates) override {
    auto [result, s] = parts(Potentials(grid_.flow.layouts(), rock().fluid, {&cells, &facets}), t, &sums_);
    if (varies()) base::collectively(*grid_.mesh->comm, [&] { add_rates(s, t, rates, result); });
    return result;
  }
  Parts of_linearized(const fields::Vector& cells, const fields::Vector& facets, const fields::Vector& d_cells,
                      const fields::Vector& d_facets) const override {
    auto [result, s] =
        parts(Potentials(grid_.flow.layouts(), rock().fluid, {&cells, &facets}, {&d_cells, &d_facets}), 0, nullptr);
    for (LocalIndex c = 0; varies() && c < grid_.mesh->n_owned_cells; ++c)
      for (const Real one : variation(c, s)) result.error.push_back(one);
    result.whole.resize(result.error.size(), 0);
    return result;
  }

  Forces forces(const std::vector<Real>& e) const override {
    TransposedForm<shape> of(grid_, sums_);
    auto next = e.begin();
    for (LocalIndex c = 0; c < grid_.mesh->n_owned_cells; ++c) of.add_entity(grid_.cells[c], of.in_cells[c], next);
    for (LocalIndex f = 0; f < grid_.mesh->n_owned_fracture_faces; ++f)
      of.add_entity(grid_.faces[f], of.in_faces[f], next);
    for (const auto& side : grid_.sides)
      if (side.resistance > 0) of.add_side(side, next);
    for (const auto& [f, distance] : grid_.flow.parameters().fed) of.add_well(f, distance, next);
    for (const auto& face : grid_.constrained_faces)
      if (Grid::is_mean(face.of)) ++next;
    for (LocalIndex c = 0; varies() && c < grid_.mesh->n_owned_cells; ++c) of.add_variation(c, next);
    return of.forces();
  }
  void set_transmissivity(FaceTransmissivity present) override { grid_.set_transmissivity(std::move(present)); }

 private:
  using Of = Potentials::Of;
  using Side = typename Grid::Side;

  const HybridDiffusionParameters& rock() const { return grid_.rock(); }

  /// Results of SimplexFlux::flux().
  struct Components {
    std::vector<typename InCell::Components> in_cells;
    std::vector<typename InFace::Components> in_faces;
  };

  /// Adds the weighted values of an entity at its places.
  template <class Entity, class AtPlaces>
  static void add(const Entity& entity, const AtPlaces& p, Sums& sums) {
    for (std::size_t k = 0; k < p.size(); ++k) {
      auto& sum = sums[entity.place[k]];
      sum[weight] += entity.weight;
      sum[weighted] += entity.weight * p[k];
    }
  }

  /// Prescribed values at the places with prescribed potentials. Throws an Error if an expression has no value.
  std::vector<Real> values_of_constrained(const Potentials& u, Real t) const {
    std::vector<Real> given;
    for (const auto& face : grid_.constrained_faces)
      for (std::size_t k = face.begin; k < face.end; ++k)
        given.push_back(u.is_linearized()
                            ? u(Of::facet, grid_.constrained_places[k].facet)
                            : u.of_pressure(grid_.flow.prescribed(face.of, grid_.constrained_places[k].x, t)));
    return given;
  }

  /// Returns the components and s at all places. `saved`: receives the sums; may be null. Collective.
  std::pair<Parts, std::vector<Real>> parts(const Potentials& u, Real t, Sums* saved) const {
    Sums sums(grid_.places.size());
    std::vector<typename InCell::Flows> in_cells;
    std::vector<typename InFace::Flows> in_faces;
    for (LocalIndex c = 0; c < grid_.mesh->n_owned_cells; ++c) {
      in_cells.push_back(grid_.flow.in_cell(c, u));
      add(grid_.cells[c], grid_.cells[c].flux.potential(in_cells.back(), u(Of::cell, c), weight_in_cell(c, u)), sums);
    }
    for (LocalIndex f = 0; f < grid_.mesh->n_owned_fracture_faces; ++f) {
      in_faces.push_back(grid_.flow.in_face(f, u));
      add(grid_.faces[f],
          grid_.faces[f].flux.potential(in_faces.back(), u(Of::facet, grid_.mesh->facets->fracture_face[f]),
                                        weight_in_face(f, u)),
          sums);
    }
    for (const auto& side : grid_.sides) {
      const Real q = in_cells[side.cell][Flux::opposite(side.local_face)],
                 drop = side.resistance * q / grid_.area(side);
      for (std::size_t k = 0; side.resistance > 0 && k < side.of_cell.size(); ++k) {
        auto& sum = sums[side.of_cell[k]];
        ++sum[sides];
        sum[springs] += side.spring;
        sum[drops] += side.spring * drop;
      }
    }
    std::vector<Real> given;
    base::collectively(*grid_.mesh->comm, [&] { given = values_of_constrained(u, t); });
    for (std::size_t k = 0; k < grid_.constrained_places.size(); ++k) {
      if (!grid_.constrained_places[k].holds) continue;
      auto& sum = sums[grid_.constrained_places[k].place];
      ++sum[constrained];
      sum[constrained_values] += given[k];
    }
    grid_.places.sum_over_ranks(sums);
    if (saved) *saved = sums;
    auto s = common_potential(sums);
    Components fluxes;
    for (LocalIndex c = 0; c < grid_.mesh->n_owned_cells; ++c)
      fluxes.in_cells.push_back(grid_.cells[c].flux.flux(in_cells[c], weight_in_cell(c, u)));
    for (LocalIndex f = 0; f < grid_.mesh->n_owned_fracture_faces; ++f)
      fluxes.in_faces.push_back(grid_.faces[f].flux.flux(in_faces[f], weight_in_face(f, u)));
    for (int k = 0; k < Grid::n_sweeps; ++k) improve(fluxes, in_cells, sums, s);
    auto result = errors(u, fluxes, in_cells, in_faces, sums, s);
    for (const auto& face : grid_.constrained_faces) {
      if (!Grid::is_mean(face.of)) continue;
      const Real q = face.of.in_rock ? in_cells[face.of.entity][Flux::opposite(face.of.end)]
                                     : in_faces[face.of.entity][Flux::opposite_ridge(face.of.end)];
      Real missed = -u(Of::facet, grid_.constrained_places[face.begin].facet);
      for (std::size_t k = face.begin; k < face.end; ++k) missed += grid_.constrained_places[k].share * given[k];
      result.error.push_back(u.is_linearized() ? -q : missed);
      result.whole.push_back(0);
    }
    return {std::move(result), std::move(s)};
  }

  /// Returns whether the net source may vary within cells.
  bool varies() const { return !storage_.empty() || !rock().source.empty(); }
  typename InCell::Flows variation(LocalIndex c, const std::vector<Real>& s) const {
    const auto of_cell = Grid::at(s, grid_.cells[c].place);
    return grid_.cells[c].flux.variation([&](const auto&, const auto& l) { return InCell::quadratic(of_cell, l); });
  }
  /// Appends the variation of the storage rate minus the source.
  void add_rates(const std::vector<Real>& s, Real t, const assembly::Rates& rates, Parts& parts) {
    const auto stored = std::move(before_);
    const auto& older = stored[1].empty() ? stored[0] : stored[1];
    before_[0].clear();
    before_[1] = stored[0];
    for (LocalIndex c = 0; c < grid_.mesh->n_owned_cells; ++c) {
      typename InCell::Flows rate{};
      if (!rock().source.empty())
        rate = grid_.cells[c].flux.variation([&](const auto& x, const auto&) { return -rock().source[0](x, t); });
      const auto now = variation(c, s);
      for (int k = 0; !stored[0].empty() && k < n; ++k)
        rate[k] +=
            storage_[c] * (rates.now * (now[k] - stored[0][c][k]) - rates.before * (stored[0][c][k] - older[c][k]));
      if (!stored[0].empty()) before_[0].push_back(now);
      parts.error.insert(parts.error.end(), rate.begin(), rate.end());
    }
    parts.whole.resize(parts.error.size(), 0);
  }
  /// Stores the variation of the initial potential. Collective.
  void find_before() {
    base::collectively(*grid_.mesh->comm, [&] {
      for (LocalIndex c = 0; !storage_.empty() && c < grid_.mesh->n_owned_cells; ++c)
        before_[0].push_back(grid_.cells[c].flux.variation([&](const auto& x, const auto&) {
          return rock().initial ? potential_of(rock().fluid, (*rock().initial)(x, 0)) : 0;
        }));
    });
  }

  /// Computes s at all places, see HybridError. Collective.
  std::vector<Real> common_potential(const Sums& sums) const {
    constexpr Real fixed = 1e15;                            // relative weight of prescribed values
    std::vector<std::array<Real, 2>> of_rock(sums.size());  // rock's part of means: weight, weighted value
    const auto own = [&](int place) {
      const auto& sum = sums[place];
      if (sum[constrained] == 0) return std::array{sum[weight], sum[weighted] / sum[weight]};
      return std::array{fixed * (sum[weight] + sum[springs]), sum[constrained_values] / sum[constrained]};
    };
    for (const auto& side : grid_.sides)
      for (std::size_t k = 0; k < side.of_cell.size(); ++k) {
        if (!Grid::is_apart(side, k)) continue;
        const auto& sum = sums[side.of_cell[k]];
        const auto [w, value] = own(side.of_cell[k]);
        const Real share = w * sum[springs] / (w + sum[springs]) / sum[sides];
        auto& of = of_rock[side.of_face[k]];
        of[0] += share;
        of[1] += share * (value - sum[drops] / sum[springs]);
      }
    grid_.places.sum_over_ranks(of_rock);
    std::vector<Real> s(sums.size());
    for (std::size_t p = 0; p < s.size(); ++p) {
      const auto [w, value] = own(static_cast<int>(p));
      s[p] = (w * value + of_rock[p][1]) / (w + of_rock[p][0]);
    }
    std::vector<std::array<Real, 2>> beside_fractures(s.size());  // values in rock: sum over sides, number of sides
    for (const auto& side : grid_.sides)
      for (std::size_t k = 0; k < side.of_cell.size(); ++k) {
        if (!Grid::is_apart(side, k)) continue;
        const auto& sum = sums[side.of_cell[k]];
        const auto [w, value] = own(side.of_cell[k]);
        const Real c = sum[springs], beside = s[side.of_face[k]];
        auto& of = beside_fractures[side.of_cell[k]];
        of[0] += sum[constrained] > 0 ? value : (w * value + c * beside + sum[drops]) / (w + c);
        ++of[1];
      }
    grid_.places.sum_over_ranks(beside_fractures);  // a cell may touch a fracture with one corner only
    for (std::size_t p = 0; p < s.size(); ++p)
      if (beside_fractures[p][1] > 0) s[p] = beside_fractures[p][0] / beside_fractures[p][1];
    return s;
  }

  /// Performs one Jacobi step towards the s of least energy. Collective.
  void improve(const Components& fluxes, const std::vector<typename InCell::Flows>& in_cells, const Sums& sums,
               std::vector<Real>& s) const {
    typename Grid::Numbers slopes(s.size());
    const auto add = [&](const auto& entity, const auto& flux) {
      const auto of = entity.flux.gradients();
      const auto error = entity.flux.error(flux, of, Grid::at(s, entity.place));
      for (std::size_t k = 0; k < of.size(); ++k) slopes[entity.place[k]][0] += Grid::product(of[k], error);
    };
    for (std::size_t c = 0; c < grid_.cells.size(); ++c) add(grid_.cells[c], fluxes.in_cells[c]);
    for (std::size_t f = 0; f < grid_.faces.size(); ++f) add(grid_.faces[f], fluxes.in_faces[f]);
    grid_.for_each_point_of_sides([&](const Side& side, Real spring, const auto& N) {
      const Real q = in_cells[side.cell][Flux::opposite(side.local_face)] / grid_.area(side);
      const Real error = Grid::product(Grid::at(s, side.of_cell), N) - Grid::product(Grid::at(s, side.of_face), N) -
                         side.resistance * q;
      for (std::size_t k = 0; k < N.size(); ++k) {
        slopes[side.of_cell[k]][0] += spring * error * N[k];
        slopes[side.of_face[k]][0] -= spring * error * N[k];
      }
    });
    grid_.places.sum_over_ranks(slopes);
    for (std::size_t p = 0; p < s.size(); ++p)
      if (sums[p][constrained] == 0 && grid_.stiffness[p][0] > 0)
        s[p] -= Grid::relaxation * slopes[p][0] / grid_.stiffness[p][0];
  }

  Parts errors(const Potentials& u, const Components& fluxes, const std::vector<typename InCell::Flows>& in_cells,
               const std::vector<typename InFace::Flows>& in_faces, const Sums& sums,
               const std::vector<Real>& s) const {
    Parts result;
    const auto put = [](std::vector<Real>& all, const auto& some) { all.insert(all.end(), some.begin(), some.end()); };
    const auto add = [&](const auto& entity, const auto& flux, const auto& q) {
      put(result.error, entity.flux.error(flux, entity.flux.gradients(), Grid::at(s, entity.place)));
      put(result.whole, entity.flux.flux(q, {}));
    };
    for (std::size_t c = 0; c < grid_.cells.size(); ++c) add(grid_.cells[c], fluxes.in_cells[c], in_cells[c]);
    for (std::size_t f = 0; f < grid_.faces.size(); ++f) add(grid_.faces[f], fluxes.in_faces[f], in_faces[f]);
    for (const auto& side : grid_.sides)
      if (side.resistance > 0)
        add_side(side, in_cells[side.cell][Flux::opposite(side.local_face)] / grid_.area(side), s, result);
    for (const auto& [f, distance] : grid_.flow.parameters().fed)
      add_well(f, distance, in_faces[f], u.is_linearized(), result.error);
    result.whole.resize(result.error.size(), 0);
    return result;
  }

  /// Adds the components of a fracture face with a well at a distance from its centre (2D), one for each end.
  void add_well(LocalIndex f, Real distance, const typename InFace::Flows& q, bool is_linearized,
                std::vector<Real>& error) const {
    const Real factor = std::sqrt(std::abs(distance) / grid_.flow.parameters().transmissivity[f]);
    for (int end = 0; end < 2; ++end)
      error.push_back((is_linearized && grid_.nearer(f, end, distance) < 0 ? -1 : 1) * factor *
                      q[Flux::opposite_ridge(end)]);
  }

  void add_side(const Side& side, Real q, const std::vector<Real>& s, Parts& parts) const {
    const auto in_cell = Grid::at(s, side.of_cell), in_face = Grid::at(s, side.of_face);
    for (int p = 0; p < Grid::n_face_points; ++p) {
      std::array<Real, dim> l{};
      const Real share = Grid::face_point(p, l);
      const Real factor = std::sqrt(share * grid_.area(side) * side.resistance);
      const Real jump = InFace::quadratic(in_cell, l) - InFace::quadratic(in_face, l);
      parts.error.push_back(factor * (q - jump / side.resistance));
      parts.whole.push_back(factor * q);
    }
  }

  typename InCell::Weight weight_in_cell(LocalIndex c, const Potentials& u) const {
    typename InCell::Weight w{};
    for (int i = 0; i < dim; ++i) w[i] = rock().weight[i] * u.heaviness(Of::cell, c);
    return w;
  }
  typename InFace::Weight weight_in_face(LocalIndex f, const Potentials& u) const {
    typename InFace::Weight w{};
    const auto& face = grid_.mesh->fracture_faces[f];
    for (int t = 0; t < dim - 1; ++t)
      for (int i = 0; i < dim; ++i)
        w[t] += rock().weight[i] * face.frame[1 + t][i] * u.heaviness(Of::facet, grid_.mesh->facets->fracture_face[f]);
    return w;
  }

  Grid grid_;
  std::vector<Real> storage_;  // see HybridErrorParameters
  /// [owned cell] variation of the potential in the last two states; before the first step only the initial one
  std::array<std::vector<typename InCell::Flows>, 2> before_;
  Sums sums_;  // of the last state
};

}  // namespace

std::unique_ptr<HybridError> make_hybrid_error(RCP<const mesh::Mesh> mesh, const fields::Layout& cells,
                                               const fields::Layout& facets, ConstView<char*> constrained_facets,
                                               HybridErrorParameters parameters) {
  SPREKK_CHECK(mesh::is_simplex(mesh->shape), "the estimate of the error of flow is of triangles and tetrahedra");
  return mesh::for_corners(mesh->shape, [&](auto shape) -> std::unique_ptr<HybridError> {
    if constexpr (mesh::is_simplex(shape()))
      return std::make_unique<Error<shape()>>(mesh, cells, facets, constrained_facets, std::move(parameters));
    else
      return nullptr;
  });
}

}  // namespace sprekk::transport
