// Probes of the block under tension: places, interpolation, columns and messages.
#include "model/probes.hpp"
#include "block.hpp"

#include "base/over_ranks.hpp"

#include <cmath>

namespace sprekk::model::test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Pointwise;

/// Tables of the probes of a scene and their values at the time 1 s.
struct Recorded {
  std::vector<io::SeriesTable> tables;
  std::vector<std::vector<Real>> values;

  std::vector<std::string> columns(std::size_t table = 0) const {
    std::vector<std::string> names;
    for (const auto& column : tables[table].columns) names.push_back(column.name + " [" + column.unit + "]");
    return names;
  }
};

Recorded recorded(const Entries& changes, const nlohmann::json& sums = nlohmann::json::object()) {
  Model model(block(changes), world());
  Probes probes(model);
  EXPECT_TRUE(model.step_to(1).converged);
  const auto outputs = model.system().outputs(model.state());
  std::vector<FractureColumn> sets, singles;
  if (!model.mesh().fracture_names.empty()) {
    sets = fracture_table(model.mesh(), outputs, Grouping::sets);
    singles = fracture_table(model.mesh(), outputs, Grouping::singles);
  }
  auto values = probes.values({outputs, sets, singles, sums, {}});
  return {probes.tables(), values};
}

std::string probe_refusal(const Entries& changes) {
  Model model(block(changes), world());
  return message_of([&] { Probes probes(model); });
}

void expect_values(const std::vector<Real>& values, const std::vector<Real>& expected) {
  EXPECT_THAT(values, Pointwise(::testing::DoubleNear(1e-12), expected));
}

TEST(Probes, OfAPointInterpolateLinearFields) {
  const auto seen = recorded({"Probes.p.point={0.3, 0.7}", "Probes.p.outputs={displacement, stress}"});
  EXPECT_THAT(seen.columns(),
              ElementsAre("displacement x [m]", "displacement y [m]", "stress XX [Pa]", "stress YY [Pa]",
                          "stress ZZ [Pa]", "stress XY [Pa]", "stress YZ [Pa]", "stress XZ [Pa]"));
  EXPECT_TRUE(seen.tables[0].place_columns.empty());
  expect_values(seen.values[0], {0.15, 0, 5, 0, 0, 0, 0, 0});
}

TEST(Probes, OfALineHaveDistanceAndCoordinates) {
  const auto seen =
      recorded({"Probes.p.line={0.5, 0, 2, 0.75}", "Probes.p.points=4", "Probes.p.outputs={displacement}"});
  const auto& table = seen.tables[0];
  EXPECT_EQ(table.n_places(), 4);
  ASSERT_EQ(table.place_columns.size(), 3);
  EXPECT_EQ(table.place_columns[0].name, "distance");
  EXPECT_EQ(table.place_columns[1].name, "x");
  EXPECT_EQ(table.place_columns[2].unit, "m");
  const Real part = std::sqrt(0.5 * 0.5 + 0.25 * 0.25);
  expect_values(table.places, {0, 0.5, 0, part, 1, 0.25, 2 * part, 1.5, 0.5, 3 * part, 2, 0.75});
  expect_values(seen.values[0], {0.25, 0, 0.5, 0, 0.75, 0, 1, 0});
}

TEST(Probes, OfBoundariesAndRegionsAverageBoundAndIntegrate) {
  const std::vector<std::pair<std::string, Real>> cases = {
      {"mean", 0.5}, {"maximum", 1}, {"minimum", 0}, {"integral", 1}};  // u_x = x/2 over a length of 2 m
  for (const auto& [value, expected] : cases) {
    const auto seen = recorded({"Probes.p.boundary=north", "Probes.p.value=" + value, "Probes.p.outputs={displacement}",
                                "Probes.r.region=bulk", "Probes.r.value=" + value, "Probes.r.outputs={displacement}"});
    const bool integral = value == "integral";
    EXPECT_EQ(seen.columns(0)[0], value + " displacement x " + (integral ? "[m*m]" : "[m]"));
    EXPECT_EQ(seen.columns(1)[0], value + " displacement x " + (integral ? "[m*m^2]" : "[m]"));
    expect_values(seen.values[0], {expected, 0});
    expect_values(seen.values[1], {expected, 0});
  }
}

TEST(Probes, OfBoundariesHaveReactions) {
  const nlohmann::json sums = {{"reactions", {{"west", {-5, 0}}}}};
  const auto seen = recorded({"Probes.p.boundary=west", "Probes.p.outputs={reactions}", "Probes.q.boundary=east",
                              "Probes.q.outputs={reactions}"},
                             sums);
  EXPECT_THAT(seen.columns(), ElementsAre("reactions x [N/m]", "reactions y [N/m]"));
  expect_values(seen.values[0], {-5, 0});
  ASSERT_EQ(seen.values[1].size(), 2);
  EXPECT_TRUE(std::isnan(seen.values[1][0]));  // no condition there
}

/// The fault has the compression 5 Pa.
TEST(Probes, OfFracturesHaveOutputsAndResults) {
  const auto seen =
      recorded(with_fault({"Probes.p.fracture=fault", "Probes.p.value=integral", "Probes.p.outputs={slip}",
                           "Probes.q.fracture=fault", "Probes.q.outputs={area, mean_traction_local}",
                           "Probes.r.point={1, 0.3}", "Probes.r.outputs={traction local}"}));
  EXPECT_THAT(seen.columns(0), ElementsAre("integral slip [m*m]"));
  EXPECT_THAT(seen.columns(1), ElementsAre("area [m]", "mean_traction_local n [Pa]", "mean_traction_local t [Pa]"));
  EXPECT_THAT(seen.columns(2), ElementsAre("traction local n [Pa]", "traction local t [Pa]"));
  expect_values(seen.values[0], {0});
  expect_values(seen.values[1], {1, -5, 0});
  expect_values(seen.values[2], {-5, 0});
}

TEST(Probes, AreDefinedByTheirEntries) {
  Model model(block({"Probes.p.point={0.3, 0.7}", "Probes.p.outputs={displacement}"}), world());
  const auto definitions = Probes(model).definitions();
  ASSERT_EQ(definitions.size(), 1);
  EXPECT_THAT(definitions[0], HasSubstr("{0.3, 0.7}"));
  EXPECT_TRUE(Probes(Model(block(), world())).empty());
}

TEST(Probes, MessagesNameTheProbeAndAllowedValues) {
  EXPECT_THAT(probe_refusal({"Probes.p.point={2.1, 0.5}", "Probes.p.outputs={displacement}"}),
              HasSubstr("block.xml: Sprekk > Probes > p: (2.1, 0.5, 0) is outside of the mesh"));
  EXPECT_THAT(probe_refusal({"Probes.p.line={0, 0, 2, 1.5}", "Probes.p.points=3", "Probes.p.outputs={displacement}"}),
              HasSubstr("(2, 1.5, 0) is outside of the mesh"));
  EXPECT_THAT(probe_refusal(with_fault({"Probes.p.point={0.5, 0.5}", "Probes.p.outputs={slip}"})),
              HasSubstr("(0.5, 0.5, 0) is on no fracture"));
  EXPECT_THAT(probe_refusal({"Probes.p.point={1, 0}", "Probes.p.outputs={displacment}"}),
              HasSubstr("\"outputs\": is \"displacment\", must be one of \"displacement\""));
  EXPECT_THAT(probe_refusal({"Probes.p.point={1, 0}", "Probes.p.outputs={stress, stress}"}),
              HasSubstr("\"outputs\": \"stress\" is there twice"));
  EXPECT_THAT(probe_refusal(with_fault({"Probes.p.fracture=fault", "Probes.p.outputs={stress}"})),
              HasSubstr("\"stress\" is of the rock, not of a fracture"));
  EXPECT_THAT(probe_refusal(with_fault({"Probes.p.boundary=east", "Probes.p.outputs={slip}"})),
              HasSubstr("\"slip\" is of fractures; give the \"fracture\""));
}

TEST(Probes, AllMistakesAreReportedTogether) {
  const auto message =
      probe_refusal({"Probes.p.point={3, 0}", "Probes.p.outputs={stress}", "Probes.q.point={1, 1}",
                     "Probes.q.outputs={strain}", "Probes.r.point={1, 1}", "Probes.r.outputs={stress}"});
  EXPECT_EQ(n_lines(message), 2) << message;
}

/// Box of 2 x 1 (x 1) m for a cell shape and order.
Entries box_of(const std::string& cell, int order) {
  Entries all = {"Mesh.cell=" + cell, "Mesh.order=" + std::to_string(order)};
  if (cell == "tetrahedron" || cell == "hexahedron")
    for (const char* entry :
         {"Mesh.lower corner={0, 0, 0}", "Mesh.upper corner={2, 1, 1}", "Mesh.cells={3, 2, 2}",
          "Boundary conditions.held.displacement={0, 0, 0}", "Boundary conditions.pull.traction={1, 0, 0}"})
      all.push_back(entry);
  return all;
}

/// Returns the sum of weight * f(position) and the sum of weights over all ranks. Collective.
template <class Function>
std::array<Real, 2> sums_of(const mesh::Mesh& mesh, const Shares& shares, const Function& f) {
  Real sum = 0, weights = 0;
  for (const auto& [node, weight] : shares) {
    mesh::Vector x{};
    for (int i = 0; i < mesh.dim(); ++i) x[i] = mesh.coordinates[node * mesh.dim() + i];
    sum += weight * f(x);
    weights += weight;
  }
  return {base::sum_over_ranks(*mesh.comm, sum), base::sum_over_ranks(*mesh.comm, weights)};
}

Real linear(const mesh::Vector& x) { return 1 + 2 * x[0] + 3 * x[1] + 5 * x[2]; }

TEST(Shares, InterpolateAndIntegrateLinearFieldsInAllCells) {
  for (const std::string cell : {"quadrilateral", "triangle", "hexahedron", "tetrahedron"})
    for (const int order : {1, 2}) {
      SCOPED_TRACE(cell + " of order " + std::to_string(order));
      const Model model(block(box_of(cell, order)), world());
      const auto& mesh = model.mesh();
      const Real z = mesh.dim() == 3;
      const std::vector<mesh::Vector> points = {{0.31, 0.77, 0.13 * z}, {2, 1, z}, {1, 0.5, 0.5 * z}};
      const auto shares = shares_at(mesh, fields::Entity::node, points);
      ASSERT_EQ(shares.size(), points.size());
      for (std::size_t k = 0; k < points.size(); ++k) {
        const auto [value, weights] = sums_of(mesh, shares[k], linear);
        EXPECT_NEAR(value, linear(points[k]), 1e-12);
        EXPECT_NEAR(weights, 1, 1e-13);
      }
      const auto boundary = [&](const char* name) {
        const auto found = std::find(mesh.boundary_names.begin(), mesh.boundary_names.end(), name);
        return static_cast<int>(found - mesh.boundary_names.begin());
      };
      const auto [east, length] =
          sums_of(mesh, shares_on_boundary(mesh, fields::Entity::node, boundary("east")), linear);
      EXPECT_NEAR(length, 1, 1e-13);
      EXPECT_NEAR(east, linear({2, 0.5, 0.5 * z}), 1e-12);
      const auto [all, volume] = sums_of(mesh, shares_in_region(mesh, fields::Entity::node, 0), linear);
      EXPECT_NEAR(volume, 2, 1e-12);
      EXPECT_NEAR(all, 2 * linear({1, 0.5, 0.5 * z}), 1e-12);
    }
}

TEST(Shares, OfCellsAreTheCellWithTheLowestNumber) {
  const Model model(block(), world());  // cells are 0.5 m x 0.5 m
  const auto& mesh = model.mesh();
  const auto shares = shares_at(mesh, fields::Entity::cell, {{0.6, 0.1, 0}, {1, 0.5, 0}});
  for (const std::size_t k : {0, 1}) {
    Real number = -1;
    for (const auto& share : shares[k]) number = static_cast<Real>(mesh.cell_id[share.entity]);
    EXPECT_EQ(base::max_over_ranks(*mesh.comm, number), 1);
  }
}

TEST(Shares, OfFracturesAreTheirAreas) {
  const Model model(block(with_fault()), world());
  Real area = 0;
  for (const auto& share : shares_on_fractures(model.mesh(), true, 0)) area += share.weight;
  EXPECT_NEAR(base::sum_over_ranks(*world(), area), 1, 1e-14);
  EXPECT_TRUE(shares_on_fractures(model.mesh(), true, 1).empty());
  EXPECT_THAT(message_of([&] {
                shares_at(model.mesh(), fields::Entity::fracture_face, {{1.1, 0.5, 0}});
              }),
              HasSubstr("(1.1, 0.5, 0) is on no fracture"));
}

}  // namespace
}  // namespace sprekk::model::test
