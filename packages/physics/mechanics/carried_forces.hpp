// Forces of springs that go on where their constants change.
#pragma once

#include "assembly/module.hpp"

#include <memory>
#include <string>

namespace sprekk::physics {

/// A linear module that adds a force f(u) to the rows of the displacement u; if it `keeps` forces, f(u) + c: where a
/// system takes over the state of one whose module of the same name made the force g there, c = g - f(u); g = 0 if
/// there was none. History: c, "carried forces" [node, dim], N.
std::unique_ptr<assembly::Module> make_carried_forces(std::unique_ptr<assembly::Module> springs,
                                                      const std::string& name, bool keeps);

}  // namespace sprekk::physics
