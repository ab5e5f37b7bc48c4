// Springs that count from where they were put.
#pragma once

#include "assembly/module.hpp"

#include <array>
#include <memory>
#include <string>

namespace sprekk::physics {

/// Springs of the stiffness k_i per direction, a linear module whose force on the displacement u is f(u), as f(u -
/// u_0). With `keeps`, where a system takes over the state of another one the traction k (u - u_0) of the module of the
/// same name there goes on, also with another k: u_0 = u - traction/k; u_0 = u where that had no springs. Else u_0 = 0.
/// History: u_0, "origin" [node, dim], m.
std::unique_ptr<assembly::Module> make_spring_origin(std::unique_ptr<assembly::Module> springs, const std::string& name,
                                                     const std::array<Real, 3>& stiffness, bool keeps);

}  // namespace sprekk::physics
