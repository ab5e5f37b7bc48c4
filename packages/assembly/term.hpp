// Type-erased local operator with its assembler.
#pragma once

#include "assembly/assembler.hpp"

#include <functional>
#include <memory>
#include <utility>
#include <vector>

namespace sprekk::assembly {

/// Term of a module whose operator type is selected at bind().
class Term {
 public:
  Term() = default;
  /// `at(state)` returns the operator. Rows and columns: block numbers, see Assembler. `keep`: save scatter positions.
  template <class At>
  Term(const Context& context, Loop loop, const std::vector<int>& rows, const std::vector<int>& columns, bool keep,
       At at) {
    using Of = Assembler<decltype(at(std::declval<const State&>()))>;
    const auto assembler =
        std::make_shared<Of>(context, loop, rows, columns, keep ? Of::Positions::keep : Of::Positions::once);
    residual_ = [assembler, at](const State& state, const Rows& r) { assembler->add_residual(at(state), state, r); };
    jacobian_ = [assembler, at](const State& state, fields::BlockMatrix& J) {
      assembler->add_jacobian(at(state), state, J);
    };
  }

  void add_residual(const State& state, const Rows& r) const { residual_(state, r); }
  void add_jacobian(const State& state, fields::BlockMatrix& J) const { jacobian_(state, J); }

 private:
  std::function<void(const State&, const Rows&)> residual_;
  std::function<void(const State&, fields::BlockMatrix&)> jacobian_;
};

}  // namespace sprekk::assembly
