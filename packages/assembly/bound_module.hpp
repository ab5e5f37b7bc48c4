// Module of a system with its declaration, its histories and its optional interfaces.
#pragma once

#include "assembly/capabilities.hpp"

#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace sprekk::assembly {

/// Module with its optional interfaces, null if absent. The interfaces are found once.
struct BoundModule {
  explicit BoundModule(std::unique_ptr<Module> owned)
      : module(std::move(owned)),
        loads(find<Loads>()),
        initial_values(find<InitialValues>()),
        steps(find<Steps>()),
        transfer(find<Transfer>()),
        supporting(find<Supporting>()),
        contact(find<ContactFaces>()),
        coefficients(find<LaggedCoefficients>()),
        weights(find<RowWeights>()),
        artificial_storage(find<ArtificialStorage>()),
        errors(find<Errors>()),
        totals(find<Totals>()) {}

  Module* operator->() const { return module.get(); }
  /// Returns whether the residual at x = 0 is the same at all times.
  bool has_constant_load() const { return !loads || loads->constant_load(); }
  bool constrains_bodies() const { return supporting && supporting->constrains_bodies(); }
  /// Returns the state with the histories of this module.
  State at(State state) const {
    state.history = history;
    return state;
  }
  /// Returns the name of a history variable of the module in the system.
  std::string history_name(const History& variable) const { return module->name() + ": " + variable.name; }
  fields::Field history_field(const History& variable) const {
    return {history_name(variable), variable.entity, variable.n_components, "", variable.is_amount};
  }

  std::unique_ptr<Module> module;
  Declaration declaration = {};
  std::vector<View<Real**>> history = {};  ///< [number](owned entity, component)
  Loads* loads;
  InitialValues* initial_values;
  Steps* steps;
  Transfer* transfer;
  Supporting* supporting;
  ContactFaces* contact;
  LaggedCoefficients* coefficients;
  RowWeights* weights;
  ArtificialStorage* artificial_storage;
  Errors* errors;
  Totals* totals;

 private:
  template <class Interface>
  Interface* find() const {
    return dynamic_cast<Interface*>(module.get());
  }
};

}  // namespace sprekk::assembly
