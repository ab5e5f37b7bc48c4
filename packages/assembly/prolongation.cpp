#include "assembly/prolongation.hpp"

#include "assembly/reference_cell.hpp"
#include "base/host_table.hpp"
#include "base/over_ranks.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>
#include <unordered_map>

namespace sprekk::assembly {

using fields::Entity;
using fields::Field;
using mesh::Mesh;
using mesh::operator+;
using mesh::operator-;
using mesh::operator*;
using mesh::cross;
using mesh::dot;
using mesh::norm;

namespace {

/// Entities at the places of each cell, [cell * n + place]; -1: none.
struct Places {
  int n;
  std::vector<LocalIndex> entity;
};

/// Places of facets: the faces of the cell, then the ridges of each face on a fracture, at the cell on side minus.
Places places_of_facets(const Mesh& mesh) {
  const int n_faces = mesh::n_faces(mesh.shape), n_ridges = mesh::n_face_corners(mesh.shape);
  const int n = n_faces * (1 + n_ridges);
  Places places{n, std::vector<LocalIndex>(std::size_t(mesh.n_cells()) * n, -1)};
  const auto& facets = *mesh.facets;
  for (LocalIndex c = 0; c < mesh.n_cells(); ++c)
    std::copy_n(&facets.of_cell[c * n_faces], n_faces, &places.entity[c * n]);
  for (LocalIndex f = 0; f < mesh.n_fracture_faces(); ++f) {
    const auto& face = mesh.fracture_faces[f];
    for (int side : {mesh::minus, mesh::plus})
      if (face.cell[side] >= 0) places.entity[face.cell[side] * n + face.local_face[side]] = facets.fracture_face[f];
    if (face.cell[mesh::minus] < 0) continue;
    const auto first = face.cell[mesh::minus] * n + n_faces + face.local_face[mesh::minus] * n_ridges;
    std::copy_n(&facets.ridge[f * n_ridges], n_ridges, &places.entity[first]);
  }
  return places;
}

Places places_of(const Mesh& mesh, Entity entity) {
  if (entity == Entity::facet) return places_of_facets(mesh);
  const int n_nodes = mesh.nodes_per_cell(), n_faces = mesh::n_faces(mesh.shape);
  const int n = entity == Entity::cell ? 1 : entity == Entity::fracture_face ? n_faces : n_nodes;
  Places places{n, std::vector<LocalIndex>(std::size_t(mesh.n_cells()) * n, -1)};
  if (entity == Entity::cell) {
    std::iota(places.entity.begin(), places.entity.end(), 0);
  } else if (entity == Entity::fracture_face) {
    for (LocalIndex f = 0; f < mesh.n_fracture_faces(); ++f)
      for (int side : {mesh::minus, mesh::plus})
        if (const auto c = mesh.fracture_faces[f].cell[side]; c >= 0)
          places.entity[c * n + mesh.fracture_faces[f].local_face[side]] = f;
  } else {
    for (std::size_t i = 0; i < places.entity.size(); ++i) {
      const LocalIndex node = mesh.free_node(mesh.cells[i]);
      places.entity[i] = entity == Entity::node ? node : mesh.enriched.empty() ? -1 : mesh.enriched[node];
    }
  }
  return places;
}

GlobalIndex whole_cell(const Mesh& mesh, LocalIndex cell) {
  return mesh.origin.is_null() ? mesh.cell_id[cell] : mesh.origin->cells[cell];
}

int opposite(int dim, int face) { return dim == 2 ? (face + 2) % 3 : face; }

/// Solves sum N_a(xi) X_a = x by Newton's method and returns N. `start`: barycentric coordinates in the straight cell.
template <mesh::Shape shape>
std::vector<Real> functions_at(const Real* nodes, const mesh::Vector& x, const std::array<Real, 4>& start) {
  using Cell = ReferenceCell<shape>;
  constexpr int dim = Cell::dim, n = Cell::n_nodes;
  Real X[n][dim], xi[dim], N[n], dN[n][dim];
  std::copy_n(nodes, n * dim, &X[0][0]);
  std::copy_n(&start[1], dim, xi);
  Cell::shape_functions(xi, N);
  for (int iteration = 0; Cell::order == 2 && iteration < 30; ++iteration) {
    Real off[dim] = {}, square = 0, size = 0;
    for (int i = 0; i < dim; ++i) {
      for (int a = 0; a < n; ++a) off[i] += N[a] * (X[a][i] - x[i]);
      square += off[i] * off[i];
      size += (X[1][i] - X[0][i]) * (X[1][i] - X[0][i]);
    }
    if (square <= 1e-28 * size) break;
    Cell::gradients(xi, dN);
    const CellPoint<shape> point(X, dN);
    for (int j = 0; j < dim; ++j)
      for (int i = 0; i < dim; ++i) xi[j] -= point.inverse[j][i] * off[i];
    Cell::shape_functions(xi, N);
  }
  return {N, N + n};
}

}  // namespace

Prolongation::Prolongation(const Mesh& coarse, const Mesh& fine, const std::vector<GlobalIndex>& parent,
                           const std::vector<mesh::Overlap>& overlaps)
    : coarse_(&coarse), fine_(&fine) {
  const auto comm = fine_->comm;
  std::vector<GlobalIndex> on_0(comm->getRank() == 0 ? parent.size() : 0), here;
  std::iota(on_0.begin(), on_0.end(), 0);
  for (LocalIndex c = 0; c < fine_->n_cells(); ++c) here.push_back(whole_cell(*fine_, c));
  fields::Vector all(fields::make_map(on_0, comm)), own(fields::make_map(here, comm));
  {
    const auto values = all.getLocalViewHost(Tpetra::Access::OverwriteAll);
    for (std::size_t c = 0; c < on_0.size(); ++c) values(c, 0) = static_cast<Real>(parent[c]);
  }
  own.doImport(all, fields::Import(all.getMap(), own.getMap()), Tpetra::REPLACE);
  const auto numbers = own.getLocalViewHost(Tpetra::Access::ReadOnly);
  for (std::size_t c = 0; c < here.size(); ++c) parents_.push_back(static_cast<GlobalIndex>(numbers(c, 0)));
  const auto of_cell = parents_;
  const auto in_parts = local_parts(overlaps, here);
  for (const auto& [cell, part] : in_parts) parents_.push_back(part.before);
  std::sort(parents_.begin(), parents_.end());
  parents_.erase(std::unique(parents_.begin(), parents_.end()), parents_.end());
  const auto index_of = [&](GlobalIndex id) {
    return static_cast<LocalIndex>(std::lower_bound(parents_.begin(), parents_.end(), id) - parents_.begin());
  };
  for (const auto id : of_cell) parent_.push_back(index_of(id));
  for (const auto& [cell, part] : in_parts)
    parts_[cell].push_back({index_of(part.before), part.area, {part.centre[0], part.centre[1], 0}});
  order_.resize(here.size());
  std::iota(order_.begin(), order_.end(), 0);
  std::sort(order_.begin(), order_.end(), [&](LocalIndex a, LocalIndex b) { return here[a] < here[b]; });

  const int n = coarse_->nodes_per_cell(), dim = coarse_->dim();
  std::vector<Real> coordinates, tips;
  for (LocalIndex i = 0; i < coarse_->n_owned_cells * n; ++i) {
    const LocalIndex node = coarse_->cells[i];
    coordinates.insert(coordinates.end(), &coarse_->coordinates[node * dim], &coarse_->coordinates[node * dim] + dim);
    tips.push_back(coarse_->tip.empty() ? 0 : coarse_->tip[node]);
  }
  coordinates_ = of_parents(coordinates, n * dim);
  tips_ = of_parents(tips, n);
}

/// Returns the overlaps of local fine cells, with these cells. `here`: numbers of the local cells.
std::vector<std::pair<LocalIndex, mesh::Overlap>> Prolongation::local_parts(const std::vector<mesh::Overlap>& overlaps,
                                                                            const std::vector<GlobalIndex>& here) {
  std::vector<Real> numbers;
  if (fine_->comm->getRank() == 0)
    for (const auto& one : overlaps)
      numbers.insert(numbers.end(), {Real(one.cell), Real(one.before), one.area, one.centre[0], one.centre[1]});
  numbers = base::of_rank(*fine_->comm, 0, numbers);
  has_overlaps_ = !numbers.empty();
  std::unordered_map<GlobalIndex, LocalIndex> local;
  for (std::size_t c = 0; c < here.size() && has_overlaps_; ++c) local[here[c]] = static_cast<LocalIndex>(c);
  std::vector<std::pair<LocalIndex, mesh::Overlap>> parts;
  for (std::size_t k = 0; k < numbers.size(); k += 5) {
    const auto cell = static_cast<GlobalIndex>(numbers[k]);
    if (const auto found = local.find(cell); found != local.end())
      parts.push_back(
          {found->second,
           {cell, static_cast<GlobalIndex>(numbers[k + 1]), numbers[k + 2], {numbers[k + 3], numbers[k + 4]}}});
  }
  return parts;
}

/// Returns the numbers of the parents, [parent * n + k], from those of owned coarse cells.
std::vector<Real> Prolongation::of_parents(const std::vector<Real>& of_cells, int n) const {
  std::vector<GlobalIndex> wanted;
  for (const auto parent : parents_)
    for (int k = 0; k < n; ++k) wanted.push_back(parent * n + k);
  fields::Vector from(fields::whole_map({"", Entity::cell, n, ""}, *coarse_)),
      to(fields::make_map(wanted, fine_->comm));
  {
    const auto values = from.getLocalViewHost(Tpetra::Access::OverwriteAll);
    for (std::size_t k = 0; k < of_cells.size(); ++k) values(k, 0) = of_cells[k];
  }
  to.doImport(from, fields::Import(from.getMap(), to.getMap()), Tpetra::REPLACE);
  const auto values = to.getLocalViewHost(Tpetra::Access::ReadOnly);
  std::vector<Real> result(wanted.size());
  for (std::size_t k = 0; k < result.size(); ++k) result[k] = values(k, 0);
  return result;
}

/// Returns the values of a field at the places of the parents, [(parent * places + place) * components + component].
std::vector<Real> Prolongation::table(const Field& field, const View<Real**>& values) const {
  const fields::Layout layout(field, *coarse_);
  fields::Vector owned(layout.owned()), with_ghosts(layout.ghosted());
  const int n = field.n_components;
  Kokkos::deep_copy(fields::by_entity(owned, n), values);
  with_ghosts.doImport(owned, *layout.import(), Tpetra::REPLACE);
  const auto all = with_ghosts.getLocalViewHost(Tpetra::Access::ReadOnly);
  const auto places = places_of(*coarse_, field.entity);
  std::vector<Real> of_cells;
  for (LocalIndex i = 0; i < coarse_->n_owned_cells * places.n; ++i)
    for (int k = 0; k < n; ++k) of_cells.push_back(places.entity[i] < 0 ? 0 : all(places.entity[i] * n + k, 0));
  return of_parents(of_cells, places.n * n);
}

/// Calls visit(entity, cell, place) until it returns true for each owned entity, in the order of the cells.
template <class Visit>
void Prolongation::for_each_place(Entity entity, const Visit& visit) const {
  const auto places = places_of(*fine_, entity);
  const LocalIndex n_owned = fields::n_entities(*fine_, entity, false);
  std::vector<char> done(n_owned, 0);
  for (const LocalIndex cell : order_)
    for (int k = 0; k < places.n; ++k)
      if (const LocalIndex e = places.entity[cell * places.n + k]; e >= 0 && e < n_owned && !done[e])
        done[e] = visit(e, cell, k);
}

/// Adds the products of weights, from set(cell, place, weights), and the values of a field at the places of the parent.
template <class Set>
void Prolongation::add_weighted(const Field& field, const View<Real**>& coarse, Entity entity, const View<Real**>& fine,
                                const Set& set) const {
  const auto values = table(field, coarse);
  const int n = field.n_components, n_places = places_of(*coarse_, field.entity).n;
  const auto sums = base::to_host(fine);
  Weights weights;
  for_each_place(entity, [&](LocalIndex e, LocalIndex cell, int place) {
    weights.assign(n_places, 0);
    if (!set(cell, place, weights)) return false;
    for (int p = 0; p < n_places; ++p)
      for (int k = 0; k < n; ++k)
        sums(e, k) += weights[p] * values[(std::size_t(parent_[cell]) * n_places + p) * n + k];
    return true;
  });
  Kokkos::deep_copy(fine, sums);
}

/// Returns the gradients of a field on cells, [(parent * components + component) * dim + direction]: of the linear
/// function with the least squares of deviations in the cells of the same region at the nodes of the parent.
std::vector<Real> Prolongation::gradients(const Field& field, const View<Real**>& values) const {
  const fields::Layout layout(field, *coarse_);
  fields::Vector owned(layout.owned()), with_ghosts(layout.ghosted());
  const int n = field.n_components, n_nodes = coarse_->nodes_per_cell();
  Kokkos::deep_copy(fields::by_entity(owned, n), values);
  with_ghosts.doImport(owned, *layout.import(), Tpetra::REPLACE);
  const auto all = with_ghosts.getLocalViewHost(Tpetra::Access::ReadOnly);
  std::vector<std::vector<LocalIndex>> at_node(coarse_->n_nodes());
  for (LocalIndex i = 0; i < coarse_->n_cells() * n_nodes; ++i) at_node[coarse_->cells[i]].push_back(i / n_nodes);
  std::vector<Real> of_cells(std::size_t(coarse_->n_owned_cells) * n * 2, 0);
  for (LocalIndex c = 0; c < coarse_->n_owned_cells; ++c) {
    const auto centre = mesh::cell_centre(*coarse_, c);
    std::set<LocalIndex> around;
    for (int a = 0; a < n_nodes; ++a)
      for (const auto other : at_node[coarse_->cells[c * n_nodes + a]])
        if (other != c && coarse_->cell_region[other] == coarse_->cell_region[c]) around.insert(other);
    Real xx = 0, xy = 0, yy = 0;
    std::vector<std::array<Real, 2>> right(n);
    for (const auto other : around) {
      const auto r = mesh::cell_centre(*coarse_, other) - centre;
      xx += r[0] * r[0], xy += r[0] * r[1], yy += r[1] * r[1];
      for (int k = 0; k < n; ++k)
        for (int i : {0, 1}) right[k][i] += r[i] * (all(other * n + k, 0) - all(c * n + k, 0));
    }
    const Real determinant = xx * yy - xy * xy;
    for (int k = 0; k < n && determinant > 1e-6 * (xx + yy) * (xx + yy); ++k) {
      of_cells[(c * n + k) * 2] = (yy * right[k][0] - xy * right[k][1]) / determinant;
      of_cells[(c * n + k) * 2 + 1] = (xx * right[k][1] - xy * right[k][0]) / determinant;
    }
  }
  return of_parents(of_cells, n * 2);
}

/// Adds a field on cells to a mesh with overlaps: amounts by shares of area, otherwise means of linear functions.
void Prolongation::add_to_cells(const Field& field, const View<Real**>& coarse, const View<Real**>& fine) const {
  const auto values = table(field, coarse);
  const auto slopes = field.is_amount ? std::vector<Real>() : gradients(field, coarse);
  const auto sums = base::to_host(fine);
  const int n = field.n_components;
  for (LocalIndex c = 0; c < fine_->n_owned_cells; ++c) {
    const auto found = parts_.find(c);
    if (found == parts_.end()) {
      const Real share = field.is_amount ? share_of_volume(c) : 1;
      for (int k = 0; k < n; ++k) sums(c, k) += share * values[std::size_t(parent_[c]) * n + k];
      continue;
    }
    Real area = 0;
    for (const auto& part : found->second) area += part.area;
    for (const auto& [parent, of_part, centre] : found->second) {
      const auto X = corners_of(parent);
      const Point off = centre - (Real(1) / 3) * (X[0] + X[1] + X[2]);
      const Real whole = cross(X[1] - X[0], X[2] - X[0])[2] / 2;
      for (int k = 0; k < n; ++k) {
        const auto at = std::size_t(parent) * n + k;
        const Real value = field.is_amount
                               ? values[at] / whole
                               : (values[at] + slopes[2 * at] * off[0] + slopes[2 * at + 1] * off[1]) / area;
        sums(c, k) += of_part * value;
      }
    }
  }
  Kokkos::deep_copy(fine, sums);
}

void Prolongation::add(const Field& field, const View<Real**>& coarse, const View<Real**>& fine) const {
  if (has_overlaps_ && field.entity == Entity::cell) return add_to_cells(field, coarse, fine);
  add_weighted(field, coarse, field.entity, fine,
               [&](LocalIndex cell, int place, Weights& weights) { return set(field, cell, place, weights); });
}

void Prolongation::add_enrichment(const Field& enriching, const View<Real**>& coarse, const View<Real**>& fine) const {
  add_weighted(enriching, coarse, Entity::node, fine, [&](LocalIndex cell, int place, Weights& weights) {
    weights = shape_functions(cell, place);
    const Real rho = share_of_tips(cell, weights);
    for (auto& weight : weights) weight *= rho > 0 ? 1 / std::sqrt(rho) - 1 : 0;
    return true;
  });
}

std::array<Prolongation::Point, 4> Prolongation::corners_of(LocalIndex parent) const {
  const int dim = coarse_->dim();
  std::array<Point, 4> corners{};
  for (int k = 0; k <= dim; ++k)
    std::copy_n(&coordinates_[(std::size_t(parent) * coarse_->nodes_per_cell() + k) * dim], dim, corners[k].begin());
  if (dim == 2) corners[3] = corners[0] + Point{0, 0, 1};
  return corners;
}

/// Returns the barycentric coordinates of a point in the parent with straight edges.
std::array<Real, 4> Prolongation::barycentric(LocalIndex cell, const Point& x) const {
  const auto X = parent_corners(cell);
  const Point a = X[1] - X[0], b = X[2] - X[0], c = X[3] - X[0], r = x - X[0];
  const Real volume = dot(a, cross(b, c));
  std::array<Real, 4> l{0, dot(r, cross(b, c)) / volume, dot(a, cross(r, c)) / volume, dot(a, cross(b, r)) / volume};
  l[0] = 1 - l[1] - l[2] - l[3];
  return l;
}

/// Returns the shape functions of the parent at a node of a cell.
std::vector<Real> Prolongation::shape_functions(LocalIndex cell, int node) const {
  const int n = coarse_->nodes_per_cell(), dim = coarse_->dim();
  Point x{};
  std::copy_n(&fine_->coordinates[fine_->cells[cell * n + node] * dim], dim, x.begin());
  const Real* const nodes = &coordinates_[std::size_t(parent_[cell]) * n * dim];
  const auto start = barycentric(cell, x);
  switch (coarse_->shape) {
    case mesh::Shape::triangle:
      return functions_at<mesh::Shape::triangle>(nodes, x, start);
    case mesh::Shape::tetrahedron:
      return functions_at<mesh::Shape::tetrahedron>(nodes, x, start);
    case mesh::Shape::triangle6:
      return functions_at<mesh::Shape::triangle6>(nodes, x, start);
    default:
      return functions_at<mesh::Shape::tetrahedron10>(nodes, x, start);
  }
}

/// Sets the functions of tips to zero. Returns rho, the sum of the others.
Real Prolongation::share_of_tips(LocalIndex cell, std::vector<Real>& N) const {
  Real rho = 0;
  for (std::size_t a = 0; a < N.size(); ++a) {
    if (tips_[parent_[cell] * N.size() + a] > 0) N[a] = 0;
    rho += N[a];
  }
  return rho;
}

/// Returns the face of the parent that contains a face of the cell; -1: none.
int Prolongation::parent_face(LocalIndex cell, int face) const {
  const auto corners = mesh::face_corners(*fine_, cell, face);
  std::array<Real, 4> largest{};
  for (int k = 0; k < corners.n; ++k) {
    const auto l = barycentric(cell, corners.x[k]);
    for (int i = 0; i < 4; ++i) largest[i] = std::max(largest[i], std::abs(l[i]));
  }
  for (int j = 0; j <= fine_->dim(); ++j)
    if (largest[opposite(fine_->dim(), j)] < 1e-6) return j;
  return -1;
}

Real Prolongation::share_of_volume(LocalIndex cell) const {
  const int n = fine_->nodes_per_cell(), dim = fine_->dim();
  std::array<std::array<Real, 4>, 4> l{};
  for (int k = 0; k <= dim; ++k) {
    Point x{};
    std::copy_n(&fine_->coordinates[fine_->cells[cell * n + k] * dim], dim, x.begin());
    l[k] = barycentric(cell, x);
  }
  const auto edge = [&](int k) { return Point{l[k][1] - l[0][1], l[k][2] - l[0][2], l[k][3] - l[0][3]}; };
  return std::abs(dot(edge(1), cross(edge(2), dim == 2 ? Point{0, 0, 1} : edge(3))));
}

Real Prolongation::share_of_area(LocalIndex cell, int face, int parent_face) const {
  const auto X = parent_corners(cell);
  mesh::FaceCorners corners{{}, mesh::n_face_corners(fine_->shape)};
  for (int k = 0; k < corners.n; ++k) corners.x[k] = X[mesh::face_nodes(fine_->shape)[parent_face][k]];
  return norm(mesh::area_vector(mesh::face_corners(*fine_, cell, face))) / norm(mesh::area_vector(corners));
}

void Prolongation::set_facet(LocalIndex cell, int place, bool is_amount, Weights& weights) const {
  const int dim = fine_->dim(), n_faces = dim + 1;
  if (place >= n_faces) {
    set_ridge(cell, (place - n_faces) / dim, (place - n_faces) % dim, is_amount, weights);
  } else if (const int face = parent_face(cell, place); face >= 0) {
    weights[face] = is_amount ? share_of_area(cell, place, face) : 1;
  } else if (!is_amount) {
    const auto l = barycentric(cell, mesh::face_centre(mesh::face_corners(*fine_, cell, place)));
    for (int j = 0; j < n_faces; ++j) weights[j] = 1 - dim * l[opposite(dim, j)];
  }
}

/// Sets the weights of a ridge of a fracture face. In 2D ridges are corners, in 3D edges that begin at a corner.
void Prolongation::set_ridge(LocalIndex cell, int face, int ridge, bool is_amount, Weights& weights) const {
  const int dim = fine_->dim(), on = parent_face(cell, face);
  if (on < 0) return;
  const auto corners = mesh::face_corners(*fine_, cell, face);
  const Point a = corners.x[ridge], b = corners.x[(ridge + dim - 2) % dim];
  const auto l = barycentric(cell, 0.5 * (a + b));
  const auto& nodes = mesh::face_nodes(fine_->shape)[on];
  const auto off = [&](int k) {
    return l[nodes[(k + dim - 1) % dim]];
  };  // coordinate of the corner opposite to ridge k
  const auto X = parent_corners(cell);
  const int first = dim + 1 + on * dim;
  for (int k = 0; k < dim; ++k) {
    if (std::abs(off(k)) > 1e-6) continue;
    const Real length = norm(X[nodes[(k + 1) % dim]] - X[nodes[k]]);
    weights[first + k] = is_amount && dim == 3 ? norm(b - a) / length : 1;
    return;
  }
  for (int k = 0; k < dim && !is_amount; ++k) weights[first + k] = 1 - (dim - 1) * off(k);
}

/// Sets the weights of the places of the parent for a place of the cell. Returns false if another cell at the entity
/// determines its value.
bool Prolongation::set(const Field& field, LocalIndex cell, int place, Weights& weights) const {
  switch (field.entity) {
    case Entity::cell:
      weights[0] = field.is_amount ? share_of_volume(cell) : 1;
      return true;
    case Entity::fracture_face: {
      const int face = parent_face(cell, place);
      if (face >= 0) weights[face] = field.is_amount ? share_of_area(cell, place, face) : 1;
      return true;
    }
    case Entity::facet:
      set_facet(cell, place, field.is_amount, weights);
      return true;
    case Entity::node:
      weights = shape_functions(cell, place);
      return true;
    default: {
      const int n = fine_->nodes_per_cell();
      if (std::none_of(&fine_->cells[cell * n], &fine_->cells[cell * n] + n,
                       [&](LocalIndex node) { return fine_->tip[node] != 0; }))
        return false;
      weights = shape_functions(cell, place);
      const Real rho = share_of_tips(cell, weights);
      for (auto& weight : weights) weight *= rho > 0 ? 1 / std::sqrt(rho) : 0;  // 0 between two tips
      return true;
    }
  }
}

}  // namespace sprekk::assembly
