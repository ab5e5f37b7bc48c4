#include "base/units.hpp"

#include <cmath>
#include <sstream>

#include "array.hpp"
#include "base/parameters.hpp"
#include "base/text.hpp"
#include "base/xml.hpp"
#include "message.hpp"

namespace sprekk::base {
namespace {

Real value_of(const std::string& text, const std::string& unit) {
  const auto quantity = parse_quantity(text);
  EXPECT_TRUE(quantity) << text;
  return quantity ? value_in(unit, *quantity) : 0;
}

TEST(Units, numbers_are_what_the_exponent_makes_of_them) {
  EXPECT_EQ(value_of("30 GPa", "Pa"), 30e9);
  EXPECT_EQ(value_of("-5 MPa", "Pa"), -5e6);
  EXPECT_EQ(value_of("+0.3 mm", "m"), 0.3e-3);
  EXPECT_EQ(value_of("0.7um", "m"), 0.7e-6);
  EXPECT_EQ(value_of("3 \u00b5m", "m"), 3e-6);
  EXPECT_EQ(value_of("1.7e-3 km", "m"), 1.7);
  EXPECT_EQ(value_of("12 cm", "m"), 0.12);
  EXPECT_EQ(value_of("2650 kg/m^3", "kg/m^3"), 2650);
  EXPECT_EQ(value_of("2.65 g/cm^3", "kg/m^3"), 2650);
  EXPECT_EQ(value_of("26.5 kN/m^3", "N/m^3"), 26.5e3);
  EXPECT_EQ(value_of("2.5 MJ/(m^3*K)", "J/(m^3*K)"), 2.5e6);
  EXPECT_EQ(value_of("3 W*s/(kg*K)", "J/(kg*K)"), 3);
  EXPECT_EQ(value_of("2 N*m", "kJ"), 2e-3);
  EXPECT_EQ(value_of("5 GPa/m", "Pa/m"), 5e9);
  EXPECT_EQ(value_of("5 MPa/mm", "Pa/m"), 5e9);
  EXPECT_EQ(value_of("5e-3 N*m^-2/m", "Pa/m"), 5e-3);
  EXPECT_EQ(value_of("3 kg/(m*s^2)", "Pa"), 3);
  EXPECT_EQ(value_of("2 kbar", "Pa"), 2e8);
  EXPECT_EQ(value_of("9.81 m/s/s", "m/s^2"), 9.81);
  EXPECT_EQ(value_of("10 l/s", "m^3/s"), 0.01);
  EXPECT_EQ(value_of("250 mL", "m^3"), 2.5e-4);
  EXPECT_EQ(value_of("2 cP", "Pa*s"), 2e-3);
  EXPECT_EQ(value_of("100 ft", "m"), 30.48);
  EXPECT_EQ(value_of("12 in", "ft"), 1);
  EXPECT_NEAR(value_of("1 mD", "m^2"), 9.869233e-16, 1e-22);
  EXPECT_NEAR(value_of("145.0377377 psi", "Pa"), 1e6, 1e-2);
  EXPECT_NEAR(value_of("1 kpsi/ft", "Pa/m"), 22620594, 1);
  EXPECT_EQ(value_of("3e-5 m/s^0.5", "m/s^0.5"), 3e-5);
  EXPECT_NEAR(value_of("0.002 ft/min^0.5", "m/s^0.5"), 0.002 * 0.3048 / std::sqrt(60), 1e-19);
  EXPECT_NEAR(value_of("1 MPa*m^0.5", "Pa*mm^0.5"), 1e6 * std::sqrt(1000), 1e-6);
  for (int i = 1; i < 1000; ++i) {
    const std::string digits = fmt::format("{}.{}", i / 10, i % 10);
    EXPECT_EQ(value_of(digits + " GPa", "Pa"), *parse_number(digits + "e9"));
    EXPECT_EQ(value_of(digits + " mm", "m"), *parse_number(digits + "e-3"));
  }
}

TEST(Units, spellings_that_people_type) {
  EXPECT_EQ(value_of("2700 kg/m3", "kg/m^3"), 2700);
  EXPECT_EQ(value_of("2.7 t/m3", "kg/m^3"), 2700);
  EXPECT_EQ(value_of("2.7 g/cm3", "kg/m^3"), 2700);
  EXPECT_EQ(value_of("2.7 g/cm\u00b3", "kg/m^3"), 2700);
  EXPECT_EQ(value_of("2700 kg\u00b7m\u207b\u00b3", "kg/m^3"), 2700);
  EXPECT_EQ(value_of("50 N/mm2", "Pa"), 5e7);
  EXPECT_EQ(value_of("50 kN/mm\u00b2", "Pa"), 5e10);
  EXPECT_EQ(value_of("9.81 m/s2", "m/s^2"), 9.81);
  EXPECT_EQ(value_of("3 m2/m", "m"), 3);
  EXPECT_EQ(value_of("1 mPa.s", "Pa*s"), 1e-3);
  EXPECT_EQ(value_of("1 ksi", "Pa"), value_of("1000 psi", "Pa"));
  EXPECT_EQ(value_of("1 darcy", "m^2"), value_of("1 D", "m^2"));
  EXPECT_EQ(value_of("1 md", "m^2"), value_of("1 mD", "m^2"));
  EXPECT_EQ(value_of("1 mdarcy", "m^2"), value_of("1 mD", "m^2"));
  EXPECT_EQ(value_of("200 micron", "m"), 2e-4);
  EXPECT_EQ(value_of("1 week", "s"), 7 * 86400);
  EXPECT_EQ(value_of("1 yr", "s"), 365.25 * 86400);
  EXPECT_EQ(value_of("3 hr", "s"), 10800);
  EXPECT_EQ(value_of("1 t", "kg"), 1000);
}

/// Degrees Celsius have an offset and the size of a kelvin, hence are allowed only for temperatures, without other
/// units.
TEST(Units, degrees_of_celsius) {
  EXPECT_EQ(value_of("77 \u00b0C", "K"), 350.15);
  EXPECT_EQ(value_of("-10 degC", "K"), 263.15);
  const auto refusal = [](const std::string& text, const std::string& unit) {
    return message_of([&] { value_of(text, unit); });
  };
  EXPECT_CONTAINS(refusal("3 W/(m*\u00b0C)", "W/(m*K)"), "\"\u00b0C\" can only stand alone, for an entry in K");
  EXPECT_CONTAINS(refusal("77 \u00b0C", "Pa"),
                  "has the unit \"\u00b0C\", which only entries in K have; allowed are \"Pa\"");
  EXPECT_CONTAINS(refusal("77 m", "K"), "allowed are \"K\", \"\u00b0C\"");
}

TEST(Units, times_and_angles) {
  EXPECT_EQ(value_of("10 days", "s"), 864000);
  EXPECT_EQ(value_of("1.5 h", "s"), 5400);
  EXPECT_EQ(value_of("90 min", "s"), 5400);
  EXPECT_EQ(value_of("90 min", "min"), 90);
  EXPECT_EQ(value_of("1e5 year", "s"), 1e5 * 365.25 * 86400);
  EXPECT_EQ(value_of("250 ms", "s"), 0.25);
  for (const char* text : {"35 deg", "35 degree", "35 degrees", "35\u00b0"}) EXPECT_EQ(value_of(text, "degree"), 35);
  EXPECT_NEAR(value_of("0.6 rad", "degree"), 0.6 * 180 / M_PI, 1e-14);
  EXPECT_NEAR(value_of("180 deg", "rad"), M_PI, 1e-15);
}

TEST(Units, what_measures_something_else_is_refused) {
  const auto refusal = [](const std::string& text, const std::string& unit) {
    return message_of([&] { value_of(text, unit); });
  };
  EXPECT_EQ(refusal("30 m", "Pa"),
            "has the unit \"m\"; allowed are \"Pa\", \"kPa\", \"MPa\", \"GPa\", \"bar\", \"psi\" and other units "
            "of the same quantity");
  EXPECT_CONTAINS(refusal("30 MPa", "Pa/m"), "has the unit \"MPa\"; allowed are \"Pa/m\", \"kPa/m\", \"MPa/m\"");
  EXPECT_CONTAINS(refusal("30 kg", "kg/m^3"), "allowed are \"kg/m^3\", \"g/m^3\" and");
  EXPECT_CONTAINS(refusal("1 s", "m/s^2"), "allowed are \"m/s^2\", \"km/s^2\"");
  EXPECT_CONTAINS(refusal("30 deg", "-"), "has the unit \"deg\", must be a number without a unit");
  EXPECT_CONTAINS(refusal("1 m", "degree"), "allowed are \"degree\", \"rad\"");
  EXPECT_CONTAINS(refusal("1 N/m", "Pa"), "has the unit \"N/m\"");
  EXPECT_CONTAINS(refusal("1e305 GPa", "Pa"), "outside of the range of a double");
}

TEST(Units, texts_that_are_no_units) {
  for (const char* unit : {"Pa", "kg/m^3", "N*m", "m^-2", "(m/s)^2", "N / m ^ 2", "((m))"})
    EXPECT_EQ(defect_of_unit(unit), "") << unit;
  for (const char* unit : {"", "/m", "m/", "m^", "m^x", "m^0", "m0", "m 3", "m m", "m.", "m\u00b2\u00b2", "m/\u00b0C",
                           "(m", "m)", "kdeg", "mday", "2", "m^12", "x"})
    EXPECT_NE(defect_of_unit(unit), "") << unit;
  EXPECT_NE(defect_of_unit(std::string(100000, '(')), "");
  EXPECT_EQ(defect_of_unit("gpa"), "unknown unit \"gpa\". Did you mean \"GPa\"?");
  EXPECT_EQ(defect_of_unit("mpa/m"), "unknown unit \"mpa\". Did you mean \"MPa\"?");
  EXPECT_EQ(defect_of_unit("GPs"), "unknown unit \"GPs\". Did you mean \"GPa\"?");
  EXPECT_EQ(defect_of_unit("degre"), "unknown unit \"degre\". Did you mean \"degree\"?");
  for (const char* text : {"", "Pa", "1", "1e5", "1 *x", "1, 2", "nan m", "infinite m", "1e999 m", "--1 m"})
    EXPECT_FALSE(parse_quantity(text)) << text;
}

struct Rock {
  Real modulus = 1e9, ratio = 0.25, end = 1, angle = 30;
  std::vector<Real> corner;
  Expression stiffness = 1;
  std::vector<Expression> traction, path;
  Teuchos::ParameterList library;
  Expression::Named named;
  void describe(Section& s) {
    s.expressions_call({}, named);
    s.entry(modulus, "modulus", "Pa", positive(), "E");
    s.entry(ratio, "ratio", "-", between(0, 0.5), "nu");
    s.entry(end, "end", "s", "of the run");
    s.entry(angle, "angle", "degree", between(0, 90), "of friction");
    s.entry(corner, "corner", "m", "of the box");
    s.entry(stiffness, "stiffness", "Pa/m", positive_or_infinite(), "K");
    s.entry(traction, "traction", "Pa", any().or_word("free"), "on the body");
    s.entry(path, "path", "m, Pa", "a length and a pressure");
    s.passthrough(library, "library", "as it is");
  }
};

Rock rock_with(const std::string& entries, const std::vector<std::string>& overrides = {}) {
  auto list = parse_xml("<ParameterList name=\"R\">" + entries + "</ParameterList>", "f", "R", Defects::keep);
  return read<Rock>(list, "f", "R", apply_overrides(list, "f", overrides));
}
std::string entry(const std::string& name, const std::string& type, const std::string& value) {
  return fmt::format("<Parameter name=\"{}\" type=\"{}\" value=\"{}\"/>", name, type, value);
}
std::string refusal(const std::string& name, const std::string& type, const std::string& value) {
  return message_of([&] { rock_with(entry(name, type, value)); });
}

TEST(Units, are_read_in_every_entry_that_has_one) {
  const auto rock = rock_with(
      entry("modulus", "double", "30 GPa") + entry("end", "double", "1e5 year") + entry("angle", "double", "0.6 rad") +
      entry("corner", "Array(double)", "{0, 5 cm, 2}") + entry("stiffness", "string", "5 GPa/m") +
      entry("traction", "Array(string)", "{free, -5 MPa, 2*x}") + entry("path", "Array(double)", "{1 mm, 2 kPa}"));
  EXPECT_EQ(rock.modulus, 30e9);
  EXPECT_EQ(rock.end, 1e5 * 365.25 * 86400);
  EXPECT_NEAR(rock.angle, 34.37746770784939, 1e-13);
  EXPECT_EQ(rock.corner, (std::vector<Real>{0, 0.05, 2}));
  EXPECT_EQ(rock.stiffness({}, 0), 5e9);
  EXPECT_EQ(rock.traction[0].text(), "free");
  EXPECT_EQ(rock.traction[1]({}, 0), -5e6);
  EXPECT_EQ(rock.traction[2]({3, 0, 0}, 0), 6);
  EXPECT_EQ(rock.path[0]({}, 0), 1e-3);
  EXPECT_EQ(rock.path[1]({}, 0), 2e3);
  EXPECT_EQ(rock_with(entry("stiffness", "double", "5 GPa/m")).stiffness({}, 0), 5e9);
  EXPECT_EQ(rock_with(entry("traction", "Array(double)", "{0, -5 MPa}")).traction[1]({}, 0), -5e6);
  EXPECT_TRUE(std::isinf(rock_with(entry("stiffness", "string", "infinite")).stiffness({}, 0)));
}

TEST(Units, are_read_from_the_command_line) {
  EXPECT_EQ(rock_with("", {"modulus=3 GPa"}).modulus, 3e9);
  EXPECT_EQ(rock_with(entry("modulus", "double", "1"), {"modulus=3 GPa"}).modulus, 3e9);
  EXPECT_EQ(rock_with(entry("modulus", "double", "1 kPa"), {"modulus=3"}).modulus, 3);
  EXPECT_EQ(rock_with("", {"traction={0, -5 MPa}"}).traction[1]({}, 0), -5e6);
  EXPECT_EQ(rock_with("", {"traction={free, -5 MPa}"}).traction[1]({}, 0), -5e6);
  EXPECT_EQ(rock_with(entry("traction", "Array(double)", "{1, 2}"), {"traction={0, -5 MPa}"}).traction[1]({}, 0), -5e6);
}

TEST(Units, errors_name_the_entry_the_value_and_what_is_allowed) {
  EXPECT_EQ(refusal("modulus", "double", "30 m"),
            "f: R > \"modulus\": is \"30 m\", has the unit \"m\"; allowed are \"Pa\", \"kPa\", \"MPa\", \"GPa\", "
            "\"bar\", \"psi\" "
            "and other units of the same quantity");
  EXPECT_EQ(refusal("ratio", "double", "0.2 mm"),
            "f: R > \"ratio\": is \"0.2 mm\", has the unit \"mm\", must be a number without a unit");
  EXPECT_EQ(refusal("modulus", "double", "30 GPaa"),
            "f: R > \"modulus\": is \"30 GPaa\", not a number: unknown unit \"GPaa\". Did you mean \"GPa\"?");
  EXPECT_EQ(refusal("stiffness", "string", "30 GPaa/m"),
            "f: R > \"stiffness\": is \"30 GPaa/m\", neither an expression nor a number with a unit: unknown unit "
            "\"GPaa\". Did you mean \"GPa\"?; allowed are \"Pa/m\", \"kPa/m\", \"MPa/m\", \"GPa/m\", \"bar/m\", "
            "\"psi/m\" and "
            "other units of the same quantity");
  EXPECT_EQ(refusal("end", "string", "1 fortnight"),
            "f: R > \"end\": is \"1 fortnight\", no number with a unit: unknown unit \"fortnight\"; allowed are \"s\", "
            "\"min\", \"h\", \"day\", \"year\" and other units of the same quantity");
  EXPECT_CONTAINS(refusal("corner", "Array(double)", "{0, 3 s}"), "\"corner\"[1]: is \"3 s\", has the unit \"s\"");
  EXPECT_CONTAINS(refusal("traction", "Array(string)", "{3 m, x}"), "\"traction\"[0]: is \"3 m\", has the unit \"m\"");
  EXPECT_CONTAINS(refusal("path", "Array(double)", "{1 mm, 2 mm}"), "\"path\"[1]: is \"2 mm\", has the unit \"mm\"");
  EXPECT_CONTAINS(refusal("modulus", "double", "-3 GPa"), "is -3000000000");
  EXPECT_CONTAINS(message_of([] {
                    rock_with("<ParameterList name=\"library\"><ParameterList name=\"in\">" +
                              entry("a", "double", "3 m") + "</ParameterList></ParameterList>");
                  }),
                  "f: R > library > in > \"a\": is \"3 m\", must be without a unit");
}

TEST(Units, the_echo_is_in_si) {
  auto rock = rock_with(entry("modulus", "double", "30 GPa") + entry("corner", "Array(double)", "{0, 5 cm}") +
                        entry("traction", "Array(string)", "{free, -5 MPa}") + entry("angle", "double", "35 deg"));
  const auto echo = effective(rock, "R");
  EXPECT_EQ(echo.get<double>("modulus"), 30e9);
  EXPECT_EQ(echo.get<double>("angle"), 35);
  EXPECT_EQ(echo.get<Teuchos::Array<double>>("corner"), array<double>({0, 0.05}));
  EXPECT_EQ(echo.get<Teuchos::Array<std::string>>("traction"), array<std::string>({"free", "-5000000"}));
  auto again = read<Rock>(parse_xml(to_xml(echo), "f", "R"), "f", "R");
  EXPECT_EQ(to_xml(effective(again, "R")), to_xml(echo));
}

TEST(Units, lists_with_units_are_written_and_read) {
  const std::string text = "<ParameterList name=\"R\">" + entry("a", "double", "30 GPa/m") +
                           entry("b", "Array(double)", "{0, -5 MPa}") + "</ParameterList>";
  const auto list = parse_xml(text, "f", "R");
  EXPECT_EQ(list.get<Quantity>("a"), (Quantity{30, "GPa/m"}));
  EXPECT_EQ(to_xml(parse_xml(to_xml(list), "f", "R")), to_xml(list));
  EXPECT_CONTAINS(to_xml(list), "value=\"{0, -5 MPa}\"");
}

}  // namespace
}  // namespace sprekk::base
