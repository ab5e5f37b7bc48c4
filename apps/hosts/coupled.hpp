// Coupling of a host with its own flow code to Sprekk's mechanics, by exchange and as rows of Sprekk's Jacobian. The
// header contains the scene for both, and for Sprekk's own flow.
#pragma once

#include "own_flow.hpp"
#include "reservoir.hpp"

#include <Teuchos_CommHelpers.hpp>

#include <limits>

namespace hosts {

// Rock, and the fluid's mobility and storage in it. The box is compressed by 2 MPa, with an additional shear traction
// of 0.4 MPa on "north".
constexpr Real E = 10e9, nu = 0.25, alpha = 0.8, k_mu = 1e-12, storage = 2e-10;  // Pa, -, -, m^2/(Pa s), 1/Pa
constexpr Real viscosity = 1e-3, aperture = 2e-4, minimum = 1e-5, injection = 1e-6, dt = 10;  // Pa s, m, m, m/s^2, s

/// Returns a grid of a box of 1 m with a fracture that ends inside.
inline Grid grid(int dim, int cells) {
  const Real h = 1.0 / cells;
  const std::array<int, 2> middle = {cells / 4, cells - cells / 4};
  return {{cells, cells, dim == 3 ? cells : 1},
          {h, h, dim == 3 ? h : 1},
          cells / 2,
          middle,
          dim == 3 ? middle : std::array{0, 1}};
}

inline Fluid fluid() {
  const Real M = E * (1 - nu) / ((1 + nu) * (1 - 2 * nu));  // lambda + 2G
  return {k_mu, storage, alpha * alpha / (4 * M), viscosity, aperture, minimum, injection};
}

/// Returns the scene of a block on rollers, without a fluid.
inline model::Scene block(int dim, int cells) {
  const auto [n, h, plane, along, across] = grid(dim, cells);
  model::Scene scene;
  scene.mesh.cell = dim == 2 ? "quadrilateral" : "hexahedron";
  scene.mesh.lower_corner.assign(dim, 0);
  scene.mesh.upper_corner.assign(dim, 1);
  scene.mesh.cells.assign(dim, cells);
  auto& fracture = scene.mesh.fractures["fracture"];
  for (int side = 0; side < 2; ++side) {
    auto& corner = side == 0 ? fracture.lower_corner : fracture.upper_corner;
    corner = {along[side] * h[0], plane * h[1]};
    if (dim == 3) corner.push_back(across[side] * h[2]);
  }
  auto& rock = scene.materials["rock"];
  rock.type = "elastic";
  rock.E = E;
  rock.nu = nu;
  rock.biot = alpha;
  auto& joint = scene.materials["joint"];
  joint.type = "joint";
  joint.friction_coefficient = 0.3;
  joint.tangential_stiffness = 20e9;
  joint.initial_aperture = aperture;
  joint.residual_aperture = minimum;
  scene.bulk.material = "rock";
  scene.fractures["fracture"].material = "joint";
  const std::vector<std::string> constrained = {"west", "south", "bottom"}, pressed = {"east", "north", "top"};
  for (int axis = 0; axis < dim; ++axis) {
    auto& low = scene.boundary_conditions[constrained[axis]];
    low.boundary = constrained[axis];
    low.displacement.assign(dim, base::Expression("free"));
    low.displacement[axis] = 0;
    auto& high = scene.boundary_conditions[pressed[axis]];
    high.boundary = pressed[axis];
    high.traction.assign(dim, base::Expression(0));
    high.traction[axis] = -2e6;
  }
  scene.boundary_conditions["north"].traction[0] = 4e5;
  return scene;
}

struct Cost {
  int exchanges = 0, newton = 0, krylov = 0;
};

inline void take(model::Model& model, Real t, Cost& cost) {
  const auto report = model.step_to(t);
  if (!report.converged) throw Error(report.reason);
  cost.newton += report.newton_iterations;
  cost.krylov += solve::iterations(report.linear_solves);
}

/// Host's reservoir with a model of the block. The code is serial: each rank solves the whole flow.
class Exchange {
 public:
  Exchange(int dim, int cells, RCP<const Comm> comm, model::Scene scene)
      : grid_(grid(dim, cells)), reservoir_(grid_, fluid()), room_(reservoir_.size(), 0), p_(room_) {
    scene.host_fluid = physics::HostFluid();
    model_ = std::make_unique<model::Model>(scene, comm);
    const auto& mesh = model_->mesh();
    for (LocalIndex c = 0; c < mesh.n_owned_cells; ++c) {
      std::array<Real, 3> centre{};
      const int n = mesh.nodes_per_cell();
      for (int k = 0; k < n; ++k)
        for (int i = 0; i < dim; ++i) centre[i] += mesh.coordinates[mesh.cells[c * n + k] * dim + i] / n;
      number_.push_back(grid_.cell_at(centre));
    }
    for (LocalIndex f = 0; f < mesh.n_owned_fracture_faces; ++f)
      number_.push_back(grid_.n_cells() + grid_.face_at(mesh.fracture_faces[f].centre));
  }

  model::Model& model() { return *model_; }
  /// Returns the pressures of owned cells, then of owned fracture faces, Pa.
  Values pressures() const { return owned(p_); }

  /// Takes a fixed-stress step to t. Flow is solved with the compliance of the rock under constant stress, then
  /// mechanics with the pressures, until pressures change by less than the tolerance, Pa. Throws an Error after 500
  /// exchanges. Collective.
  Cost step(Real t, Real tolerance) {
    Cost cost;
    const Real K = E / (3 * (1 - 2 * nu)), length = 0.5;
    for (bool first = true;; first = false) {
      const auto next = reservoir_.pressures(t, t - model_->time(), room_, p_, {alpha * alpha / K, length / E});
      const Real change = difference(next, p_);
      p_ = next;
      ++cost.exchanges;
      const auto mine = pressures();
      const auto of_faces = mine.begin() + model_->mesh().n_owned_cells;
      physics::set_fluid_pressure(model_->system(), {mine.begin(), of_faces}, {of_faces, mine.end()});
      take(*model_, t, cost);
      room_ = everywhere(model_->output("gained pore volume").values, model_->output("widening").values);
      if (!first && change < tolerance) break;
      if (cost.exchanges == 500)
        throw Error(fmt::format("exchange does not converge: pressures change by {} Pa", change));
      model_->take_back();
    }
    reservoir_.accept(p_, room_);
    return cost;
  }

 private:
  static Real difference(const Values& a, const Values& b) {
    Real largest = 0;
    for (std::size_t k = 0; k < a.size(); ++k) largest = std::max(largest, std::abs(a[k] - b[k]));
    return largest;
  }
  Values owned(const Values& all) const {
    Values values;
    for (const int k : number_) values.push_back(all[k]);
    return values;
  }
  Values everywhere(const Values& cells, const Values& faces) const {
    Values here(reservoir_.size(), 0), all(here);
    for (std::size_t k = 0; k < number_.size(); ++k)
      here[number_[k]] = k < cells.size() ? cells[k] : faces[k - cells.size()];
    Teuchos::reduceAll(*model_->mesh().comm, Teuchos::REDUCE_SUM, reservoir_.size(), here.data(), all.data());
    return all;
  }

  Grid grid_;
  Reservoir reservoir_;
  Values room_, p_;
  std::unique_ptr<model::Model> model_;
  std::vector<int> number_;  // [owned cell, then owned fracture face] number in the host's grid
};

/// Returns a model of the block with the host's flow in one Jacobian. Collective.
inline std::unique_ptr<model::Model> make_together(model::Scene scene, RCP<const Comm> comm) {
  scene.host_fluid = physics::HostFluid{true};
  const auto flow = [](const mesh::Mesh& mesh) {
    std::vector<std::unique_ptr<assembly::Module>> modules;
    modules.push_back(make_own_flow(mesh, fluid()));
    return modules;
  };
  return std::make_unique<model::Model>(scene, comm, flow);
}

/// Returns a model of the block with Sprekk's own flow. Collective.
inline std::unique_ptr<model::Model> make_sprekk(model::Scene scene, RCP<const Comm> comm) {
  auto& flow = scene.flow.emplace();
  flow.viscosity = viscosity;
  flow.scheme = "tpfa";
  auto& rock = scene.materials["rock"];
  rock.permeability = {base::Expression(k_mu * viscosity)};
  rock.biot_modulus = 1 / storage;
  scene.fractures["fracture"].source = base::Expression(fmt::format("{}*t", injection));
  return std::make_unique<model::Model>(scene, comm);
}

/// Returns the pressures of a model with one Jacobian, in the order of Exchange::pressures(), Pa.
inline Values pressures(model::Model& model) {
  Values all;
  const auto p = model.field("pressure").values, trace = model.field("face pressure").values;
  for (std::size_t c = 0; c < p.extent(0); ++c) all.push_back(p(c, 0));
  for (LocalIndex f = 0; f < model.mesh().n_owned_fracture_faces; ++f)
    all.push_back(trace(model.mesh().facets->fracture_face[f], 0));
  return all;
}

/// Returns the number of open, sticking and sliding fracture faces over all ranks. Collective.
inline std::array<int, 3> count_states(model::Model& model) {
  std::array<int, 3> here{}, all{};
  for (const Real state : model.output("state").values) ++here[static_cast<int>(state)];
  Teuchos::reduceAll(*model.mesh().comm, Teuchos::REDUCE_SUM, 3, here.data(), all.data());
  return all;
}

/// Returns max |a - b| / max |b| over all ranks; infinite for NaN or different sizes. Collective.
inline Real distance(const Values& a, const Values& b, const Comm& comm) {
  const Real infinite = std::numeric_limits<Real>::infinity();
  Real here[2] = {a.size() == b.size() ? 0 : infinite, 0}, all[2];
  for (std::size_t k = 0; k < std::min(a.size(), b.size()); ++k) {
    const Real apart = std::abs(a[k] - b[k]);
    here[0] = std::isfinite(apart) ? std::max(here[0], apart) : infinite;
    here[1] = std::max(here[1], std::abs(b[k]));
  }
  Teuchos::reduceAll(comm, Teuchos::REDUCE_MAX, 2, here, all);
  return all[0] == 0 ? 0 : all[0] / all[1];
}

}  // namespace hosts
