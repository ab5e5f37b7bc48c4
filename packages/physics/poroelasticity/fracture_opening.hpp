// Pressure of a fluid on the sides of fractures, and their opening.
#pragma once

#include "assembly/module.hpp"

#include <memory>
#include <vector>

namespace sprekk::physics {

/// Creates the module that couples "displacement" (with "side bubble" and "tip displacement" if present) to "face
/// pressure". It declares the unknown "widening" b (fracture faces, m): the aperture (15) minus that of the initial
/// state. W_f(u) = |f| n . mean([[u]]) belongs to a fracture face. Rows:
///   momentum      -alpha_f p_f dW_f/du
///   "widening"    |f| b - W_f(u)
/// On the sides of a fracture acts the traction lambda - alpha_f p_f n, Wollmann (2024), (6), (7), with Biot's
/// coefficient alpha_f of the filling, `biot` [local fracture face]. make_fracture_storage() adds the storage of
/// fractures.
std::unique_ptr<assembly::Module> make_fracture_opening(const mesh::Mesh& mesh, std::vector<Real> biot);

}  // namespace sprekk::physics
