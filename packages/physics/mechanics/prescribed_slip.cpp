#include "physics/mechanics/prescribed_slip.hpp"

#include "assembly/geometry.hpp"
#include "laws/prescribed_jump.hpp"
#include "mesh/facets.hpp"

#include <algorithm>
#include <cmath>

namespace sprekk::physics {

using mesh::cross;
using mesh::dot;
using mesh::norm;
using mesh::Vector;
using mesh::operator-;
using mesh::operator*;

namespace {

constexpr Real small = 1e-8;  ///< sine of angles that count as zero

Vector vector_of(const std::vector<Real>& components) {
  Vector v{};
  std::copy(components.begin(), components.end(), v.begin());
  return v;
}

/// Returns the normal that points into the hanging wall.
Vector upward(const Vector& n) {
  for (const int i : {2, 1, 0})
    if (std::abs(n[i]) > small) return n[i] > 0 ? n : -1.0 * n;
  return n;
}

}  // namespace

void PrescribedSlip::describe(base::Section& s) {
  s.entry(slip, "slip", "m", base::any(),
          "prescribed plastic tangential jump, values or expressions of x, y, z, t: left-lateral in 2D; left-lateral "
          "and reverse in 3D; one component with \"direction\"; empty: the friction of the joint applies");
  s.entry(opening, "opening", "m", base::any(),
          "prescribed normal jump, a value or an expression of x, y, z, t; absent: the contact of the joint");
  s.entry(direction, "direction", "-", base::any(),
          "vector of the slip, projected on each face, in place of strike and dip; requires \"moving side\"");
  s.entry(moving_side, "moving side", "-", base::any(),
          "vector to the side that moves along \"direction\", relative to the other side");
  s.entry(lower_corner, "lower corner", "m", base::any(),
          "lowest coordinates of a box; the slip is prescribed on faces with their centre in it; empty: on all faces");
  s.entry(upper_corner, "upper corner", "m", base::any(), "highest coordinates of the box");
  if (s.complete()) check(s);
}

void PrescribedSlip::check(base::Section& s) const {
  if (slip.empty() && opening) s.fail("opening", "requires \"slip\"");
  if (direction.empty() != moving_side.empty())
    s.fail(direction.empty() ? "direction" : "moving side",
           fmt::format("missing; it is required with \"{}\"", direction.empty() ? "moving side" : "direction"));
  for (const auto& [name, vector] : {std::pair("direction", direction), std::pair("moving side", moving_side)})
    if (!vector.empty() && std::all_of(vector.begin(), vector.end(), [](Real v) { return v == 0; }))
      s.fail(name, "must not be zero");
  if (lower_corner.size() != upper_corner.size())
    s.fail("upper corner", fmt::format("has {} components, must have {} like \"lower corner\"", upper_corner.size(),
                                       lower_corner.size()));
  for (std::size_t i = 0; i < std::min(lower_corner.size(), upper_corner.size()); ++i)
    if (upper_corner[i] < lower_corner[i])
      s.fail("upper corner", fmt::format("[{}] is {}, must be at least {}, the value of \"lower corner\"", i,
                                         upper_corner[i], lower_corner[i]));
}

bool PrescribedSlip::contains(const std::array<Real, 3>& centre) const {
  for (std::size_t i = 0; i < lower_corner.size(); ++i)
    if (centre[i] < lower_corner[i] || centre[i] > upper_corner[i]) return false;
  return !slip.empty();
}

bool PrescribedSlip::constant_in_time() const {
  return (!opening || opening->constant_in_time()) &&
         std::all_of(slip.begin(), slip.end(), [](const auto& value) { return value.constant_in_time(); });
}

std::vector<Vector> PrescribedSlip::axes(const std::array<Vector, 3>& frame, int dim) const {
  const Vector& n = frame[0];
  if (!direction.empty()) {
    const auto along = vector_of(direction), side = vector_of(moving_side);
    const auto in_plane = along - dot(along, n) * n;
    SPREKK_CHECK(norm(in_plane) > small * norm(along),
                 "\"direction\": is normal to the face; it must have a component along it");
    SPREKK_CHECK(std::abs(dot(side, n)) > small * norm(side),
                 "\"moving side\": lies in the plane of the face; it must point at one side");
    return {((dot(side, n) > 0 ? 1 : -1) / norm(in_plane)) * in_plane};
  }
  if (dim == 2) return {-1.0 * frame[1]};  // to the left of n
  const auto up = upward(n);
  const Vector strike{-up[1], up[0], 0};
  SPREKK_CHECK(norm(strike) > small,
               "\"slip\": the face is horizontal, without strike; give \"direction\" and \"moving side\"");
  const Real sign = dot(up, n) > 0 ? 1 : -1;
  const auto unit = (1 / norm(strike)) * strike;
  return {sign * unit, sign * cross(up, unit)};
}

std::vector<Real> prescribed_jumps(const PrescribedSlips& slips, const mesh::Mesh& mesh, Real t) {
  const int dim = mesh.dim();
  std::vector<Real> all(std::size_t(mesh.n_owned_fracture_faces) * dim, laws::not_prescribed);
  for (LocalIndex f = 0; f < mesh.n_owned_fracture_faces; ++f) {
    const auto& face = mesh.fracture_faces[f];
    const auto found = slips.find(mesh.fracture_names[face.fracture]);
    if (found == slips.end() || !found->second.contains(face.centre)) continue;
    const auto mean = [&](const base::Expression& value) {
      return assembly::face_mean(mesh, face.cell[mesh::minus], face.local_face[mesh::minus],
                                 [&](const auto&, const auto& x) { return value(x, t); });
    };
    const auto& section = found->second;
    try {
      Real* jump = &all[std::size_t(f) * dim];
      std::fill(jump + 1, jump + dim, 0);
      if (section.opening) jump[0] = mean(*section.opening);
      const auto axes = section.axes(face.frame, dim);
      for (std::size_t k = 0; k < axes.size(); ++k) {
        const Real slip = mean(section.slip[k]);
        for (int i = 1; i < dim; ++i) jump[i] += slip * dot(axes[k], face.frame[i]);
      }
    } catch (const Error& error) {
      throw Error(fmt::format("Sprekk > Fractures > {} > prescribed slip: at the face ({:.6g}, {:.6g}, {:.6g}): {}",
                              found->first, face.centre[0], face.centre[1], face.centre[2], error.what()));
    }
  }
  return all;
}

}  // namespace sprekk::physics
