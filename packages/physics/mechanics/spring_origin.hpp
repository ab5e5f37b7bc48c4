// Springs with an origin at the displacement of their installation.
#pragma once

#include "assembly/module.hpp"

#include <array>
#include <memory>
#include <string>

namespace sprekk::physics {

/// Creates a module with the force f(u - u_0), from linear springs with the force f(u) and the stiffness k_i per
/// direction. With `keeps`, the traction k (u - u_0) is continuous when a system takes over the state of another one,
/// also if k changes: u_0 = u - traction/k with the traction of the module of the same name. If that had no springs,
/// u_0 = u. Without `keeps`, u_0 = 0. History: u_0, "origin" [node, dim], m.
std::unique_ptr<assembly::Module> make_spring_origin(std::unique_ptr<assembly::Module> springs, const std::string& name,
                                                     const std::array<Real, 3>& stiffness, bool keeps);

}  // namespace sprekk::physics
