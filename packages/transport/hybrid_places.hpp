// Places of the reconstructed potential of the hybrid form: corners and midpoints of edges in rock and fractures.
#pragma once

#include "base/over_ranks.hpp"
#include "mesh/union_find.hpp"
#include "transport/hybrid_flux.hpp"
#include "transport/places.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <unordered_map>
#include <utility>
#include <vector>

namespace sprekk::transport {

/// Sums at a place, over the surrounding cells, faces and sides.
struct PlaceSums {
  enum Sum { weight, weighted, constrained, constrained_values, springs, drops, sides, n_sums };
  using Sums = std::vector<std::array<Real, n_sums>>;
};

/// Entities with the places at which the potential s of HybridError is computed, and the components of the error. In 3D
/// nothing flows through a single point. Fractures that share only a point therefore have different places there, and a
/// fracture that touches the boundary in a point is not constrained by the rock. Refers to the layouts.
template <Shape shape>
struct HybridPlaces {
  using Flux = HybridFlux<shape>;
  static constexpr int dim = Flux::dim, n = Flux::n;
  using InCell = typename Flux::InCell;
  using InFace = typename Flux::InFace;
  using Numbers = std::vector<std::array<Real, 1>>;
  static constexpr int n_sweeps = 5;       // Jacobi steps
  static constexpr Real relaxation = 1.5;  // stable below 2

  /// Data of a cell or a fracture face.
  template <class In>
  struct Entity {
    In flux;
    std::array<int, In::n_places> place;
    Real weight;  // weight in means: mobility times size^(dim - 2)
  };
  /// Side of a fracture face in an owned cell.
  struct Side {
    LocalIndex face, cell;
    int local_face;
    std::array<int, dim> corner;                         // corners of the cell, in the order of the face corners
    std::array<int, InFace::n_places> of_cell, of_face;  // places, in the order of the face places
    Real resistance;                                     // R, Pa s/m; 0: none
    Real spring;                                         // area / R
  };
  /// Place with a prescribed potential.
  struct ConstrainedPlace {
    int place;
    mesh::Vector x;
    LocalIndex facet;
    Real share;  // weight in the mean over its face
    bool holds;  // false: corner of a rock face at a fracture, which only rims of the fracture constrain
  };
  /// End with a prescribed potential. Its places are constrained_places[begin] to constrained_places[end - 1].
  struct ConstrainedFace {
    typename Flux::Constrained of;
    std::size_t begin, end;
  };

  RCP<const mesh::Mesh> mesh;
  Flux flow;
  Places places;
  std::vector<Entity<InCell>> cells;
  std::vector<Entity<InFace>> faces;
  std::vector<Side> sides;
  Numbers stiffness;  // [place] scaling of Jacobi steps
  std::vector<ConstrainedPlace> constrained_places;
  std::vector<ConstrainedFace> constrained_faces;
  std::vector<LocalIndex> cell_of_component;
  std::size_t n_of_energy = 0;  // leading components of the energy

  /// Collective.
  HybridPlaces(RCP<const mesh::Mesh> in, const fields::Layout& of_cells, const fields::Layout& of_facets,
               ConstView<char*> constrained_facets, HybridFluxParameters parameters)
      : mesh(in), flow(in, {&of_cells, &of_facets}, std::move(parameters)) {
    find_cells();
    find_contacts_at_points();
    find_faces();
    find_sides();
    join_places();
    n_of_energy = cell_of_component.size();
    for (const auto& [f, distance] : flow.parameters().fed)
      cell_of_component.insert(cell_of_component.end(), 2, mesh->fracture_faces[f].cell[mesh::minus]);
    find_constrained(constrained_facets);
    places.close(mesh->comm);
    find_stiffness();
  }
  void set_transmissivity(FaceTransmissivity present) {
    flow.set_transmissivity(std::move(present));
    for (LocalIndex f = 0; f < mesh->n_owned_fracture_faces; ++f) {
      faces[f].flux = flow.face(f).flux;
      faces[f].weight = weight_of_face(f);
    }
    find_stiffness();
  }
  const HybridDiffusionParameters& rock() const { return flow.parameters().rock; }

  /// Barycentric coordinates and weights of a quadrature rule, of degree 5 on edges and degree 4 on triangles.
  static constexpr int n_face_points = dim == 2 ? 3 : 6;
  static Real face_point(int p, std::array<Real, dim>& l) {
    if constexpr (dim == 2) {
      l = {(1 - assembly::Gauss<3>::point(p)) / 2, (1 + assembly::Gauss<3>::point(p)) / 2};
      return assembly::Gauss<3>::weight(p) / 2;
    } else {
      const Real a = p < 3 ? 0.445948490915965 : 0.091576213509771;
      l = {a, a, a};
      l[p % 3] = 1 - 2 * a;
      return p < 3 ? 0.223381589678011 : 0.109951743655322;
    }
  }

  template <std::size_t m>
  static std::array<Real, m> at(const std::vector<Real>& s, const std::array<int, m>& place) {
    std::array<Real, m> values{};
    for (std::size_t k = 0; k < m; ++k) values[k] = s[place[k]];
    return values;
  }
  Real area(const Side& side) const { return mesh->fracture_faces[side.face].area; }
  /// Distance by which a well is nearer to an end of a face than the face centre is; negative: farther.
  Real nearer(LocalIndex f, int end, Real distance) const {
    Real towards = 0;
    for (int i = 0; i < dim; ++i) towards += flow.face(f).plane.d[end][i] * mesh->fracture_faces[f].frame[1][i];
    return towards > 0 ? distance : -distance;
  }
  /// Returns whether place k of a side has different values in fracture and rock.
  static bool is_apart(const Side& side, std::size_t k) {
    return side.resistance > 0 && side.of_cell[k] != side.of_face[k];
  }
  template <std::size_t m>
  static Real product(const std::array<Real, m>& a, const std::array<Real, m>& b) {
    Real sum = 0;
    for (std::size_t k = 0; k < m; ++k) sum += a[k] * b[k];
    return sum;
  }

  /// Calls visit(side, area of the point divided by R, shape functions) at the quadrature points of sides with
  /// resistance.
  template <class Visit>
  void for_each_point_of_sides(const Visit& visit) const {
    for (const auto& side : sides)
      for (int p = 0; side.resistance > 0 && p < n_face_points; ++p) {
        std::array<Real, dim> l{};
        const Real share = face_point(p, l);
        visit(side, share * side.spring, InFace::shapes(l));
      }
  }

  /// Returns whether the facet unknown is a mean over the end, i.e. whether the end is not a point.
  static bool is_mean(const typename Flux::Constrained& constrained) { return constrained.in_rock || dim == 3; }

 private:
  /// Global numbers of places: rock nodes; midpoints of rock edges; fracture points; midpoints of fracture edges; in 2D
  /// also midpoints of fracture sides, because nodes do not distinguish the two sides.
  GlobalIndex rock_place(GlobalIndex a, GlobalIndex b) const {
    return a == b ? a : mesh->n_global_nodes * (1 + std::min(a, b)) + std::max(a, b);
  }
  GlobalIndex first_of_fractures() const { return mesh->n_global_nodes * (1 + mesh->n_global_nodes); }
  GlobalIndex fracture_place(GlobalIndex a, GlobalIndex b) const { return first_of_fractures() + rock_place(a, b); }
  GlobalIndex side_place(GlobalIndex face, int side) const { return 2 * first_of_fractures() + 2 * face + side; }
  /// In 3D, place at a corner with several groups of faces that no ridge connects: that of the group with the lowest
  /// ridge `first`.
  GlobalIndex split_place(GlobalIndex corner, GlobalIndex first) const {
    return 2 * first_of_fractures() + first * mesh->n_global_nodes + corner;
  }
  bool is_of_fracture(int place) const { return places.id(place) >= first_of_fractures(); }
  bool is_split(int place) const { return dim == 3 && places.id(place) >= 2 * first_of_fractures(); }

  void find_cells() {
    for (LocalIndex c = 0; c < mesh->n_owned_cells; ++c) {
      const auto& flux = flow.cell(c).flux;
      const auto& mobility = rock().mobility.of_cell(*mesh, c);
      Entity<InCell> cell{flux, {}, mobility.template trace<dim>() / dim * std::pow(flux.volume(), 1 - 2.0 / dim)};
      for (int a = 0; a < n; ++a)
        for (int b = a; b < n; ++b) cell.place[InCell::place(a, b)] = place_between(c, a, b);
      cells.push_back(cell);
      cell_of_component.insert(cell_of_component.end(), InCell::n_components, c);
    }
  }
  /// Place between two corners of a cell.
  int place_between(LocalIndex c, int a, int b) {
    const auto id = [&](int k) { return mesh->node_id[mesh->free_node(flow.node(c, k))]; };
    return places.add(rock_place(id(a), id(b)));
  }

  std::array<int, InFace::n_places> places_of_face(LocalIndex f) {
    const auto& corners = mesh->fracture_faces[f].corners;
    std::array<int, InFace::n_places> place{};
    for (int a = 0; a < dim; ++a)
      for (int b = a; b < dim; ++b) place[InFace::place(a, b)] = places.add(fracture_place(corners[a], corners[b]));
    for (int a = 0; a < dim && dim == 3; ++a)
      if (const auto found = split_.find({corners[a], ridge(f, a)}); found != split_.end())
        place[InFace::place(a, a)] = places.add(split_place(corners[a], found->second));
    return place;
  }
  GlobalIndex ridge(LocalIndex f, int k) const { return mesh->facets->id[flow.facet_of_face(f, k)]; }

  /// Finds groups of faces at a corner that no ridge connects. Each group except the first gets its own place. Faces of
  /// any rank may touch the corner, so the ridges are gathered over all ranks. Collective.
  void find_contacts_at_points() {
    if (dim == 2) return;
    std::vector<GlobalIndex> all;  // corner of a face, its two ridges there
    for (LocalIndex f = 0; f < mesh->n_owned_fracture_faces; ++f)
      for (int k = 0; k < dim; ++k)
        all.insert(all.end(), {mesh->fracture_faces[f].corners[k], ridge(f, k), ridge(f, (k + dim - 1) % dim)});
    all = base::gather_over_ranks(*mesh->comm, all);
    std::vector<std::pair<GlobalIndex, GlobalIndex>> ends;  // (corner, ridge)
    for (std::size_t k = 0; k < all.size(); k += 3)
      for (const GlobalIndex one : {all[k + 1], all[k + 2]}) ends.emplace_back(all[k], one);
    std::sort(ends.begin(), ends.end());
    ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
    const auto number = [&](GlobalIndex corner, GlobalIndex one) {
      return std::lower_bound(ends.begin(), ends.end(), std::pair(corner, one)) - ends.begin();
    };
    mesh::UnionFind groups(static_cast<GlobalIndex>(ends.size()));
    for (std::size_t k = 0; k < all.size(); k += 3) groups.join(number(all[k], all[k + 1]), number(all[k], all[k + 2]));
    for (std::size_t k = 0, first = 0; k < ends.size(); ++k) {
      if (ends[k].first != ends[first].first) first = k;  // first end at this corner
      const auto group = groups.find(static_cast<GlobalIndex>(k));
      if (group != static_cast<GlobalIndex>(first)) split_[ends[k]] = ends[group].second;
    }
  }

  void find_faces() {
    for (LocalIndex f = 0; f < mesh->n_owned_fracture_faces; ++f) {
      faces.push_back({flow.face(f).flux, places_of_face(f), weight_of_face(f)});
      cell_of_component.insert(cell_of_component.end(), InFace::n_components,
                               mesh->fracture_faces[f].cell[mesh::minus]);
    }
  }
  Real weight_of_face(LocalIndex f) const {
    return flow.parameters().transmissivity[f] * std::pow(mesh->fracture_faces[f].area, 1 - 2.0 / (dim - 1));
  }

  void find_sides() {
    for (const auto& [f, s] : assembly::fracture_sides(*mesh)) {
      const auto& face = mesh->fracture_faces[f];
      const LocalIndex c = face.cell[s];
      if (c >= mesh->n_owned_cells) continue;
      Side side{
          f, c, face.local_face[s], {}, {}, places_of_face(f), 1 / flow.exchange(f), face.area * flow.exchange(f)};
      for (int k = 0; k < dim; ++k)
        for (int a = 0; a < n; ++a)
          if (flow.node(c, a) == face.nodes[s][k]) side.corner[k] = a;
      if (dim == 2) cells[c].place[InCell::place(side.corner[0], side.corner[1])] = places.add(side_place(face.id, s));
      sides.push_back(side);
      if (side.resistance == 0) continue;
      cell_of_component.insert(cell_of_component.end(), n_face_points, c);
    }
  }

  /// Identifies the places of rock and fracture on sides without resistance. Cells of any rank may touch these places
  /// with a corner, so the pairs are gathered over all ranks. Collective.
  void join_places() {
    std::vector<GlobalIndex> joined;  // pairs: place of the rock, place of the fracture
    const auto for_each_pair = [](const auto& visit) {
      for (int a = 0; a < dim; ++a)
        for (int b = a; b < dim; ++b) visit(a, b, InFace::place(a, b));
    };
    for (const auto& side : sides)
      for_each_pair([&](int a, int b, int k) {
        if (side.resistance > 0 || is_split(side.of_face[k])) return;
        const int in_cell = cells[side.cell].place[InCell::place(side.corner[a], side.corner[b])];
        joined.insert(joined.end(), {places.id(in_cell), places.id(side.of_face[k])});
      });
    joined = base::gather_over_ranks(*mesh->comm, joined);
    std::unordered_map<GlobalIndex, GlobalIndex> of_fracture;
    for (std::size_t k = 0; k < joined.size(); k += 2) of_fracture[joined[k]] = joined[k + 1];
    for (auto& cell : cells)
      for (int& place : cell.place)
        if (const auto found = of_fracture.find(places.id(place)); found != of_fracture.end())
          place = places.add(found->second);
    for (auto& side : sides)
      for_each_pair([&](int a, int b, int k) {
        side.of_cell[k] = cells[side.cell].place[InCell::place(side.corner[a], side.corner[b])];
      });
  }

  /// Computes the Jacobi scaling of each place: the sum of the absolute second derivatives of half of the energy. It
  /// bounds the curvature of the scaled energy from above. Collective.
  void find_stiffness() {
    Numbers sums(places.size());
    const auto add = [&](const auto& entity) {
      const auto of = entity.flux.gradients();
      for (std::size_t i = 0; i < of.size(); ++i)
        for (std::size_t j = 0; j < of.size(); ++j) sums[entity.place[i]][0] += std::abs(product(of[i], of[j]));
    };
    for (const auto& cell : cells) add(cell);
    for (const auto& face : faces) add(face);
    for_each_point_of_sides([&](const Side& side, Real spring, const auto& N) {
      Real all = 0;
      for (const Real value : N) all += 2 * std::abs(value);
      for (std::size_t k = 0; k < N.size(); ++k)
        for (const int place : {side.of_cell[k], side.of_face[k]}) sums[place][0] += spring * std::abs(N[k]) * all;
    });
    places.sum_over_ranks(sums);
    stiffness = std::move(sums);
  }

  void find_constrained(ConstView<char*> constrained_facets) {
    for (const auto& constrained : flow.constrained(constrained_facets)) {
      const auto begin = constrained_places.size();
      for (const auto& point : flow.points(constrained)) {
        const int place = constrained.in_rock ? cells[constrained.entity].place[InCell::place(point.a, point.b)]
                                              : faces[constrained.entity].place[InFace::place(point.a, point.b)];
        const bool holds = !constrained.in_rock || dim == 2 || point.a != point.b || !is_of_fracture(place);
        constrained_places.push_back({place, point.x, constrained.facet, point.share, holds});
      }
      constrained_faces.push_back({constrained, begin, constrained_places.size()});
      if (is_mean(constrained))
        cell_of_component.push_back(constrained.in_rock ? constrained.entity
                                                        : mesh->fracture_faces[constrained.entity].cell[mesh::minus]);
    }
  }

  std::map<std::pair<GlobalIndex, GlobalIndex>, GlobalIndex> split_;  // [corner, ridge] first ridge of its group
};

}  // namespace sprekk::transport
