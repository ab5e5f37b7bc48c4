// The kernels of the traction rows over all fracture faces of a mesh.
#pragma once

#include "assembly/module.hpp"
#include "physics/mechanics/joint_points.hpp"

#include <memory>
#include <vector>

namespace sprekk::physics {

/// Gathers the unknowns of fracture faces, calls the joint laws and scatters, for the shape of the mesh's faces.
/// `points` has the laws and the history that a call uses.
template <int dim>
class JointOperators {
 public:
  virtual ~JointOperators() = default;

  /// R(w, lambda) of each owned face.
  virtual void add_residual(const JointPoints<dim>& points, const assembly::State& state,
                            const assembly::Rows& r) const = 0;
  virtual void add_jacobian(const JointPoints<dim>& points, const assembly::State& state, fields::BlockMatrix& J) = 0;

  /// The power of friction, see SlidingFace, taken from the rows that store it.
  virtual void add_power(const JointPoints<dim>& points, const assembly::State& state,
                         const assembly::Rows& r) const = 0;
  virtual void add_power_jacobian(const JointPoints<dim>& points, const assembly::State& state,
                                  fields::BlockMatrix& J) = 0;

  /// [owned face], on the device
  virtual View<JointPoint<dim>*> evaluate(const JointPoints<dim>& points, const assembly::State& state) const = 0;
};

/// `fields`: blocks of displacement, side bubble, traction and, of a mesh with enriched tips, tip displacement.
/// `power_to`: block whose rows take the power of friction; -1: none. `rest`: w_0 [owned face, dim], m; empty: zero.
template <int dim>
std::unique_ptr<JointOperators<dim>> make_joint_operators(const assembly::Context& context,
                                                          const std::vector<int>& fields, int power_to,
                                                          const ConstView<Real**>& rest);

}  // namespace sprekk::physics
