// Two joints in series with different laws: Coulomb with the closure of Barton and Bandis; Barton and Choubey with
// linear closure and dilation. Both have the same traction. With C = H/G + sum 1/K_t, k_n = (lambda + 2G)/H, and the
// slip u_p of the slipping joint,
//   N/k_n + Du N/(Du K_1 + N) + N/K_2 = -d_n + tan(theta) u_p,   lambda_t C = d_t - u_p,
//   lambda_t = b(N) if it slips.
#include "verification/uniform/states.hpp"

namespace sprekk::tests {
namespace {

constexpr Real C = 1 / 10e9 + 1 / 20e9 + 1 / 10e9, Du = 1e-4;

Real closed_planar(Real N) { return Du * N / (Du * 50e9 + N); }
Real tangent(Real degrees) { return std::tan(degrees * M_PI / 180); }
Real rough_bound(Real N, Real roughness = 8) { return N * tangent(25 + roughness * std::log10(40e6 / N)); }

/// Returns the compression for which elastic deformation and closure equal the displacement of the top plus dilation.
template <class Slip>
Real compression(Real d_n, Real dilation, const Slip& slip) {
  Real low = 0, high = 1e8;
  for (int k = 0; k < 200; ++k) {
    const Real N = (low + high) / 2;
    (N / 30e9 + closed_planar(N) + N / 40e9 < -d_n + dilation * slip(N) ? low : high) = N;
  }
  return low;
}

struct Sliding {
  const char* fracture;  ///< name of the slipping joint
  Real mu;               ///< friction of the planar joint
};

void expect_column(model::Model& model, const Sliding& sliding, Real d_t) {
  SCOPED_TRACE(d_t);
  const bool rough = std::string(sliding.fracture) == "rough";
  const auto slip = [&](Real N) { return std::max(d_t - C * (rough ? rough_bound(N) : sliding.mu * N), Real(0)); };
  const Real N = compression(-(2e6 / 30e9 + closed_planar(2e6) + 2e6 / 40e9), rough ? tangent(3) : 0, slip);
  const Real u_p = slip(N), l_t = (d_t - u_p) / C;
  for (const char* fracture : {"planar", "rough"}) {
    const bool slides = std::string(fracture) == sliding.fracture, is_rough = std::string(fracture) == "rough";
    const Real closure = is_rough ? -N / 40e9 : -closed_planar(N);
    const Real opening = closure + (is_rough && slides ? tangent(3) * u_p : 0);
    auto e = UniformJoint{l_t, -N, slides ? u_p : 0, opening, closure, is_rough ? 10e9 : 20e9}.along(
        {1, 0, 0}, model.mesh().dim());
    e.fracture = fracture;
    e.tolerance = 1e-9 * 1e-3;  // relative to the largest displacement
    e.traction_tolerance = 1e-9 * 2e6;
    expect_joint(model, e);
  }
}

TEST(KindsOfJoints, InOneScene) {
  for (const int dim : {2, 3})
    for (const auto& d : discretisations(dim))
      for (const auto& sliding : {Sliding{"rough", 0.8}, Sliding{"planar", 0.6}}) {
        SCOPED_TRACE(fmt::format("{}, {} slides", d.name(), sliding.fracture));
        auto scene = read_scene(fmt::format("verification/joint_kinds_{}d.xml", dim), d.with());
        scene.mesh.cells = dim == 2 ? std::vector<int>{1, 4} : std::vector<int>{1, 1, 4};
        scene.materials.at("planar joint").friction_coefficient = sliding.mu;
        model::Model model(scene, Tpetra::getDefaultComm());
        for (const int step : {1, 2, 3}) {
          const auto report = model.step_to(step);
          ASSERT_TRUE(report.converged) << report.reason;
          expect_column(model, sliding, 1e-4 + 1e-3 * (step - 1));
        }
      }
}

/// Sticking joints have a uniform traction; the strength of each face depends on its position.
TEST(KindsOfJoints, StrengthIsThatOfTheFace) {
  for (const int dim : {2, 3}) {
    model::Model model(read_scene(fmt::format("verification/joint_kinds_{}d.xml", dim),
                                  {"Materials.rough joint.joint roughness coefficient=8 + 2*x"}),
                       Tpetra::getDefaultComm());
    ASSERT_TRUE(model.step_to(1).converged);
    const Outputs out(model);
    const auto& mesh = model.mesh();
    for (LocalIndex f = 0; f < mesh.n_owned_fracture_faces; ++f) {
      const auto& face = mesh.fracture_faces[f];
      const bool rough = mesh.fracture_names[face.fracture] == "rough";
      const Real bound = rough ? rough_bound(2e6, 8 + 2 * face.centre[0]) : 0.8 * 2e6;
      EXPECT_NEAR(out.scalar("mobilised strength", f), 1e-4 / C / bound, 1e-8);
      EXPECT_EQ(out.scalar("state", f), 1);
    }
  }
}

}  // namespace
}  // namespace sprekk::tests
