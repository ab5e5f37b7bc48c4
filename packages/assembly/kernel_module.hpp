// Modules that consist of one local operator on one loop.
#pragma once

#include "assembly/assembler.hpp"
#include "assembly/capabilities.hpp"
#include "base/host_table.hpp"

#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace sprekk::assembly {

/// Properties of a KernelModule; see Module and Supporting.
struct Description {
  std::string name, fingerprint;
  std::vector<Unknown> unknowns = {};
  Scales scales = {};
  bool linear = false, constrains_bodies = false;
  std::optional<std::vector<contact::Support>> supports = {};
  Real merit_weight = 0;  ///< weight of the module's own rows if not linear; see RowWeights::merit_weights
};

/// Module with one local operator on one loop. Op must meet the requirements of Assembler, with Rows = Columns, and
/// define
///   static constexpr Loop loop;
///   static constexpr std::array fields = {"...", ...};     in the order of the slots
/// The rows of each of these fields depend on all of them. The unknowns that the module declares are written to the
/// output.
template <class Op>
class KernelModule final : public Module, public Supporting, public RowWeights {
 public:
  KernelModule(Description description, Op op) : description_(std::move(description)), op_(std::move(op)) {}

  std::string name() const override { return description_.name; }
  std::string fingerprint() const override { return description_.fingerprint; }
  bool constrains_bodies() const override { return description_.constrains_bodies; }
  std::optional<std::vector<contact::Support>> supports() const override { return description_.supports; }

  Declaration declare(const mesh::Mesh&) const override {
    Declaration d;
    d.unknowns = description_.unknowns;
    d.linear = description_.linear;
    for (const char* row : Op::fields) d.couplings.push_back({Op::loop, row, {Op::fields.begin(), Op::fields.end()}});
    d.scales = description_.scales;
    for (std::size_t k = 0; k < d.unknowns.size(); ++k) {
      const auto& field = d.unknowns[k].field;
      d.outputs.push_back({{field.name, field.unit, field.entity, field.n_components},
                           [this, k](const State& state) { return values(state, static_cast<int>(k)); }});
    }
    return d;
  }

  void bind(const Context& context) override {
    static_assert(std::is_same_v<typename Op::Rows, typename Op::Columns> && Op::fields.size() == Op::Rows::n);
    using Positions = typename Assembler<Op>::Positions;
    std::vector<int> blocks;
    for (const char* name : Op::fields) blocks.push_back(context.field(name));
    assembler_ = std::make_unique<Assembler<Op>>(context, Op::loop, blocks, blocks,
                                                 description_.linear ? Positions::once : Positions::keep);
    mesh_ = context.mesh();
    for (const auto& unknown : description_.unknowns) own_.push_back(context.field(unknown.field.name));
  }

  void residual(const State& state, const Rows& r) const override { assembler_->add_residual(op_, state, r); }
  void jacobian(const State& state, fields::BlockMatrix& J) const override { assembler_->add_jacobian(op_, state, J); }

  void merit_weights(const Rows& weights) const override {
    for (int block : own_) Kokkos::deep_copy(weights[block], description_.merit_weight);
  }

 private:
  /// Returns the values of the module's unknown k on owned entities, or on all local nodes.
  std::vector<Real> values(const State& state, int k) const {
    const auto& field = description_.unknowns[k].field;
    const auto x = base::to_host(state.x[own_[k]]);
    const bool on_nodes = field.entity == fields::Entity::node;
    const LocalIndex n = on_nodes ? mesh_->n_nodes() : fields::n_entities(*mesh_, field.entity, false);
    std::vector<Real> values;
    for (LocalIndex e = 0; e < n; ++e)
      for (int i = 0; i < field.n_components; ++i)
        values.push_back(x((on_nodes ? mesh_->free_node(e) : e) * field.n_components + i));
    return values;
  }

  Description description_;
  Op op_;
  RCP<const mesh::Mesh> mesh_;
  std::vector<int> own_;  // block numbers of the module's unknowns
  std::unique_ptr<Assembler<Op>> assembler_;
};

template <class Op>
std::unique_ptr<Module> make_kernel_module(Description description, Op op) {
  return std::make_unique<KernelModule<Op>>(std::move(description), std::move(op));
}

}  // namespace sprekk::assembly
