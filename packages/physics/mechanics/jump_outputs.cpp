#include "physics/mechanics/jump_outputs.hpp"

#include "contact/constraint.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace sprekk::physics {

namespace {

/// Ratio of shear traction to compression of a traction n, t[, t2] (Morris, Ferrill and Henderson 1996); none without
/// compression.
std::optional<Real> slip_tendency(const std::vector<Real>& traction) {
  if (!(traction[0] < 0)) return {};
  return std::hypot(traction[1], traction.size() > 2 ? traction[2] : 0) / -traction[0];
}

/// Moment magnitude of a seismic moment in N m (Hanks and Kanamori 1979); none for zero.
std::optional<Real> moment_magnitude(const std::vector<Real>& moment) {
  if (!(moment[0] > 0)) return {};
  return 2.0 / 3 * (std::log10(moment[0]) - 9.1);
}

/// Unit of the integral over a fracture of a quantity in "-" or "J/m^2".
std::string unit_of_integral(const std::string& unit, int dim) {
  return unit == "-" ? (dim == 2 ? "m" : "m^2") : (dim == 2 ? "J/m" : "J");
}

}  // namespace

template <int dim>
JumpOfFace<dim>::JumpOfFace(const mesh::Mesh::FractureFace& face, const laws::JointPoint<dim>& point,
                            const laws::JointParameters& joint, bool slid, const laws::History& history,
                            bool prescribed)
    : face(face), point(point), state(slid ? laws::ContactState::slip : laws::ContactState::stick) {
  if (point.state == laws::ContactState::open) state = laws::ContactState::open;
  laws::split_jump<dim>(joint.law, state, point.w, point.traction, point.p_old, elastic, plastic, history);
  for (int i = 1; i < dim && prescribed; ++i) {
    plastic[i] = point.p_old[i - 1];
    elastic[i] = point.w[i] - plastic[i];
  }
  Real tangential[dim - 1], since_start[dim - 1];
  for (int i = 0; i < dim - 1; ++i) {
    tangential[i] = plastic[i + 1];
    since_start[i] = point.p_old[i] - joint.plastic_jump[i];  // exactly 0 if a face has never slid
  }
  slip = laws::norm(tangential);
  slip_since_start = laws::norm(since_start);
  aperture = std::max(joint.min_aperture, joint.initial_aperture + point.w[0]);
  at = laws::converged<dim>(joint.law, state, point.w, point.traction, tangential, point.p_old, history);
  const Real bound = joint.law.bound(at);
  if (!at.open && at.shear > 0) mobilised = at.shear / std::max(bound, at.shear * 1e-16);
}

template <int dim>
void declare_jump_outputs(const ElasticPlasticJumpParameters& parameters, const ForEachJump<dim>& for_each,
                          assembly::Declaration& d) {
  using assembly::Summary;
  using Jump = JumpOfFace<dim>;
  const auto add = [&](const std::string& name, const char* unit, int n, const Summary& summary,
                       const std::function<void(const Jump&, std::vector<Real>&)>& append) {
    const auto values = [for_each, append](const assembly::State& state) {
      std::vector<Real> all;
      for_each(state, [&](const Jump& jump) { append(jump, all); });
      return all;
    };
    d.outputs.push_back({{name, unit, fields::Entity::fracture_face, n, summary}, values});
  };
  const auto number = [&](const char* name, const char* unit, const Summary& summary, Real (*of)(const Jump&)) {
    add(name, unit, 1, summary, [of](const Jump& jump, auto& all) { all.push_back(of(jump)); });
  };
  const auto vector = [&](const std::string& name, const char* unit, const Real* (*of)(const Jump&),
                          const std::vector<assembly::Derived>& derived = {}) {
    add(name + " local", unit, dim, {Summary::mean, name, "local", {}, "", derived},
        [of](const Jump& jump, auto& all) { all.insert(all.end(), of(jump), of(jump) + dim); });
    add(name, unit, dim, {Summary::mean, name, "global"}, [of](const Jump& jump, auto& all) {
      for (int i = 0; i < dim; ++i) {
        all.push_back(0);
        for (int l = 0; l < dim; ++l) all.back() += jump.face.frame[l][i] * of(jump)[l];
      }
    });
  };
  vector("jump", "m", [](const Jump& jump) { return jump.point.w; });
  vector("elastic jump", "m", [](const Jump& jump) { return jump.elastic; });
  vector("plastic jump", "m", [](const Jump& jump) { return jump.plastic; });
  vector("traction", "Pa", [](const Jump& jump) { return jump.point.traction; },
         {{"slip_tendency", "-", slip_tendency}});
  number("opening", "m", {Summary::mean_and_max, "opening"}, [](const Jump& jump) { return jump.point.w[0]; });
  number("slip", "m", {Summary::mean_and_max, "slip"}, [](const Jump& jump) { return jump.slip; });
  number("aperture", "m", {}, [](const Jump& jump) { return jump.aperture; });
  number("state", "-", {Summary::fractions, "", "", {std::begin(contact::state_names), std::end(contact::state_names)}},
         [](const Jump& jump) { return static_cast<Real>(jump.state); });
  number("has slipped", "-", {Summary::fractions, "", "", {"", "has slipped"}},
         [](const Jump& jump) { return Real(jump.has_slipped); });
  number("mobilised strength", "-", {}, [](const Jump& jump) { return jump.mobilised; });
  Summary moment{Summary::integral, "moment", "", {}, dim == 3 ? "N*m" : "N"};
  if (dim == 3) moment.derived = {{"moment_magnitude", "-", moment_magnitude}};
  moment.events = {"slip", {"magnitude", "-", moment_magnitude}};
  number("moment density", "N/m", moment, [](const Jump& jump) { return jump.shear_modulus * jump.slip_since_start; });
  number("friction work", "J/m^2", {Summary::integral, "friction energy", "", {}, unit_of_integral("J/m^2", dim)},
         [](const Jump& jump) { return jump.friction_work; });
  if (parameters.n_history > 0)
    number("runaway slip", "m", {Summary::mean_and_max, "runaway slip"}, [](const Jump& jump) { return jump.runaway; });
  for (const auto& quantity : parameters.quantities) {
    Summary summary{Summary::mean_and_max, quantity.name};
    if (!quantity.error_of.empty()) summary = {Summary::error_bound, quantity.error_of};
    if (!quantity.integral.empty())
      summary = {Summary::integral, quantity.integral, "", {}, unit_of_integral(quantity.unit, dim)};
    std::vector<laws::QuantityOfFace> of_joint;
    for (const auto& joint : parameters.joints.values) of_joint.push_back(laws::quantity_of(joint.law, quantity.name));
    add(quantity.name, quantity.unit.c_str(), 1, summary, [of_joint](const Jump& jump, auto& all) {
      const auto& value = of_joint[jump.number];
      all.push_back(value ? value(jump.at) : 0);
    });
  }
}

template struct JumpOfFace<2>;
template struct JumpOfFace<3>;
template void declare_jump_outputs<2>(const ElasticPlasticJumpParameters&, const ForEachJump<2>&,
                                      assembly::Declaration&);
template void declare_jump_outputs<3>(const ElasticPlasticJumpParameters&, const ForEachJump<3>&,
                                      assembly::Declaration&);

}  // namespace sprekk::physics
