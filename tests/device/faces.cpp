// All joint laws on random faces: residual, Jacobian, contact state, and history variables at the end of a step.
#include "joints.hpp"
#include "physics/mechanics/balanced_side.hpp"
#include "physics/mechanics/joint_face.hpp"
#include "laws/joint_points_laws.hpp"
#include "report.hpp"

#include <cstdio>
#include <stdexcept>

namespace sprekk::device {
namespace {

using mesh::Shape;

/// Joints with a history of cyclic slip, equal in every program.
template <int dim>
struct Faces {
  std::vector<laws::Joint> joints;
  int n_saved = 0;
  std::vector<Real> history;  // [joint, p_old and history variables]

  int size() const { return dim - 1 + n_saved; }

  Faces(Report& report, const std::string& name, std::vector<laws::Joint> laws) : joints(std::move(laws)) {
    for (const auto& joint : joints) n_saved = std::max(n_saved, joint.n_history(dim));
    auto& input = report.inputs[name];
    if (!report.has_inputs) {
      Random random(dim);
      for (const auto& joint : joints) add(joint, random, input);
    }
    history = input;
  }

 private:
  void add(const laws::Joint& joint, Random& random, std::vector<Real>& all) const {
    std::vector<Real> before(n_saved, 0), saved(n_saved, 0);
    Real p[dim - 1] = {};
    for (int step = 0; step < 8; ++step) {
      Real w[dim], lambda[dim], old[dim - 1];
      w[0] = random(-2e-4, 3e-4);
      lambda[0] = random(-8e6, 0);
      for (int i = 0; i < dim - 1; ++i) {
        old[i] = p[i];
        p[i] = w[i + 1] = old[i] + random(-3e-4, 3e-4);
        lambda[i + 1] = random(-4e6, 4e6);
      }
      const auto state = random.chance(0.1) ? laws::ContactState::open : laws::ContactState::slip;
      before = saved;
      const laws::History history{before.data(), 1};
      joint.commit(laws::converged<dim>(joint, state, w, lambda, p, old, history), {saved.data(), 1});
    }
    all.insert(all.end(), p, p + dim - 1);
    all.insert(all.end(), saved.begin(), saved.end());
  }
};

/// Face operator with the laws that it points to.
template <Shape shape>
struct Face : physics::JointFace<mesh::dimension(shape), mesh::n_face_nodes(shape), false> {
  ConstView<laws::Joint*> laws;
};

/// Computes the history variables of a face after a step that ends at the unknowns.
template <class Face, int n_saved>
struct Commit {
  static constexpr int dim = Face::dim;
  Face face;
  View<Real**> x;    // [face, column]
  View<Real**> out;  // [face, number]

  KOKKOS_INLINE_FUNCTION void operator()(int f) const {
    Real local[Face::Columns::size], elastic[dim], plastic[dim], p[dim - 1], saved[n_saved];
    for (int k = 0; k < Face::Columns::size; ++k) local[k] = x(f, k);
    const auto end = face.point(f, local);
    const auto& law = face.points.law[face.points.number(f)];
    laws::split_jump<dim>(law, end.state, end.w, end.traction, end.p_old, elastic, plastic, face.points.history(f));
    for (int i = 0; i < dim - 1; ++i) p[i] = end.state == laws::ContactState::stick ? end.p_old[i] : plastic[i + 1];
    for (int k = 0; k < n_saved; ++k) saved[k] = face.points.stored_history(f, k);
    law.commit(laws::converged<dim>(law, end.state, end.w, end.traction, p, end.p_old, face.points.history(f)),
               {saved, 1});
    for (int k = 0; k < n_saved; ++k) out(f, k) = saved[k];
  }
};

/// Returns operator and unknowns; face f has joint f/n of all. Frames, tractions and displacements are random.
template <Shape shape>
auto joint_faces(const Faces<mesh::dimension(shape)>& faces, int n) {
  using Face = device::Face<shape>;
  constexpr int dim = Face::dim, n_nodes = Face::n, n_columns = Face::Columns::size;
  const int n_joints = static_cast<int>(faces.joints.size());
  Random random(17);
  const auto numbers = [&](Real low, Real high) {
    return [&random, low, high](const auto& view) {
      for (std::size_t k = 0; k < view.size(); ++k) view.data()[k] = random(low, high);
    };
  };
  Face face;
  face.points.frame = filled<Real***>(
      [&](const auto& view) {
        for (int f = 0; f < n; ++f) {  // rotation
          const Real a = random(0, 6.28), b = random(0, 3.14), ca = std::cos(a), sa = std::sin(a);
          const Real rows[3][3] = {{ca, sa, 0},
                                   {-sa * std::cos(b), ca * std::cos(b), std::sin(b)},
                                   {sa * std::sin(b), -ca * std::sin(b), std::cos(b)}};
          for (int i = 0; i < dim; ++i)
            for (int k = 0; k < dim; ++k) view(f, i, k) = dim == 3 || i == 0 ? rows[i][k] : k == 0 ? -sa : ca;
        }
      },
      n, dim, dim);
  face.share = filled<Real**>(numbers(0.8 / n_nodes, 1.2 / n_nodes), n, n_nodes);
  face.bubble_mean = filled<Real*>(numbers(0.4, 0.7), n);
  face.laws = filled<laws::Joint*>(
      [&](const auto& view) { std::copy(faces.joints.begin(), faces.joints.end(), view.data()); }, n_joints);
  const auto joint = [&](int f) { return static_cast<int>(static_cast<long>(f) * n_joints / n); };
  face.points.law = face.laws.data();
  face.points.number = filled<int*>(
      [&](const auto& view) {
        for (int f = 0; f < n; ++f) view(f) = joint(f);
      },
      n);
  face.points.augmentation = filled<Real*>(numbers(2e10, 1e11), n);
  const auto copy = [&](int begin) {
    return [&faces, &joint, begin, n](const auto& view) {
      for (int f = 0; f < n; ++f)
        for (std::size_t k = 0; k < view.extent(1); ++k)
          view(f, k) = faces.history[joint(f) * faces.size() + begin + k];
    };
  };
  face.points.p_old = filled<Real**>(copy(0), n, dim - 1);
  if (faces.n_saved > 0) face.points.stored_history = filled<Real**>(copy(dim - 1), n, faces.n_saved);
  const auto old = host_of(face.points.p_old);
  const auto frame = host_of(face.points.frame);
  const auto x = filled<Real**>(
      [&](const auto& view) {
        for (int f = 0; f < n; ++f) {
          const bool slips = random.chance(0.7);
          Real w[dim];
          w[0] = random(-3e-4, 2e-4);
          for (int i = 1; i < dim; ++i) w[i] = old(f, i - 1) + (slips ? random(-2e-4, 2e-4) : random(-2e-6, 2e-6));
          for (int a = 0; a < n_nodes; ++a)
            for (int i = 0; i < dim; ++i) {
              view(f, a * dim + i) = random(-1e-4, 1e-4);
              Real jump = 0;
              for (int k = 0; k < dim; ++k) jump += frame(f, k, i) * w[k];
              view(f, (n_nodes + a) * dim + i) = view(f, a * dim + i) + jump;
            }
          for (int k = Face::beta; k < Face::lambda; ++k) view(f, k) = random(-1e-6, 1e-6);
          view(f, Face::lambda) = random(-9e6, 1e6);
          for (int i = 1; i < dim; ++i) view(f, Face::lambda + i) = random(-4e6, 4e6);
        }
      },
      n, n_columns);
  return std::pair(face, x);
}

/// True if the history variable k of a joint is an angle of a directional table; the table is stored last.
bool is_angle(const laws::Joint& joint, int dim, int k) {
  if (dim == 2 || laws::n_history(joint.damage) != laws::AnisotropicDamage::n_history) return false;
  const int place = k - (joint.n_history(dim) - laws::DirectionFan::n_numbers);  // 0: number of angles
  return place > 0 && (place - 1) % 5 == 0;
}

/// Adds the commit of all faces. The scale of differences is the history variable, at least 1e-4, or 1 for angles: a
/// small angle is a difference of directions and has their absolute error.
template <Shape shape>
void add_commit(Report& report, const std::string& name, const Faces<mesh::dimension(shape)>& faces, int n) {
  using Face = device::Face<shape>;
  constexpr int n_saved = device::n_saved<Face::dim>;  // as in `faces`, which have all laws
  const auto made = joint_faces<shape>(faces, n);
  const Commit<Face, n_saved> commit{made.first, made.second, View<Real**>("out", n, n_saved)};
  Kokkos::parallel_for("commit", Kokkos::RangePolicy<Execution>(0, n), commit);
  const auto saved = host_of(commit.out);
  Case& result = report.cases[name];
  for (int f = 0; f < n; ++f) {
    const auto& joint = faces.joints[static_cast<long>(f) * faces.joints.size() / n];
    for (int k = 0; k < n_saved; ++k) {
      const Real least = is_angle(joint, Face::dim, k) ? 1 : 1e-4;
      result.value.push_back(saved(f, k));
      result.scale.push_back(std::max(std::abs(saved(f, k)), least));
    }
  }
}

/// Prints the numbers of faces per contact state. Throws if a state is rare.
void tell_states(const std::string& name, const Case& one, int n) {
  const int size = static_cast<int>(one.value.size()) / n;
  int count[3] = {};
  for (int f = 0; f < n; ++f) ++count[static_cast<int>(one.value[(f + 1) * size - 1])];
  std::printf("%s: %d open, %d stick, %d slip\n", name.c_str(), count[0], count[1], count[2]);
  if (10 * std::min({count[0], count[1], count[2]}) < n) throw std::runtime_error(name + ": states are too rare");
}

template <Shape shape>
void add_joints(Report& report, const std::string& dim) {
  using Faces = device::Faces<mesh::dimension(shape)>;
  const Faces all(report, dim + " histories", all_joints()), common(report, dim + " no history", {common_joint()});
  const int n = 4 * static_cast<int>(all.joints.size());
  const auto faces = [](const Faces& faces) { return [&faces](int n) { return joint_faces<shape>(faces, n); }; };
  add_case(report, dim + " faces, all laws", n, report.n_timed, faces(all));
  tell_states(dim, report.cases[dim + " faces, all laws"], n);
  add_case(report, dim + " faces, Coulomb", 1000, report.n_timed, faces(common));
  add_commit<shape>(report, dim + " faces, end of a step", all, n);
}

/// Returns sides of faces with random values.
template <Shape shape>
auto sides(int n) {
  using Side = physics::BalancedSide<shape>;
  Random random(5);
  const auto fill = [&](const auto& view) {
    const auto host = Kokkos::create_mirror_view(view);
    for (std::size_t k = 0; k < host.size(); ++k) host.data()[k] = random(-1, 1);
    Kokkos::deep_copy(view, host);
  };
  Side side(n);
  fill(side.coupling);
  fill(side.frame);
  fill(side.stiffness);
  fill(side.bubble);
  fill(side.push);
  fill(side.force);
  const View<Real**> x("x", n, Side::Columns::size);
  fill(x);
  return std::pair(side, x);
}

}  // namespace

void add_faces(Report& report) {
  add_joints<Shape::triangle>(report, "2D");
  add_joints<Shape::tetrahedron>(report, "3D");
  add_case(report, "3D sides of faces", 1000, report.n_timed, [](int n) { return sides<Shape::tetrahedron>(n); });
}

}  // namespace sprekk::device
