// What a fluid's pressure stores of it: rows of the pressure in rock and in fractures.
#pragma once

#include "assembly/module.hpp"
#include "base/expression.hpp"

#include <memory>
#include <vector>

namespace sprekk::physics {

struct FluidStorageParameters {
  std::vector<Real> storage;         ///< different specific storages S, 1/Pa
  std::vector<int> storage_of_cell;  ///< [local cell] which of them; empty: the number of the cell's region
  base::Expression initial = 0;      ///< pressure at the start, Pa
};

/// Adds S V (p - p_old)/dt to the rows of "pressure" (implicit Euler), p_old being the pressure of the cell at the
/// start of the step, which it keeps.
std::unique_ptr<assembly::Module> make_fluid_storage(FluidStorageParameters parameters);

struct FractureStorageParameters {
  std::vector<Real> storage;     ///< [local fracture face] per area, m/Pa
  base::Expression initial = 0;  ///< pressure at the start, Pa
};

/// The same for "face pressure" on fracture faces: area times storage for S V.
std::unique_ptr<assembly::Module> make_fracture_storage(FractureStorageParameters parameters);

}  // namespace sprekk::physics
