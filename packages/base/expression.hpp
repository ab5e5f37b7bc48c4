// User-defined functions of position and time.
#pragma once

#include <array>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "base/table.hpp"
#include "base/types.hpp"

namespace sprekk::base {

/// Scalar function of x, y, z and t: a constant, or a text such as "-0.1*ramp(t)*sin(pi*x)". A text must be compiled
/// before evaluation, because the called tables and expressions are read from the same input. Copies share the compiled
/// text.
class Expression {
 public:
  using Named = std::map<std::string, Expression>;

  /// Creates a constant, which may be infinite. Throws an Error for NaN.
  Expression(Real constant = 0);

  /// Creates a function from a text. `place` begins the error messages, e.g. `scene.xml: Sprekk > Loads > "force"[1]`.
  /// The text of a number gives exactly that constant. Throws an Error if the text is empty.
  explicit Expression(std::string text, std::string place = "expression");

  /// Parses the text; no effect on constants. A text without x, y, z and t becomes a constant. Throws an Error with the
  /// text, the position and the allowed names. Called expressions of `named` must be compiled. They are evaluated on
  /// demand: not in the unused branch of "? :".
  void compile(std::shared_ptr<const Tables> tables = std::make_shared<Tables>(), const Named& named = {});

  /// Compiles expressions that may call each other. For an expression with a syntax error or a circular call, it
  /// appends a message to `errors` and returns a placeholder of this name.
  static Named compile_all(Named named, const std::shared_ptr<const Tables>& tables, std::vector<std::string>& errors);

  /// Value at the point x (m) and time t (s). Throws an Error with point and time if it is not finite, if the argument
  /// of a table is out of range, or if the text was not compiled.
  Real operator()(const std::array<Real, 3>& x, Real t) const;

  bool is_constant() const { return text_.empty() || constant_at_compile_; }
  bool constant_in_time() const;  ///< does not depend on t; for a text valid after compile()

  std::string text() const;  ///< as written; for a number, its shortest exact form

 private:
  struct Compiled;
  friend std::string defect_of_name(const char* what, const std::string& name);

  Real evaluate(const std::array<Real, 3>& x, Real t) const;

  Real constant_ = 0;
  bool constant_at_compile_ = false;
  std::string text_, place_;  ///< empty if the expression was given as a number
  std::shared_ptr<Compiled> compiled_;
};

/// Returns an error message if expressions cannot call `what` ("a table" or "an expression") by this name; else "".
std::string defect_of_name(const char* what, const std::string& name);

}  // namespace sprekk::base
