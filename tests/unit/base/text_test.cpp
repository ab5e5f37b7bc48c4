#include "base/text.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace sprekk::base {
namespace {

using Strings = std::vector<std::string>;

TEST(Text, long_lists_end_with_a_count) {
  EXPECT_EQ(quoted_list({"a", "b"}), "\"a\", \"b\"");
  const Strings names(1000, "n");
  const auto text = quoted_list(names);
  EXPECT_EQ(text.size(), 40 * 5 - 2 + std::string(" and 960 more").size());
  EXPECT_NE(text.find("\"n\" and 960 more"), text.npos);
  EXPECT_LT(quoted_list(Strings(1000, std::string(150, 'n'))).size(), 1700u);
}

TEST(Text, numbers_are_read_whole_or_not_at_all) {
  EXPECT_EQ(parse_number("1.5"), 1.5);
  EXPECT_EQ(parse_number(" -2e-3\n"), -2e-3);
  EXPECT_EQ(parse_number("+7"), 7.0);
  EXPECT_EQ(parse_number("infinite"), std::numeric_limits<Real>::infinity());
  for (const char* text :
       {"", " ", "abc", "1.0abc", "1,5", "1 2", "nan", "inf", "1e999", "0x10", "--1", "+-1", "1e", "."})
    EXPECT_FALSE(parse_number(text)) << text;
}

TEST(Text, integers_and_booleans_are_read_whole_or_not_at_all) {
  EXPECT_EQ(parse_integer("-12"), -12);
  EXPECT_EQ(parse_integer("9223372036854775807"), std::numeric_limits<long long>::max());
  for (const char* text : {"", "1.5", "1e3", "9223372036854775808", "0x10", "3a"})
    EXPECT_FALSE(parse_integer(text)) << text;
  EXPECT_EQ(parse_boolean("TRUE"), true);
  EXPECT_EQ(parse_boolean("false"), false);
  for (const char* text : {"", "yes", "1", "truee"}) EXPECT_FALSE(parse_boolean(text)) << text;
}

TEST(Text, lists_are_split_outside_of_parentheses_and_quotes) {
  EXPECT_EQ(parse_list("{}"), Strings());
  EXPECT_EQ(parse_list(" { a b , c } "), (Strings{"a b", "c"}));
  EXPECT_EQ(parse_list("{atan2(y, x), max(1, min(x, 2))}"), (Strings{"atan2(y, x)", "max(1, min(x, 2))"}));
  EXPECT_EQ(parse_list("{\"a, b\", 'c, \"d\"', \"\"}"), (Strings{"a, b", "c, \"d\"", ""}));
  for (const char* text :
       {"", "{", "a, b", "{a, b", "{a,}", "{,}", "{a,,b}", "{(a}", "{a)}", "{\"a}", "{{a}}", "{a}, {b}"})
    EXPECT_FALSE(parse_list(text)) << text;
}

TEST(Text, numbers_survive_being_written) {
  for (Real value : {0.1, 1.0 / 3.0, 1e-300, -6.02214076e23, 5e-324, 0.0, 30e9, std::nextafter(1.0, 2.0)})
    EXPECT_EQ(parse_number(number_text(value)), value);
  EXPECT_EQ(number_text(0.1), "0.1");
  EXPECT_EQ(number_text(-1), "-1");
  EXPECT_EQ(parse_number(number_text(-INFINITY)), -INFINITY);
}

TEST(Text, long_ones_are_shortened_between_characters) {
  EXPECT_EQ(shortened(std::string(200, 'a')), std::string(200, 'a'));
  EXPECT_EQ(shortened(std::string(1000, 'a')), std::string(60, 'a') + "... (1000 bytes)");
  std::string text;
  for (int i = 0; i < 100; ++i) text += "\u20ac";  // three bytes
  EXPECT_EQ(shortened("." + text), "." + text.substr(0, 57) + "... (301 bytes)");
}

TEST(Text, near_names_are_suggested_and_far_ones_are_not) {
  const Strings names = {"friction coefficient", "tangential stiffness", "normal stiffness", "end"};
  EXPECT_EQ(did_you_mean("friction coeficient", names), ". Did you mean \"friction coefficient\"?");
  EXPECT_EQ(did_you_mean("Friction_Coefficient", names), ". Did you mean \"friction coefficient\"?");
  EXPECT_EQ(did_you_mean("normal stifness", names), ". Did you mean \"normal stiffness\"?");
  EXPECT_EQ(did_you_mean("edn", names), ". Did you mean \"end\"?");
  EXPECT_EQ(did_you_mean("cohesion", names), "");
  EXPECT_EQ(did_you_mean("abc", names), "");
  EXPECT_EQ(did_you_mean("", names), "");
  EXPECT_EQ(did_you_mean("q", {"t"}), "");
  EXPECT_EQ(did_you_mean("T", {"t"}), ". Did you mean \"t\"?");
  EXPECT_EQ(did_you_mean("end", {}), "");
}

}  // namespace
}  // namespace sprekk::base
