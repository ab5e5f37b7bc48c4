// Functions of place and time that a user writes.
#pragma once

#include <array>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "base/table.hpp"
#include "base/types.hpp"

namespace sprekk::base {

/// A scalar function of x, y, z and t: a constant, or a text such as "-0.1*ramp(t)*sin(pi*x)". A text must be compiled
/// before it is evaluated, because the tables and expressions that it calls by name are read from the same input.
/// Copies share what was compiled.
class Expression {
 public:
  using Named = std::map<std::string, Expression>;

  /// Throws an Error if `constant` is not a number; infinity is one.
  Expression(Real constant = 0);

  /// `place` opens the messages of errors, e.g. `scene.xml: Sprekk > Loads > "force"[1]`. Text that is a number is a
  /// constant, exactly that number.
  explicit Expression(std::string text, std::string place = "expression");

  /// Reads the text; constants need no compiling. A text without x, y, z and t becomes a constant. Throws an Error with
  /// the text, the position and the names that are allowed. Those of `named` that it calls must be compiled, and are
  /// evaluated where the text needs their value: not in the branch of "? :" that is not taken.
  void compile(std::shared_ptr<const Tables> tables = std::make_shared<Tables>(), const Named& named = {});

  /// Compiles expressions that may call each other. What cannot be, or calls itself through others, gets a line in
  /// `errors`, and something of which only the name counts in its place.
  static Named compile_all(Named named, const std::shared_ptr<const Tables>& tables, std::vector<std::string>& errors);

  /// The value at the point x (metre) and time t (second). Throws an Error with point and time if it is not finite, if
  /// a table's range is left, or if the text was not compiled.
  Real operator()(const std::array<Real, 3>& x, Real t) const;

  bool is_constant() const { return text_.empty() || constant_at_compile_; }
  bool constant_in_time() const;  ///< t does not occur; of a text, known once it is compiled

  std::string text() const;  ///< as written; of a number, its shortest exact form

 private:
  struct Compiled;
  friend std::string defect_of_name(const char* what, const std::string& name);

  Real evaluate(const std::array<Real, 3>& x, Real t) const;

  Real constant_ = 0;
  bool constant_at_compile_ = false;
  std::string text_, place_;  ///< empty if the expression was given as a number
  std::shared_ptr<Compiled> compiled_;
};

/// Why expressions cannot call something, "a table" or "an expression", by this name; empty if they can.
std::string defect_of_name(const char* what, const std::string& name);

}  // namespace sprekk::base
