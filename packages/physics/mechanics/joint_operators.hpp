// Kernels of the traction rows over all fracture faces of a mesh.
#pragma once

#include "assembly/module.hpp"
#include "laws/joint_points.hpp"

#include <memory>
#include <vector>

namespace sprekk::physics {

/// Gathers the unknowns of fracture faces, evaluates the joint laws and scatters the results, for one face shape.
/// `points`: laws and history variables of a call.
template <int dim>
class JointOperators {
 public:
  virtual ~JointOperators() = default;

  /// Adds R(w, lambda) of each owned face, and its derivatives.
  virtual void add_residual(const laws::JointPoints<dim>& points, const assembly::State& state,
                            const assembly::Rows& r) const = 0;
  virtual void add_jacobian(const laws::JointPoints<dim>& points, const assembly::State& state,
                            fields::BlockMatrix& J) = 0;

  /// Adds the power of friction, see SlidingFace, to the rows that store it, and its derivatives.
  virtual void add_power(const laws::JointPoints<dim>& points, const assembly::State& state,
                         const assembly::Rows& r) const = 0;
  virtual void add_power_jacobian(const laws::JointPoints<dim>& points, const assembly::State& state,
                                  fields::BlockMatrix& J) = 0;

  /// Results of all owned faces, on the device.
  virtual View<laws::JointPoint<dim>*> evaluate(const laws::JointPoints<dim>& points,
                                                const assembly::State& state) const = 0;
};

/// Creates the kernels. `fields`: blocks of displacement, side bubble, traction and, with enriched tips, tip
/// displacement. `power_to`: block that receives the power of friction; -1: none. `rest`: w_0 [owned face, dim], m;
/// empty: zero.
template <int dim>
std::unique_ptr<JointOperators<dim>> make_joint_operators(const assembly::Context& context,
                                                          const std::vector<int>& fields, int power_to,
                                                          const ConstView<Real**>& rest);

}  // namespace sprekk::physics
