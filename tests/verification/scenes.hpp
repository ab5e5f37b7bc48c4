// Common functions of the suites of whole scenes: reading and rotating scenes, and outputs by name.
#pragma once

#include "mesh/box.hpp"
#include "model/model.hpp"
#include "source_dir.hpp"

#include <Teuchos_CommHelpers.hpp>
#include <Tpetra_Core.hpp>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace sprekk::tests {

using Vector3 = std::array<Real, 3>;
using Matrix3 = std::array<Vector3, 3>;

/// Reads xml/NAME.
inline model::Scene read_scene(const std::string& name, const std::vector<std::string>& overrides = {}) {
  return model::read_scene(*Tpetra::getDefaultComm(), source_dir() + "/xml/" + name, overrides);
}

/// Returns whether `here` is true on some rank. Collective.
inline bool anywhere(const Comm& comm, bool here) {
  const int mine = here ? 1 : 0;
  int any = 0;
  Teuchos::reduceAll(comm, Teuchos::REDUCE_MAX, 1, &mine, &any);
  return any == 1;
}

inline Matrix3 identity() { return {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}; }

/// Returns the rotation matrix about an axis, counter-clockwise, angle in degrees: c 1 + s [a]x + (1 - c) a a^T.
inline Matrix3 rotation(Real degrees, const Vector3& axis) {
  const Real length = std::hypot(axis[0], axis[1], axis[2]), angle = degrees * M_PI / 180;
  const Real c = std::cos(angle), s = std::sin(angle);
  const Vector3 a = {axis[0] / length, axis[1] / length, axis[2] / length};
  Matrix3 Q;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) Q[i][j] = (i == j ? c : 0) + (1 - c) * a[i] * a[j];
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    Q[j][i] += s * a[k];
    Q[i][j] -= s * a[k];
  }
  return Q;
}

inline Vector3 times(const Matrix3& Q, const Vector3& v) {
  Vector3 result{};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) result[i] += Q[i][j] * v[j];
  return result;
}

inline Vector3 transposed_times(const Matrix3& Q, const Vector3& v) {
  Vector3 result{};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) result[i] += Q[j][i] * v[j];
  return result;
}

inline Real dot(const Vector3& a, const Vector3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
inline Vector3 difference(const Vector3& a, const Vector3& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
inline Real norm(const Vector3& a) { return std::sqrt(dot(a, a)); }

/// Rotates a scene: the box and the vectors of all boundary conditions. The conditions must prescribe every component
/// and not depend on the coordinates. Returns the rotation matrix.
inline Matrix3 turn(model::Scene& scene, Real degrees, const Vector3& axis) {
  scene.mesh.rotation = degrees;
  scene.mesh.rotation_axis = {axis[0], axis[1], axis[2]};
  const Matrix3 Q = rotation(degrees, axis);
  const auto tables = std::make_shared<const base::Tables>(scene.tables);
  const auto turn_vector = [&](std::vector<base::Expression>& vector) {
    std::vector<base::Expression> turned;
    for (std::size_t i = 0; i < vector.size(); ++i) {
      std::string text = "0";
      for (std::size_t j = 0; j < vector.size(); ++j)
        text += fmt::format(" + ({:.17g})*({})", Q[i][j], vector[j].text());
      turned.emplace_back(text);
      turned.back().compile(tables);
    }
    vector = turned;
  };
  for (auto& [name, condition] : scene.boundary_conditions) {
    turn_vector(condition.displacement);
    turn_vector(condition.traction);
  }
  return Q;
}

/// Translates the box of a scene by v, before any rotation. Its loads must not depend on the coordinates.
inline void translate(model::Scene& scene, const Vector3& v) {
  const auto move = [&](std::vector<Real>& corner) {
    for (std::size_t i = 0; i < corner.size(); ++i) corner[i] += v[i];
  };
  move(scene.mesh.lower_corner);
  move(scene.mesh.upper_corner);
  for (auto& [name, fracture] : scene.mesh.fractures) {
    move(fracture.lower_corner);
    move(fracture.upper_corner);
  }
}

/// Returns the cell shapes of a dimension.
inline std::vector<std::string> cells_of(int dim) {
  return dim == 2 ? std::vector<std::string>{"quadrilateral", "triangle"}
                  : std::vector<std::string>{"hexahedron", "tetrahedron"};
}

/// Cell shape and order for a scene.
struct Discretisation {
  std::string cell;
  int order;

  std::string name() const { return fmt::format("{} of order {}", cell, order); }
  /// Returns overrides of a scene for this discretisation, followed by others.
  std::vector<std::string> with(const std::vector<std::string>& others = {}) const {
    std::vector<std::string> all = {"Mesh.cell=" + cell, fmt::format("Mesh.order={}", order)};
    all.insert(all.end(), others.begin(), others.end());
    return all;
  }
};

/// Returns all discretisations of a dimension.
inline std::vector<Discretisation> discretisations(int dim) {
  std::vector<Discretisation> all;
  for (const auto& cell : cells_of(dim))
    for (const int order : {1, 2}) all.push_back({cell, order});
  return all;
}

/// Outputs of the present state of a model, for the entities that this rank owns.
class Outputs {
 public:
  explicit Outputs(model::Model& model) : fields_(model.system().outputs(model.state())) {}

  const assembly::OutputField& operator[](const std::string& name) const {
    const auto found = std::find_if(fields_.begin(), fields_.end(), [&](const auto& f) { return f.name == name; });
    if (found == fields_.end()) throw Error("there is no output \"" + name + "\"");
    return *found;
  }
  Real scalar(const std::string& name, int entity) const { return (*this)[name].values.at(entity); }
  Vector3 vector(const std::string& name, int entity) const {
    const auto& field = (*this)[name];
    Vector3 v{};
    std::copy_n(field.values.begin() + entity * field.n_components, field.n_components, v.begin());
    return v;
  }
  const std::vector<assembly::OutputField>& all() const { return fields_; }

 private:
  std::vector<assembly::OutputField> fields_;
};

/// Expected state of all faces of a plane fracture, with the normal n before the rotation Q of the scene. Vectors are
/// for sides ordered along n. For the opposite order in the mesh, jumps and tractions change sign.
struct Expected {
  Vector3 n, elastic, plastic, traction;
  Real tolerance = 1e-9, traction_tolerance = 1e-9;  ///< absolute
  std::string fracture = {};                         ///< name; empty: all fractures
};

/// Compares the vectors in the unrotated frame, and frame-independent outputs.
inline void expect_joint(model::Model& model, const Expected& e, const Matrix3& Q = identity()) {
  const Outputs out(model);
  const auto n = times(Q, e.n);
  for (LocalIndex f = 0; f < model.mesh().n_owned_fracture_faces; ++f) {
    const auto& face = model.mesh().fracture_faces[f];
    if (!e.fracture.empty() && model.mesh().fracture_names[face.fracture] != e.fracture) continue;
    const auto& frame = face.frame;
    const Real sign = dot(frame[0], n);
    ASSERT_NEAR(std::abs(sign), 1, 1e-12);
    const auto back = [&](const char* name) {
      auto v = transposed_times(Q, out.vector(name, f));
      for (Real& c : v) c *= sign;
      return v;
    };
    const auto elastic = back("elastic jump"), plastic = back("plastic jump"), jump = back("jump"),
               traction = back("traction");
    for (int i = 0; i < 3; ++i) {
      EXPECT_NEAR(elastic[i], e.elastic[i], e.tolerance) << "face " << f << " component " << i;
      EXPECT_NEAR(plastic[i], e.plastic[i], e.tolerance) << "face " << f << " component " << i;
      EXPECT_NEAR(jump[i], e.elastic[i] + e.plastic[i], e.tolerance) << "face " << f << " component " << i;
      EXPECT_NEAR(traction[i], e.traction[i], e.traction_tolerance) << "face " << f << " component " << i;
    }
    const Real opening = dot(e.elastic, e.n) + dot(e.plastic, e.n);
    Vector3 slip = e.plastic;
    for (int i = 0; i < 3; ++i) slip[i] -= dot(e.plastic, e.n) * e.n[i];
    EXPECT_NEAR(out.scalar("opening", f), opening, e.tolerance);
    EXPECT_NEAR(out.scalar("slip", f), norm(slip), e.tolerance);
    for (const std::string name : {"jump", "elastic jump", "plastic jump", "traction"}) {
      const auto local = out.vector(name + " local", f), global = out.vector(name, f);
      for (int k = 0; k < model.mesh().dim(); ++k)
        EXPECT_NEAR(local[k], dot(frame[k], global), 1e-14 * (1 + norm(global))) << name;
    }
  }
}

/// Returns the area-weighted mean of an output component over all fractures. Collective.
inline Real mean(const model::Model& model, const assembly::OutputField& field, int component) {
  Real here[2] = {0, 0}, all[2];
  for (LocalIndex f = 0; f < model.mesh().n_owned_fracture_faces; ++f) {
    const Real area = model.mesh().fracture_faces[f].area;
    here[0] += area * field.values[f * field.n_components + component];
    here[1] += area;
  }
  Teuchos::reduceAll(*model.mesh().comm, Teuchos::REDUCE_SUM, 2, here, all);
  return all[0] / all[1];
}

/// Faces of all ranks by global number: vectors in the unrotated frame, sides ordered along n.
struct GatheredFaces {
  std::vector<Vector3> centre, jump, traction;
};

/// Returns the faces of all ranks, equal on every rank. Collective.
inline GatheredFaces gathered_faces(model::Model& model, const Matrix3& Q, const Vector3& n) {
  const Outputs out(model);
  const auto& mesh = model.mesh();
  std::vector<Real> here(9 * mesh.n_global_fracture_faces, 0), all(here.size());
  for (LocalIndex f = 0; f < mesh.n_owned_fracture_faces; ++f) {
    const auto& face = mesh.fracture_faces[f];
    const Real sign = dot(face.frame[0], times(Q, n));
    const Vector3 vectors[] = {face.centre, out.vector("jump", f), out.vector("traction", f)};
    for (int k = 0; k < 3; ++k) {
      const auto back = transposed_times(Q, vectors[k]);
      for (int i = 0; i < 3; ++i) here[9 * face.id + 3 * k + i] = (k == 0 ? 1 : sign) * back[i];
    }
  }
  Teuchos::reduceAll(*mesh.comm, Teuchos::REDUCE_SUM, static_cast<int>(here.size()), here.data(), all.data());
  GatheredFaces faces;
  for (GlobalIndex id = 0; id < mesh.n_global_fracture_faces; ++id) {
    const auto vector = [&](int k) {
      return Vector3{all[9 * id + 3 * k], all[9 * id + 3 * k + 1], all[9 * id + 3 * k + 2]};
    };
    faces.centre.push_back(vector(0));
    faces.jump.push_back(vector(1));
    faces.traction.push_back(vector(2));
  }
  return faces;
}

}  // namespace sprekk::tests
