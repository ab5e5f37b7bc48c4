#include "base/expression.hpp"

#include <cmath>

#include "message.hpp"

namespace sprekk::base {
namespace {

using Point = std::array<Real, 3>;

Expression compiled(const std::string& text, const Tables& tables = {}) {
  Expression expression(text, "scene.xml: Sprekk > Loads > \"force\"");
  expression.compile(std::make_shared<Tables>(tables));
  return expression;
}

TEST(Expression, numbers_are_exact_constants) {
  const Expression third(1.0 / 3.0), text("0.1"), nothing;
  EXPECT_EQ(third({}, 0), 1.0 / 3.0);
  EXPECT_EQ(text({1, 2, 3}, 4), 0.1);
  EXPECT_EQ(nothing({}, 0), 0.0);
  EXPECT_TRUE(text.is_constant() && text.constant_in_time());
  EXPECT_EQ(text.text(), "0.1");
  EXPECT_EQ(Expression(third.text())({}, 0), 1.0 / 3.0);
}

TEST(Expression, evaluates_place_and_time) {
  const Point p = {2, 3, 5};
  EXPECT_DOUBLE_EQ(compiled("x + 10*y + 100*z + 1000*t")(p, 7), 7532);
  EXPECT_DOUBLE_EQ(compiled("sin(pi/6)*x^2")(p, 0), 2);
  EXPECT_DOUBLE_EQ(compiled("x < 1 ? 4 : 5")(p, 0), 5);
  EXPECT_DOUBLE_EQ(compiled("(x == 2)*(y >= 3)*(z != 4)")(p, 0), 1);
  EXPECT_DOUBLE_EQ(compiled("atan2(y, x)")(p, 0), std::atan2(3, 2));
  EXPECT_DOUBLE_EQ(compiled("max(x, y, z)")(p, 0), 5);
}

TEST(Expression, knows_the_error_function) {
  EXPECT_DOUBLE_EQ(compiled("erf(x)")({0.5, 0, 0}, 0), std::erf(0.5));
  EXPECT_DOUBLE_EQ(compiled("erfc(x/(2*sqrt(t)))")({2, 0, 0}, 4), std::erfc(0.5));
  EXPECT_TRUE(compiled("erf(1)").is_constant());
}

/// Returns a compiled expression that may call the named expressions `others`.
Expression calling(const std::string& text, const Expression::Named& others) {
  std::vector<std::string> errors;
  const auto named = Expression::compile_all(others, std::make_shared<Tables>(), errors);
  EXPECT_TRUE(errors.empty()) << errors.front();
  Expression expression(text, "place");
  expression.compile(std::make_shared<Tables>(), named);
  return expression;
}

TEST(Expression, calls_others_by_name) {
  const Expression::Named named = {{"depth", Expression("0.5 - y")},
                                   {"weight", Expression("density*depth")},
                                   {"density", 3},
                                   {"late", Expression("t - 1")}};
  EXPECT_DOUBLE_EQ(calling("2*weight^2 - weight", named)({0, 0.1, 0}, 0), 2 * 1.44 - 1.2);
  EXPECT_DOUBLE_EQ(calling("depth*depths", {{"depth", 2}, {"depths", Expression("x")}})({5, 0, 0}, 0), 10);
  EXPECT_TRUE(calling("2*density", named).is_constant());
  EXPECT_DOUBLE_EQ(calling("2*density", named)({}, 0), 6);
  EXPECT_TRUE(calling("weight", named).constant_in_time());
  EXPECT_FALSE(calling("weight + late", named).constant_in_time());
  EXPECT_EQ(calling("x + late", named).text(), "x + late");
}

TEST(Expression, evaluates_others_only_where_they_count) {
  const auto guarded = calling("x > 0 ? root : 0", {{"root", Expression("sqrt(x)", "there")}});
  EXPECT_EQ(guarded({4, 0, 0}, 0), 2);
  EXPECT_EQ(guarded({-4, 0, 0}, 0), 0);
  const auto bare = calling("1 + root", {{"root", Expression("sqrt(x)", "there")}});
  EXPECT_CONTAINS(message_of([&] { bare({-4, 0, 0}, 2); }), "place: \"1 + root\" at x = (-4, 0, 0), t = 2: there: ");
}

TEST(Expression, names_positions_as_they_are_written) {
  EXPECT_CONTAINS(message_of([] { calling("once + once + q", {{"once", 1}}); }), "unknown name \"q\" at position 14");
  EXPECT_CONTAINS(message_of([] { calling("once + )", {{"once", 1}}); }), "position 7");
  EXPECT_CONTAINS(message_of([] { calling("onc", {{"once", 1}}); }), "Did you mean \"once\"?");
}

TEST(Expression, knows_what_it_depends_on) {
  EXPECT_TRUE(compiled("2*pi").is_constant());
  EXPECT_DOUBLE_EQ(compiled("2*pi")({}, 0), 2 * M_PI);
  EXPECT_FALSE(compiled("x").is_constant());
  EXPECT_TRUE(compiled("x*tan(y)").constant_in_time());
  EXPECT_FALSE(compiled("x*t").constant_in_time());
  EXPECT_FALSE(Expression("x").is_constant());
}

TEST(Expression, copies_are_independent_values) {
  auto original = std::make_unique<Expression>(compiled("x + t"));
  const Expression copy = *original;
  EXPECT_EQ((*original)({1, 0, 0}, 2), 3);
  EXPECT_EQ(copy({10, 0, 0}, 20), 30);
  original.reset();
  EXPECT_EQ(copy({5, 0, 0}, 6), 11);
}

TEST(Expression, refuses_what_it_cannot_read) {
  const std::string place = "scene.xml: Sprekk > Loads > \"force\": in \"";
  for (const char* text : {"x +", "x + q", "2x",    "foo(x)", "sin(x", "sin()", "1, 2", "x = 2",   "t += 1", "1..2",
                           "x y", ")",     "\"x\"", "1e",     "x ? 1", "sin",   "nan",  "1e999 z", "#",      "\xff"}) {
    const std::string message = message_of([&] { compiled(text); });
    EXPECT_EQ(message.substr(0, place.size() + std::string(text).size()), place + text);
    EXPECT_CONTAINS(message, "llowed are \"t\", \"x\", \"y\", \"z\", \"pi\", \"abs\", ");
  }
  EXPECT_CONTAINS(message_of([] { compiled("3*alpha"); }), "unknown name \"alpha\" at position 2");
  EXPECT_CONTAINS(message_of([] { compiled("1e-3 + sqrtt(x)"); }),
                  "unknown name \"sqrtt\" at position 7. Did you mean \"sqrt\"?");
  EXPECT_CONTAINS(message_of([] { compiled("x + sin(y"); }), "Missing parenthesis");
  EXPECT_CONTAINS(message_of([] { compiled("1, 2"); }), "must be one expression, is 2");
  EXPECT_CONTAINS(message_of([] { compiled("x = 2"); }), "\"=\" at position 2 assigns");
  EXPECT_CONTAINS(message_of([] { Expression(" ", "place"); }), "place: is empty");
  EXPECT_CONTAINS(message_of([] { Expression{NAN}; }), "must be finite");
  EXPECT_CONTAINS(message_of([] { Expression("x", "place")({}, 0); }), "place: \"x\" was evaluated before");
}

TEST(Expression, refuses_results_that_are_not_finite) {
  const auto inverse = compiled("1/x"), root = compiled("sqrt(t - 1)");
  EXPECT_EQ(inverse({4, 0, 0}, 0), 0.25);
  EXPECT_EQ(message_of([&] {
              inverse({0, 2, 3}, 0.5);
            }),
            "scene.xml: Sprekk > Loads > \"force\": \"1/x\" at x = (0, 2, 3), t = 0.5: is inf, must be finite");
  EXPECT_CONTAINS(message_of([&] { root({}, 0); }), "nan, must be finite");
  EXPECT_CONTAINS(message_of([] { compiled("1/0"); }), "must be finite");
}

TEST(Table, is_piecewise_linear) {
  const Table ramp{{0, 1, 3}, {0, 2, -2}};
  EXPECT_EQ(ramp(0), 0);
  EXPECT_EQ(ramp(0.5), 1);
  EXPECT_EQ(ramp(1), 2);
  EXPECT_EQ(ramp(2), 0);
  EXPECT_EQ(ramp(3), -2);
  const auto scaled = compiled("-0.1*ramp(t) + ramp(0.25)", {{"ramp", ramp}});
  EXPECT_DOUBLE_EQ(scaled({}, 2.5), 0.1 + 0.5);
  EXPECT_FALSE(scaled.constant_in_time());
}

TEST(Table, is_not_defined_outside_of_its_range) {
  const auto ramp = compiled("ramp(t)", {{"ramp", {{0, 1}, {0, 1}}}});
  EXPECT_EQ(
      message_of([&] { ramp({}, 1.5); }),
      "scene.xml: Sprekk > Loads > \"force\": \"ramp(t)\" at x = (0, 0, 0), t = 1.5: table \"ramp\": argument 1.5 "
      "is outside of [0, 1]");
  EXPECT_EQ(ramp({}, 0.75), 0.75);
  EXPECT_CONTAINS(message_of([] { compiled("ramp(2)", {{"ramp", {{0, 1}, {0, 1}}}}); }), "argument 2 is outside");
  EXPECT_CONTAINS(message_of([] { Table{{0, 1}, {0, 1}}(NAN); }), "nan is outside");
}

TEST(Table, refuses_points_that_make_no_function) {
  const auto defect = [](Table table) { return message_of([&] { compiled("f(t)", {{"f", table}}); }); };
  EXPECT_CONTAINS(defect({{0, 1, 2}, {0, 1}}), "table \"f\" has 3 arguments but 2 values");
  EXPECT_CONTAINS(defect({{0}, {1}}), "needs at least 2");
  EXPECT_CONTAINS(defect({{0, 1, 1}, {0, 1, 2}}), "argument 2 is 1 after 1");
  EXPECT_CONTAINS(defect({{0, INFINITY}, {0, 1}}), "must be finite");
  EXPECT_CONTAINS(defect({{0, 1}, {0, NAN}}), "must be finite");
}

TEST(Table, needs_a_name_that_can_be_called) {
  const Table line{{0, 1}, {0, 1}};
  for (const char* name : {"x", "t", "pi", "sin", "two words", "1st", ""})
    EXPECT_CONTAINS(message_of([&] { compiled("x", {{name, line}}); }), std::string("\"") + name + "\"");
}

}  // namespace
}  // namespace sprekk::base
