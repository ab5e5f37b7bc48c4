#include "base/expression.hpp"

#include <muParser.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "base/check.hpp"
#include "base/text.hpp"
#include "base/units.hpp"

namespace sprekk::base {

struct Expression::Compiled {
  mu::Parser parser;
  Real x = 0, y = 0, z = 0, t = 0;
  std::shared_ptr<const Tables> tables;

  /// Expression called by name.
  struct Call {
    const Compiled* from;
    Expression expression;
  };
  std::map<std::string, Call> calls;

  /// Callback for muParser.
  static double evaluate_named(void* call) {
    const auto& [from, expression] = *static_cast<const Call*>(call);
    return expression({from->x, from->y, from->z}, from->t);
  }

  void define_names() {
    parser.DefineVar("x", &x);
    parser.DefineVar("y", &y);
    parser.DefineVar("z", &z);
    parser.DefineVar("t", &t);
    parser.DefineConst("pi", 3.14159265358979323846);
    parser.DefineFun("erf", static_cast<double (*)(double)>(std::erf));
    parser.DefineFun("erfc", static_cast<double (*)(double)>(std::erfc));
  }
};

namespace {

/// Callback for muParser; `named_table` points to an entry of the expression's Tables.
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

/// Throws an Error if a name is not an identifier or already has a meaning.
void check_new_name(const mu::Parser& parser, const char* what, const std::string& name) {
  const bool taken = parser.GetFunDef().count(name) || parser.GetVar().count(name) || parser.GetConst().count(name);
  SPREKK_CHECK(!taken, "{} must not be named \"{}\", which has a meaning in expressions", what, name);
  SPREKK_CHECK(is_identifier(name), "{} \"{}\": a name must consist of letters, digits and _ to be called", what, name);
}

void define_tables(mu::Parser& parser, const Tables& tables) {
  for (const auto& named_table : tables) {
    const auto& [name, table] = named_table;
    check_new_name(parser, "a table", name);
    const std::string defect = table.defect();
    SPREKK_CHECK(defect.empty(), "table \"{}\" {}", name, defect);
    parser.DefineFunUserData(name, evaluate_table, const_cast<Tables::value_type*>(&named_table), false);
  }
}

/// Calls visit(name, position) for each name in a text. The "e" in a number is not a name, because it follows a digit.
template <class Visit>
void for_each_name(const std::string& text, const Visit& visit) {
  const auto in_word = [](char c) { return is_letter(c) || is_digit(c) || c == '.'; };
  for (auto word = text.begin(); word != text.end();) {
    const auto end = std::find_if_not(word, text.end(), in_word);
    if (is_letter(*word)) visit(std::string(word, end), word - text.begin());
    word = std::max(end, word + 1);
  }
}

/// Throws an Error for an unknown name.
void check_names(const std::string& text, const mu::Parser& parser) {
  const auto names = known_names(parser);
  for_each_name(text, [&](const std::string& name, std::size_t position) {
    const bool known = std::count(names.begin(), names.end(), name) || parser.GetConst().count(name);
    const auto help = [&] {
      const bool is_unit = defect_of_unit(name).empty();
      return is_unit ? fmt::format("; {}", no_units_in_expressions) : did_you_mean(name, names);
    };
    SPREKK_CHECK(known, "unknown name \"{}\" at position {}{}", shortened(name), position, help());
  });
}

std::string syntax_error(const mu::ParserError& error) {
  const std::string message = shortened(error.GetMsg());
  const bool has_position = error.GetPos() < 0 || message.find("position") != message.npos;
  return has_position ? message : fmt::format("{} at position {}", message, error.GetPos());
}

/// Throws an Error for "a, b", which has two results in muParser, and for "x = 1", which is an assignment.
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

/// Replaces every "name" in the text by "name()".
std::string with_call(const std::string& text, const std::string& called) {
  std::string result;
  std::size_t done = 0;
  for_each_name(text, [&](const std::string& name, std::size_t position) {
    if (name != called) return;
    result += text.substr(done, position - done) + name + "()";
    done = position + name.size();
  });
  return result + text.substr(done);
}

/// True if all called expressions have a property.
template <class Compiled>
bool calls_all(const Compiled& compiled, bool (Expression::*has)() const) {
  return std::all_of(compiled.calls.begin(), compiled.calls.end(),
                     [&](const auto& call) { return (call.second.expression.*has)(); });
}

}  // namespace

Expression::Expression(Real constant) : constant_(constant) {
  SPREKK_CHECK(!std::isnan(constant), "an expression must be finite (or infinite, where that is allowed), is nan");
}

Expression::Expression(std::string text, std::string place) : text_(std::move(text)), place_(std::move(place)) {
  SPREKK_CHECK(!trimmed(text_).empty(), "{}: is empty, must be a number or an expression of x, y, z, t", place_);
  if (const auto number = parse_number(text_)) *this = Expression(*number);
}

void Expression::compile(std::shared_ptr<const Tables> tables, const Named& named) {
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
    for (const auto& [name, expression] : named) {  // first as variables, for correct positions in messages
      check_new_name(parser, "an expression", name);
      parser.DefineVar(name, &compiled->x);
    }
    check_single_value(text_);
    check_names(text_, parser);
    parser.SetExpr(text_);
    for (const auto& variable : parser.GetUsedVar())  // muParser takes unreadable text for a variable
      SPREKK_CHECK(parser.GetVar().count(variable.first), "cannot read \"{}\"", variable.first);
    std::string text = text_;
    const auto used = parser.GetUsedVar();
    for (const auto& [name, expression] : named) {
      parser.RemoveVar(name);
      if (!used.count(name)) continue;
      auto& call = compiled->calls.emplace(name, Compiled::Call{compiled.get(), expression}).first->second;
      parser.DefineFunUserData(name, Compiled::evaluate_named, &call, false);
      text = with_call(text, name);
    }
    parser.SetExpr(text);
    constant_at_compile_ = parser.GetUsedVar().empty() && calls_all(*compiled, &Expression::is_constant);
  } catch (const mu::ParserError& error) {
    fail(syntax_error(error));
  } catch (const Error& error) {
    fail(error.what());
  }
  compiled_ = std::move(compiled);
  if (constant_at_compile_) constant_ = evaluate({}, 0);
}

Expression::Named Expression::compile_all(Named pending, const std::shared_ptr<const Tables>& tables,
                                          std::vector<std::string>& errors) {
  Named ready;
  const auto first_pending = [&](const std::string& text) {  // first uncompiled expression that a text calls
    std::string first;
    for_each_name(text, [&](const std::string& name, std::size_t) {
      if (first.empty() && pending.count(name)) first = name;
    });
    return first;
  };
  const auto finish = [&](const std::string& name, const std::string& error) {
    if (!error.empty()) {
      errors.push_back(error);
      (pending[name] = Expression("x")).compile();
    }
    ready.insert(pending.extract(name));
  };
  while (!pending.empty()) {
    std::string path, name = pending.begin()->first, next;
    std::set<std::string> seen;
    for (; seen.insert(name).second && !(next = first_pending(pending[name].text_)).empty(); name = next)
      path += fmt::format("\"{}\" calls ", name);
    const auto& expression = pending[name];
    if (!next.empty()) {  // circular call
      path = path.substr(path.find(fmt::format("\"{}\" calls ", name)));
      finish(name,
             fmt::format("{}: in \"{}\": calls itself: {}\"{}\"", expression.place_, expression.text_, path, name));
      continue;
    }
    std::string error;
    try {
      pending[name].compile(tables, ready);
    } catch (const Error& defect) {
      error = defect.what();
    }
    finish(name, error);
  }
  return ready;
}

std::string defect_of_name(const char* what, const std::string& name) {
  Expression::Compiled names;
  names.define_names();
  try {
    check_new_name(names.parser, what, name);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

Real Expression::operator()(const std::array<Real, 3>& x, Real t) const {
  return is_constant() ? constant_ : evaluate(x, t);
}

bool Expression::constant_in_time() const {
  return is_constant() || (compiled_ && !compiled_->parser.GetUsedVar().count("t") &&
                           calls_all(*compiled_, &Expression::constant_in_time));
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
