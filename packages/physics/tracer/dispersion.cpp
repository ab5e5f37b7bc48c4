#include "physics/tracer/dispersion.hpp"

#include "assembly/term.hpp"
#include "mesh/facets.hpp"
#include "transport/changed_flow.hpp"
#include "transport/face_plane.hpp"

#include <cmath>

namespace sprekk::physics {

using assembly::Loop;
using assembly::Slot;
using mesh::Shape;

namespace {

/// Dispersive flows through the n ends of an entity of dimension m in a space of dimension dim. `Pressures`: slots of
/// which the last n unknowns are the pressures of the ends. `Of`: slots of c on the entity and its ends.
///
/// | symbol   | shape                 | unit       |                                             |
/// | x        | first + n + (1 + n)   | Pa, kg/m^3 | pressures; c of the entity and of its ends  |
/// | r        | 1 + n                 | kg/s       | balance of the entity, inflow of each end   |
/// | ends     | [entity, 2 n, dim]    | m^2, m     | A_j, then d_j                               |
/// | volume   | [entity]              | m^3        | V                                           |
/// | mobility | [number]              | m^2/(Pa s) | k/mu, in fractures times the aperture       |
/// | length   | [number_of_length, 2] | m          | alpha_L, alpha_T                            |
/// | weight   | [dim]                 | N/m^3      | rho_0 g                                     |
template <int n, int m, int dim, class Pressures, class Of>
struct DispersiveFlow {
  using Columns = typename transport::Joined<Pressures, Of>::Slots;
  using Rows = Of;
  static constexpr int size = Columns::size, first = Pressures::size - n, c = Pressures::size;
  static_assert(Rows::size == 1 + n);
  ConstView<Real***> ends = {};
  ConstView<Real*> volume = {};
  ConstView<laws::Mobility*> mobility = {};
  ConstView<int*> number = {}, number_of_length = {};
  ConstView<Real**> length = {};
  Kokkos::Array<Real, 3> weight = {};

  KOKKOS_INLINE_FUNCTION void residual(int e, const Real (&x)[size], Real (&r)[1 + n]) const {
    Real u[dim], D[dim][dim], drop[n], q[n];
    velocity(e, x, u);
    tensor(e, u, D);
    for (int j = 0; j < n; ++j) drop[j] = x[c] - x[c + 1 + j];
    flow(e, D, drop, q);
    transport::balance(q, r);
  }

  KOKKOS_INLINE_FUNCTION void jacobian(int e, const Real (&x)[size], Real (&J)[1 + n][size]) const {
    Real u[dim], D[dim][dim], drop[n], q[n], dq[n][size];
    velocity(e, x, u);
    tensor(e, u, D);
    for (auto& row : dq)
      for (Real& value : row) value = 0;
    for (int k = 0; k < n; ++k) {
      for (int j = 0; j < n; ++j) drop[j] = j == k ? 1 : 0;
      flow(e, D, drop, q);
      for (int i = 0; i < n; ++i) {
        dq[i][c] += q[i];
        dq[i][c + 1 + k] -= q[i];
      }
    }
    for (int j = 0; j < n; ++j) drop[j] = x[c] - x[c + 1 + j];
    for (int a = 0; a < dim; ++a) {
      dtensor(e, u, a, D);
      flow(e, D, drop, q);
      for (int k = 0; k < n; ++k) {
        const Real du = slope(e, a, k);
        for (int i = 0; i < n; ++i) dq[i][first + k] += q[i] * du;
      }
    }
    transport::balance(dq, J);
  }

 private:
  /// Derivative of component a of the velocity in p_k. The sum over k is zero, since the A_k form a closed surface.
  KOKKOS_INLINE_FUNCTION Real slope(int e, int a, int k) const {
    const auto& K = mobility(number(e)).value;
    Real sum = 0;
    for (int b = 0; b < dim; ++b) sum -= K[a][b] * ends(e, k, b);
    return sum / volume(e);
  }
  KOKKOS_INLINE_FUNCTION void velocity(int e, const Real (&x)[size], Real (&u)[dim]) const {
    for (int a = 0; a < dim; ++a) u[a] = 0;
    for (int j = 0; j < n; ++j) {
      Real rise = x[first + j] - x[first];
      for (int b = 0; b < dim; ++b) rise -= weight[b] * ends(e, n + j, b);
      for (int a = 0; a < dim; ++a) u[a] += slope(e, a, j) * rise;
    }
  }
  KOKKOS_INLINE_FUNCTION static Real norm(const Real (&u)[dim]) {
    Real sum = 0;
    for (int a = 0; a < dim; ++a) sum += u[a] * u[a];
    return std::sqrt(sum);
  }
  KOKKOS_INLINE_FUNCTION void tensor(int e, const Real (&u)[dim], Real (&D)[dim][dim]) const {
    const Real speed = norm(u), across = length(number_of_length(e), 1), more = length(number_of_length(e), 0) - across;
    for (int a = 0; a < dim; ++a)
      for (int b = 0; b < dim; ++b)
        D[a][b] = (a == b ? across * speed : 0) + (speed > 0 ? more * u[a] * (u[b] / speed) : 0);
  }
  /// Derivative of tensor() in component k of u; zero at u = 0.
  KOKKOS_INLINE_FUNCTION void dtensor(int e, const Real (&u)[dim], int k, Real (&D)[dim][dim]) const {
    const Real speed = norm(u), across = length(number_of_length(e), 1), more = length(number_of_length(e), 0) - across;
    for (int a = 0; a < dim; ++a)
      for (int b = 0; b < dim; ++b) {
        D[a][b] = 0;
        if (!(speed > 0)) continue;
        const Real v[] = {u[a] / speed, u[b] / speed, u[k] / speed};
        D[a][b] =
            (a == b ? across * v[2] : 0) + more * ((a == k ? v[1] : 0) + (b == k ? v[0] : 0) - v[0] * v[1] * v[2]);
      }
  }

  /// Outward flows from the differences drop_j = c_K - c_j.
  KOKKOS_INLINE_FUNCTION void flow(int e, const Real (&D)[dim][dim], const Real (&drop)[n], Real (&q)[n]) const {
    const Real V = volume(e);
    Real G[dim] = {}, sum[dim] = {};
    for (int j = 0; j < n; ++j)
      for (int a = 0; a < dim; ++a) G[a] += ends(e, j, a) * drop[j] / V;
    for (int i = 0; i < n; ++i) {
      Real rest = drop[i], height = 0, g[dim], along = 0;
      for (int a = 0; a < dim; ++a) {
        rest -= G[a] * ends(e, n + i, a);
        height += ends(e, i, a) * ends(e, n + i, a);
      }
      const Real factor = std::sqrt(Real(m)) / height;
      for (int a = 0; a < dim; ++a) g[a] = G[a] + factor * rest * ends(e, i, a);
      for (int a = 0; a < dim; ++a) {
        Real flux = 0;
        for (int b = 0; b < dim; ++b) flux += D[a][b] * g[b] * height / m;
        along += flux * ends(e, i, a);
        sum[a] += flux;
      }
      q[i] = factor * along;
      for (int a = 0; a < dim; ++a) sum[a] -= factor * along * ends(e, n + i, a);
    }
    for (int j = 0; j < n; ++j)
      for (int a = 0; a < dim; ++a) q[j] += sum[a] * ends(e, j, a) / V;
  }
};

template <Shape shape>
class Dispersion final : public assembly::Module {
 public:
  using Faces = transport::CellFaces<shape>;
  using Plane = transport::FacePlane<shape>;
  static constexpr int dim = Faces::dim;
  using InCell = DispersiveFlow<Faces::n, dim, dim, assembly::Slots<Slot<Faces::n, 1>>,
                                assembly::Slots<Slot<1, 1>, Slot<Faces::n, 1>>>;
  using OfFace = assembly::Slots<Slot<1 + Plane::n, 1>>;
  using InFace = DispersiveFlow<Plane::n, dim - 1, dim, OfFace, OfFace>;

  explicit Dispersion(DispersionParameters parameters) : parameters_(std::move(parameters)) {}

  std::string name() const override { return "dispersion"; }

  assembly::Declaration declare(const mesh::Mesh&) const override {
    assembly::Declaration d;
    for (const char* row : {"concentration", "face concentration"})
      d.couplings.push_back({Loop::cells, row, {"face pressure", "concentration", "face concentration"}});
    if (in_fractures())
      d.couplings.push_back({Loop::fracture_cells, "face concentration", {"face pressure", "face concentration"}});
    d.carries = {"concentration", "face concentration"};
    return d;
  }

  void bind(const assembly::Context& context) override {
    const auto field = [&](const char* name) { return context.field(name); };
    const std::vector<int> c = {field("concentration"), field("face concentration")};
    const auto cell = in_cells(context);
    terms_.emplace_back(context, Loop::cells, c, std::vector{field("face pressure"), c[0], c[1]}, true,
                        [cell](const auto&) { return cell; });
    if (!in_fractures()) return;
    const auto face = on_faces(*context.mesh());
    terms_.emplace_back(context, Loop::fracture_cells, std::vector{c[1]}, std::vector{field("face pressure"), c[1]},
                        true, [face](const auto&) { return face; });
  }

  void residual(const assembly::State& state, const assembly::Rows& r) const override {
    for (const auto& term : terms_) term.add_residual(state, r);
  }
  void jacobian(const assembly::State& state, fields::BlockMatrix& J) const override {
    for (const auto& term : terms_) term.add_jacobian(state, J);
  }
  bool symmetric(const assembly::State&) const override { return false; }

 private:
  bool in_fractures() const { return !parameters_.of_fractures.empty(); }

  static ConstView<Real**> lengths_of(const std::vector<Dispersivity>& values) {
    const View<Real**> length("dispersivity", values.size(), 2);
    const auto host = Kokkos::create_mirror_view(length);
    for (std::size_t k = 0; k < values.size(); ++k) {
      host(k, 0) = values[k].along;
      host(k, 1) = values[k].across;
    }
    Kokkos::deep_copy(length, host);
    return length;
  }

  /// Sets the geometry of `size` entities: find(entity, A, d) returns V.
  template <class Op, int n, class Find>
  void set_geometry(Op& op, LocalIndex size, const Find& find) const {
    const View<Real***> ends("ends", size, 2 * n, dim);
    const auto host = Kokkos::create_mirror_view(ends);
    std::vector<Real> volume;
    for (LocalIndex e = 0; e < size; ++e) {
      Real A[n][dim], d[n][dim];
      volume.push_back(find(e, A, d));
      for (int j = 0; j < n; ++j)
        for (int a = 0; a < dim; ++a) {
          host(e, j, a) = A[j][a];
          host(e, n + j, a) = d[j][a];
        }
    }
    Kokkos::deep_copy(ends, host);
    op.ends = ends;
    op.volume = assembly::to_device(volume, "volume");
    const auto& [gx, gy, gz] = parameters_.weight;
    op.weight = {gx, gy, gz};
  }

  InCell in_cells(const assembly::Context& context) const {
    constexpr int n = Faces::n;
    const auto& mesh = *context.mesh();
    const auto& [mobility, of_rock, transmissivity, of_fractures, weight] = parameters_;
    InCell op;
    set_geometry<InCell, n>(op, mesh.n_cells(), [&](LocalIndex cell, Real(&A)[n][dim], Real(&d)[n][dim]) {
      Real X[mesh::n_nodes(shape)][dim];
      assembly::gather_host<shape>(mesh, cell, X);
      const Faces faces(X);
      for (int j = 0; j < n; ++j)
        for (int a = 0; a < dim; ++a) {
          A[j][a] = faces.area[j][a];
          d[j][a] = faces.centre[j][a];
        }
      return faces.volume;
    });
    op.mobility = assembly::to_device(mobility.values, "mobility");
    op.number = assembly::material_numbers(context.geometry(), mobility.number);
    op.length = lengths_of(of_rock.values);
    op.number_of_length = assembly::material_numbers(context.geometry(), of_rock.number);
    return op;
  }

  InFace on_faces(const mesh::Mesh& mesh) const {
    constexpr int n = Plane::n;
    constexpr auto scheme = mesh::is_simplex(shape) ? transport::FluxScheme::rt0 : transport::FluxScheme::mimetic;
    InFace op;
    set_geometry<InFace, n>(op, mesh.n_fracture_faces(), [&](LocalIndex face, Real(&A)[n][dim], Real(&d)[n][dim]) {
      const Plane plane(mesh, face, 1, scheme);
      for (int j = 0; j < n; ++j)
        for (int a = 0; a < dim; ++a) {
          d[j][a] = plane.d[j][a];
          A[j][a] = 0;  // T d = A for a unit transmissivity, since T is exact for constant gradients
          for (int k = 0; k < n; ++k) A[j][a] += plane.T[j][k] * plane.d[k][a];
        }
      return plane.area;
    });
    std::vector<laws::Mobility> mobility;
    std::vector<int> number;
    for (const Real one : parameters_.transmissivity) {
      number.push_back(static_cast<int>(mobility.size()));
      mobility.push_back(laws::Mobility::isotropic(one));
    }
    op.mobility = assembly::to_device(mobility, "transmissivity");
    op.number = op.number_of_length = assembly::to_device(number, "number");
    op.length = lengths_of(parameters_.of_fractures);
    return op;
  }

  DispersionParameters parameters_;
  std::vector<assembly::Term> terms_;
};

}  // namespace

std::unique_ptr<assembly::Module> make_dispersion(Shape shape, DispersionParameters parameters) {
  return mesh::for_corners(shape, [&](auto s) -> std::unique_ptr<assembly::Module> {
    return std::make_unique<Dispersion<s()>>(std::move(parameters));
  });
}

}  // namespace sprekk::physics
