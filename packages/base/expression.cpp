#include "base/expression.hpp"

#include <muParser.h>

#include <algorithm>
#include <cmath>

#include "base/check.hpp"
#include "base/text.hpp"
#include "base/units.hpp"

namespace sprekk::base {

struct Expression::Compiled {
  mu::Parser parser;
  Real x = 0, y = 0, z = 0, t = 0;
  std::shared_ptr<const Tables> tables;

  void define_names() {
    parser.DefineVar("x", &x);
    parser.DefineVar("y", &y);
    parser.DefineVar("z", &z);
    parser.DefineVar("t", &t);
    parser.DefineConst("pi", 3.14159265358979323846);
  }
};

namespace {

/// Called by muParser; `named_table` points to an entry of the Tables that the expression holds.
double evaluate_table(void* named_table, double argument) {
  const auto& [name, table] = *static_cast<const Tables::value_type*>(named_table);
  try {
    return table(argument);
  } catch (const Error& error) {
    throw Error(fmt::format("table \"{}\": {}", name, error.what()));
  }
}

bool is_letter(char c) { return c == '_' || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

bool is_identifier(const std::string& name) {
  return !name.empty() && is_letter(name[0]) &&
         std::all_of(name.begin(), name.end(), [](char c) { return is_letter(c) || is_digit(c); });
}

std::vector<std::string> known_names(const mu::Parser& parser) {
  std::vector<std::string> names;
  for (const auto& variable : parser.GetVar()) names.push_back(variable.first);
  names.push_back("pi");
  for (const auto& function : parser.GetFunDef()) names.push_back(function.first);
  return names;
}

void define_tables(mu::Parser& parser, const Tables& tables) {
  for (const auto& named_table : tables) {
    const auto& [name, table] = named_table;
    const bool taken = parser.GetFunDef().count(name) || parser.GetVar().count(name) || parser.GetConst().count(name);
    SPREKK_CHECK(!taken, "a table must not be named \"{}\", which has a meaning in expressions", name);
    SPREKK_CHECK(is_identifier(name), "table \"{}\": a name must consist of letters, digits and _ to be called", name);
    const std::string defect = table.defect();
    SPREKK_CHECK(defect.empty(), "table \"{}\" {}", name, defect);
    parser.DefineFunUserData(name, evaluate_table, const_cast<Tables::value_type*>(&named_table), false);
  }
}

/// Refuses names that nothing has. An "e" in a number is no name, as it follows a digit.
void check_names(const std::string& text, const mu::Parser& parser) {
  const auto names = known_names(parser);
  const auto in_word = [](char c) { return is_letter(c) || is_digit(c) || c == '.'; };
  for (auto word = text.begin(); word != text.end();) {
    const auto end = std::find_if_not(word, text.end(), in_word);
    const std::string name(word, end);
    const bool known = std::count(names.begin(), names.end(), name) || parser.GetConst().count(name);
    const auto help = [&] {
      const bool is_unit = defect_of_unit(name).empty();
      return is_unit ? fmt::format("; {}", no_units_in_expressions) : did_you_mean(name, names);
    };
    SPREKK_CHECK(name.empty() || !is_letter(name[0]) || known, "unknown name \"{}\" at position {}{}", shortened(name),
                 word - text.begin(), help());
    word = std::max(end, word + 1);
  }
}

std::string syntax_error(const mu::ParserError& error) {
  const std::string message = shortened(error.GetMsg());
  const bool has_position = error.GetPos() < 0 || message.find("position") != message.npos;
  return has_position ? message : fmt::format("{} at position {}", message, error.GetPos());
}

/// muParser takes "a, b" for two results and "x = 1" for an assignment; neither is a function of place and time.
void check_single_value(const std::string& text) {
  const auto parts = parse_list("{" + text + "}");
  SPREKK_CHECK(!parts || parts->size() == 1, "must be one expression, is {}", parts->size());
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '=') continue;
    const bool comparison = (i > 0 && std::string("<>!=").find(text[i - 1]) != std::string::npos) ||
                            (i + 1 < text.size() && text[i + 1] == '=');
    SPREKK_CHECK(comparison, "\"=\" at position {} assigns; equality is \"==\"", i);
  }
}

}  // namespace

Expression::Expression(Real constant) : constant_(constant) {
  SPREKK_CHECK(!std::isnan(constant), "an expression must be finite (or infinite, where that is allowed), is nan");
}

Expression::Expression(std::string text, std::string place) : text_(std::move(text)), place_(std::move(place)) {
  SPREKK_CHECK(!trimmed(text_).empty(), "{}: is empty, must be a number or an expression of x, y, z, t", place_);
  if (const auto number = parse_number(text_)) *this = Expression(*number);
}

void Expression::compile(std::shared_ptr<const Tables> tables) {
  if (text_.empty()) return;
  auto compiled = std::make_shared<Compiled>();
  auto& parser = compiled->parser;
  const auto fail = [&](const std::string& what) {
    const char* link = what.back() == '?' ? " Allowed are" : "; allowed are";
    throw Error(
        fmt::format("{}: in \"{}\": {}{} {}", place_, shortened(text_), what, link, quoted_list(known_names(parser))));
  };
  try {
    compiled->define_names();
    define_tables(parser, *tables);
    compiled->tables = std::move(tables);
    check_single_value(text_);
    check_names(text_, parser);
    parser.SetExpr(text_);
    for (const auto& variable : parser.GetUsedVar())  // muParser takes what it cannot read for a variable
      SPREKK_CHECK(parser.GetVar().count(variable.first), "cannot read \"{}\"", variable.first);
    constant_at_compile_ = parser.GetUsedVar().empty();
  } catch (const mu::ParserError& error) {
    fail(syntax_error(error));
  } catch (const Error& error) {
    fail(error.what());
  }
  compiled_ = std::move(compiled);
  if (constant_at_compile_) constant_ = evaluate({}, 0);
}

std::string defect_of_table_name(const std::string& name) {
  Expression::Compiled names;
  names.define_names();
  try {
    define_tables(names.parser, {{name, {{0, 1}, {0, 1}}}});
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

Real Expression::operator()(const std::array<Real, 3>& x, Real t) const {
  return is_constant() ? constant_ : evaluate(x, t);
}

bool Expression::constant_in_time() const {
  return is_constant() || (compiled_ && !compiled_->parser.GetUsedVar().count("t"));
}

std::string Expression::text() const { return text_.empty() ? number_text(constant_) : text_; }

Real Expression::evaluate(const std::array<Real, 3>& x, Real t) const {
  SPREKK_CHECK(compiled_, "{}: \"{}\" was evaluated before it was compiled", place_, shortened(text_));
  compiled_->x = x[0];
  compiled_->y = x[1];
  compiled_->z = x[2];
  compiled_->t = t;
  std::string problem;
  try {
    const Real value = compiled_->parser.Eval();
    if (std::isfinite(value)) return value;
    problem = fmt::format("is {}, must be finite", std::isnan(value) ? "nan" : value > 0 ? "inf" : "-inf");
  } catch (const mu::ParserError& error) {
    problem = shortened(error.GetMsg());
  } catch (const Error& error) {
    problem = error.what();
  }
  throw Error(fmt::format("{}: \"{}\" at x = ({}, {}, {}), t = {}: {}", place_, shortened(text_), x[0], x[1], x[2], t,
                          problem));
}

}  // namespace sprekk::base
