// Tables of fractures, from outputs known by hand.
#include "model/fracture_table.hpp"
#include "block.hpp"

#include <cmath>

namespace sprekk::model::test {
namespace {

using assembly::OutputField;
using assembly::Summary;
using ::testing::DoubleNear;
using ::testing::ElementsAre;

/// Block with "fault", two faces at x = 1 m, and "short", one face at y = 0.5 m. All faces have the length 0.5 m.
Model two_fractures() {
  return {block(with_fault({"Mesh.fractures.short.lower corner={1.5, 0.5}",
                            "Mesh.fractures.short.upper corner={2, 0.5}", "Fractures.short.material=joint"})),
          world()};
}

/// Output on the fractures with values of(face).
template <class Value>
OutputField on_faces(const mesh::Mesh& mesh, const Summary& summary, int n, const Value& of) {
  OutputField field = {"output", "Pa", fields::Entity::fracture_face, n, summary};
  for (LocalIndex f = 0; f < mesh.n_owned_fracture_faces; ++f)
    for (int c = 0; c < n; ++c) field.values.push_back(of(mesh.fracture_faces[f], c));
  return field;
}

/// Height of the centre: 0.25 m and 0.75 m on "fault", 0.5 m on "short".
Real height(const mesh::Mesh::FractureFace& face, int) { return face.centre[1]; }

std::vector<FractureColumn> table_of(const mesh::Mesh& mesh, const OutputField& output) {
  return fracture_table(mesh, {output}, Grouping::sets);
}

TEST(FractureTable, HasAreasAndMeansAndMaxima) {
  const auto model = two_fractures();
  const auto& mesh = model.mesh();
  const auto columns = table_of(mesh, on_faces(mesh, {.kind = Summary::mean_and_max, .name = "mean of y"}, 1, height));
  ASSERT_EQ(columns.size(), 3);
  EXPECT_EQ(columns[0].full_name(), "area");
  EXPECT_EQ(columns[0].unit, "m");
  EXPECT_THAT(columns[0].values, ElementsAre(DoubleNear(1, 1e-14), DoubleNear(0.5, 1e-14)));
  EXPECT_EQ(columns[1].full_name(), "mean_mean_of_y");
  EXPECT_EQ(columns[1].unit, "Pa");
  EXPECT_THAT(columns[1].values, ElementsAre(DoubleNear(0.5, 1e-14), DoubleNear(0.5, 1e-14)));
  EXPECT_EQ(columns[2].full_name(), "max_mean_of_y");
  EXPECT_THAT(columns[2].values, ElementsAre(0.75, 0.5));
}

TEST(FractureTable, HasAreasOfClasses) {
  const auto model = two_fractures();
  const auto& mesh = model.mesh();
  const auto is_high = [](const auto& face, int) { return Real(face.centre[1] > 0.6); };
  const auto columns =
      table_of(mesh, on_faces(mesh, {.kind = Summary::fractions, .classes = {"low", "high"}}, 1, is_high));
  ASSERT_EQ(columns.size(), 5);
  EXPECT_EQ(columns[3].name, "area_high");
  EXPECT_THAT(columns[3].values, ElementsAre(DoubleNear(0.5, 1e-14), 0));
  EXPECT_EQ(columns[4].name, "fraction_high");
  EXPECT_THAT(columns[4].values, ElementsAre(DoubleNear(0.5, 1e-14), 0));
  EXPECT_EQ(
      table_of(mesh, on_faces(mesh, {.kind = Summary::fractions, .classes = {"", "is high"}}, 1, is_high))[1].name,
      "area_is_high");
  EXPECT_THAT(digest(described_singles(mesh), columns),
              ElementsAre("low on 2 of 2 fractures: \"short\" (100 % of its area), \"fault\" (50 %)",
                          "high on 1 of 2 fractures: \"fault\" (50 % of its area)"));
}

TEST(FractureTable, HasIntegralsAndDerivedValues) {
  const auto model = two_fractures();
  const auto& mesh = model.mesh();
  const assembly::Derived twice = {"twice", "N", [](const std::vector<Real>& v) -> std::optional<Real> {
                                     return v[0] > 0.4 ? std::make_optional(2 * v[0]) : std::nullopt;
                                   }};
  const auto columns = table_of(
      mesh, on_faces(mesh, {.kind = Summary::integral, .name = "force", .unit = "N", .derived = {twice}}, 1, height));
  ASSERT_EQ(columns.size(), 3);
  EXPECT_EQ(columns[1].name, "twice");
  EXPECT_NEAR(columns[1].values[0], 1, 1e-14);
  EXPECT_TRUE(std::isnan(columns[1].values[1]));
  EXPECT_EQ(columns[2].unit, "N");
  EXPECT_THAT(columns[2].values, ElementsAre(DoubleNear(0.5, 1e-14), DoubleNear(0.25, 1e-14)));
}

TEST(FractureTable, OfSinglesOmitsGlobalVectors) {
  const auto model = two_fractures();
  const auto& mesh = model.mesh();
  const auto vector = [&](const std::string& frame) {
    return on_faces(mesh, {.kind = Summary::mean, .name = "v", .frame = frame}, 2,
                    [](const auto&, int c) { return Real(c == 0 ? -3 : 4); });
  };
  const auto columns = fracture_table(mesh, {vector("global"), vector("local")}, Grouping::singles);
  const auto sets = by_sets(mesh, columns);
  EXPECT_EQ(sets["fault"]["mean_v"]["global"].size(), 2);
  EXPECT_NEAR(sets["short"]["mean_v"]["local"][1].get<Real>(), 4, 1e-14);
  const auto lists = by_singles(columns);
  ASSERT_EQ(lists.size(), 2);
  EXPECT_NEAR(lists["area"][0].get<Real>(), 1, 1e-14);
  EXPECT_EQ(lists["mean_v_local"].size(), 2);
  EXPECT_NEAR(lists["mean_v_local"][1][0].get<Real>(), -3, 1e-14);
  EXPECT_EQ(units(columns), nlohmann::json({{"area", "m"}, {"mean_v_local", "Pa"}}));
}

TEST(FractureTable, DescribesSingleFractures) {
  const auto model = two_fractures();
  const auto singles = described_singles(model.mesh());
  ASSERT_EQ(singles.size(), 2);
  EXPECT_EQ(singles[0]["name"], "fault");
  EXPECT_NEAR(singles[0]["area"].get<Real>(), 1, 1e-14);
  EXPECT_NEAR(singles[0]["centre"][0].get<Real>(), 1, 1e-14);
  EXPECT_NEAR(singles[0]["centre"][1].get<Real>(), 0.5, 1e-14);
  EXPECT_NEAR(singles[0]["strike"].get<Real>(), 0, 1e-12);  // along y, north
  EXPECT_NEAR(singles[1]["strike"].get<Real>(), 90, 1e-12);
  EXPECT_FALSE(singles[0].contains("dip"));
}

TEST(FractureTable, IsWrittenAsCsv) {
  const nlohmann::json described = {{{"name", "a, \"b\""}, {"set", "s"}, {"strike", 90.0}},
                                    {{"name", "c"}, {"set", "s"}, {"strike", 0.0}}};
  const std::vector<FractureColumn> columns = {{"area", "", "m", 1, {2, 1}},
                                               {"area_slip", "", "m^2", 1, {2, 1}},
                                               {"mean_v", "global", "Pa", 2, {5, 6, 7, 8}},
                                               {"mean_v", "local", "Pa", 2, {-3, 0.5, 1e-13, -1e-20}}};
  EXPECT_EQ(to_csv(described, columns),
            "name,set,strike [degree],length [m],area_slip [m^2],mean_v_local n [Pa],mean_v_local t [Pa]\n"
            "\"a, \"\"b\"\"\",s,90,2,2,-3,0.5\n"
            "c,s,0,1,1,1e-13,0\n");
}

}  // namespace
}  // namespace sprekk::model::test
