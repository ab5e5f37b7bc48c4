// Storage of transported quantities in cells and fracture faces.
#pragma once

#include "assembly/module.hpp"
#include "base/expression.hpp"
#include "fields/properties.hpp"
#include "laws/fluid.hpp"
#include "transport/fluid_change.hpp"

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace sprekk::transport {

/// Stored amount per volume (fractures: per area): (room + growth g) e(u). Here g is the change of u since the start,
/// and e is the fluid density relative to reference conditions.
struct Capacity {
  Real room;    ///< fluid: porosity phi_0 (fractures: aperture, m); energy: 0
  Real growth;  ///< fluid: c_phi, 1/Pa, with the porosity phi_0 + c_phi g; energy: rho c, J/(m^3 K)
};

struct StorageParameters {
  std::string name = {};                       ///< name of the module
  std::string field;                           ///< u, on cells
  std::string amount = {};                     ///< unit of the stored amount; empty: no total
  fields::Properties<Capacity> capacity = {};  ///< of cells
  laws::Fluid fluid = {};                      ///< energy: the default, with density 1
  base::Expression initial = 0;                ///< u at the start
  std::optional<FluidChange> change = {};      ///< multiplies the density by the density of its response
};

/// Adds V (s - s_old)/dt to the rows of u (implicit Euler), with s as defined by Capacity. Saves the change of u since
/// the start as history. For constant density the term equals V growth (u - u_old)/dt. Total, with a unit `amount`
/// and without `change`: "stored" > name, the sum of V s minus its value at the start.
std::unique_ptr<assembly::Module> make_storage(StorageParameters parameters);

struct FractureStorageParameters {
  std::vector<Real> aperture = {};  ///< [local fracture face] a_0, m
  std::vector<Real> minimum = {};   ///< [local fracture face] residual aperture, m
  laws::Fluid fluid = {};
  base::Expression initial = 0;  ///< pressure at the start, Pa
  bool widens = false;           ///< adds the field "widening" of FractureOpening, times `share`, to the aperture
  std::vector<Real> share = {};  ///< [local fracture face] share of a widening that the fluid fills
  std::optional<FluidChange> change = {};
};

/// Adds storage to the rows of "face pressure" on fracture faces. The face area replaces V, and the aperture replaces
/// the porosity.
std::unique_ptr<assembly::Module> make_fracture_storage(FractureStorageParameters parameters);

/// Storage per length of an edge of fracture faces.
struct EdgeCapacity {
  LocalIndex facet;   ///< ridge of the edge
  Real length;        ///< m
  Capacity capacity;  ///< with the cross-sectional area, m^2, instead of the porosity
  std::array<Real, 3> centre;
};

/// Adds storage to the rows of "face FIELD" on these ridges. `name` and `capacity` of the parameters are not used, and
/// `edges` may be empty on some ranks.
std::unique_ptr<assembly::Module> make_edge_storage(StorageParameters parameters, std::vector<EdgeCapacity> edges);

}  // namespace sprekk::transport
