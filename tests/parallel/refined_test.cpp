// Meshes refined on the ranks, compared with fine meshes distributed directly.
#include "verification/scenes.hpp"

#include <map>

namespace sprekk::tests {
namespace {

using Key = std::array<long long, 3>;

/// Outputs on cells and fracture faces by the coordinates of their centres. Construction is collective.
class ByPlace {
 public:
  explicit ByPlace(model::Model& model) : mesh_(model.mesh()) {
    const Outputs out(model);
    for (const auto& field : out.all()) {
      if (field.entity == fields::Entity::cell) add(field, mesh_.n_global_cells, mesh_.n_owned_cells);
      if (field.entity == fields::Entity::fracture_face)
        add(field, mesh_.n_global_fracture_faces, mesh_.n_owned_fracture_faces);
    }
  }

  std::map<std::string, std::map<Key, std::vector<Real>>> fields;

 private:
  const mesh::Mesh& mesh_;

  std::pair<GlobalIndex, Vector3> place(fields::Entity entity, LocalIndex e) const {
    if (entity == fields::Entity::fracture_face) return {mesh_.fracture_faces[e].id, mesh_.fracture_faces[e].centre};
    Vector3 centre{};
    const int n = mesh::n_corners(mesh_.shape), dim = mesh_.dim();
    for (int k = 0; k < n; ++k)
      for (int i = 0; i < dim; ++i)
        centre[i] += mesh_.coordinates[mesh_.cells[e * mesh_.nodes_per_cell() + k] * dim + i] / n;
    return {mesh_.cell_id[e], centre};
  }

  void add(const assembly::OutputField& field, GlobalIndex n, LocalIndex n_owned) {
    const int width = 3 + field.n_components;
    std::vector<Real> here(n * width, 0), all(here.size());
    for (LocalIndex e = 0; e < n_owned; ++e) {
      const auto [id, centre] = place(field.entity, e);
      std::copy_n(centre.begin(), 3, &here[id * width]);
      std::copy_n(&field.values[e * field.n_components], field.n_components, &here[id * width + 3]);
    }
    Teuchos::reduceAll(*mesh_.comm, Teuchos::REDUCE_SUM, static_cast<int>(here.size()), here.data(), all.data());
    for (GlobalIndex id = 0; id < n; ++id) {
      const auto* values = &all[id * width];
      const auto key = [&](int i) { return std::llround(1e6 * values[i]); };
      fields[field.name][{key(0), key(1), key(2)}].assign(values + 3, values + width);
    }
  }
};

/// Compares lengths within 1e-9 of the prescribed displacement, stresses within 1e-8 of the resulting stress; states
/// exactly.
void expect_same(const assembly::Scales& scales, const ByPlace& a, const ByPlace& b) {
  ASSERT_EQ(a.fields.size(), b.fields.size());
  for (const auto& [name, values] : a.fields) {
    if (name == "mobilised strength") continue;  // its denominator may be small
    const auto& others = b.fields.at(name);
    ASSERT_EQ(values.size(), others.size()) << name;
    const bool stress = name == "stress" || name.find("traction") != name.npos;
    const Real tolerance = name == "state" ? 0 : stress ? 1e-8 * scales.at("stress") : 1e-9 * scales.at("displacement");
    for (const auto& [place, value] : values) {
      const auto other = others.find(place);
      ASSERT_TRUE(other != others.end()) << name << " at " << fmt::format("{}", fmt::join(place, ", "));
      for (std::size_t i = 0; i < value.size(); ++i) EXPECT_NEAR(value[i], other->second[i], tolerance) << name;
    }
  }
}

/// Compares a scene refined once with the scene with twice the cells per direction, in all steps.
void expect_as_made_at_once(const std::string& name, const std::vector<int>& cells, std::vector<std::string> changes) {
  changes.push_back("Solver.tolerance=1e-13");
  auto coarse = changes, fine = changes;
  coarse.push_back(fmt::format("Mesh.cells={{{}}}", fmt::join(cells, ", ")));
  coarse.push_back("Mesh.refinements=1");
  std::vector<int> twice;
  for (int n : cells) twice.push_back(2 * n);
  fine.push_back(fmt::format("Mesh.cells={{{}}}", fmt::join(twice, ", ")));
  const auto comm = Tpetra::getDefaultComm();
  const auto scene = read_scene(name, coarse);
  model::Model refined(scene, comm), at_once(read_scene(name, fine), comm);
  for (Real t : scene.time.times()) {
    SCOPED_TRACE(t);
    const auto report = refined.step_to(t), reference = at_once.step_to(t);
    ASSERT_TRUE(report.converged) << report.reason;
    ASSERT_TRUE(reference.converged) << reference.reason;
    expect_same(at_once.system().scales(), ByPlace(refined), ByPlace(at_once));
  }
}

/// Crossing fractures, with tips in the rock.
TEST(Refined, CrossingFractures) {
  expect_as_made_at_once("verification/crossing_2d.xml", {8, 8}, {"Mesh.cell=quadrilateral"});
  expect_as_made_at_once("verification/crossing_2d.xml", {8, 8},
                         {"Mesh.cell=quadrilateral", "Mesh.order=2", "Time.schedule={1, 3}"});
  for (const auto& cell : cells_of(3))
    expect_as_made_at_once("verification/crossing_3d.xml", {4, 2, 4}, {"Mesh.cell=" + cell, "Time.schedule={3}"});
}

}  // namespace
}  // namespace sprekk::tests
