// Properties of laws (parameters, outputs, history variables), and a variant that holds one of several laws.
#pragma once

#include "base/bounds.hpp"
#include "base/view.hpp"
#include "laws/contact.hpp"

#include <cmath>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace sprekk::laws {

/// Material entry for one parameter of a law. It is required unless it has a default or is optional.
struct Entry {
  std::string name, unit;
  base::Bounds bounds;
  std::string meaning;
  std::optional<Real> otherwise = {};    ///< default value
  bool optional = false;                 ///< if absent, the parameter retains its initial value
  bool found_in_situ = false;            ///< optional if the unloaded joint is computed, see unloaded()
  Real (*number_of)(Real) = nullptr;     ///< converts the entry to the parameter; null: no conversion
  std::string needs = {};                ///< entry that must also be present if this one is above 0
  std::vector<std::string> others = {};  ///< alternative spellings, for error messages

  Entry& or_else(Real value) { return otherwise = value, *this; }
  Entry& may_be_absent() { return optional = true, *this; }
  Entry& or_found_in_situ() { return found_in_situ = true, *this; }
  Entry& converted(Real (*function)(Real)) { return number_of = function, *this; }
  Entry& with(const std::string& entry) { return needs = entry, *this; }
  Entry& also_called(const std::vector<std::string>& names) { return others = names, *this; }
};

/// Parameter of the law K and its entry. Several entries of one parameter are alternatives: exactly one must be given.
template <class K>
struct Parameter {
  Real K::*number;
  Entry entry;
};

/// Output quantity of the law K on a face. `value` is evaluated with the contact quantities and history variables at
/// the end of a step. Its result must be 0 before the first slip and load.
template <class K>
struct Quantity {
  std::string name, unit, meaning;
  Real (*value)(const K&, const Contact<Real>&);
  std::string error_of = {};  ///< name of the quantity whose relative error it bounds; may be empty
  std::string integral = {};  ///< name of its integral over a fracture, in place of mean and maximum; may be empty
};

/// Output "accumulated slip" of a law whose first history variable is the path length of slip.
template <class K>
Quantity<K> accumulated_slip() {
  return {"accumulated slip", "m", "length of the path that was slipped while the faces touched",
          [](const K&, const Contact<Real>& at) -> Real { return at.history[0]; }};
}

inline Real tangent_of_degrees(Real angle) { return std::tan(angle * 3.14159265358979323846 / 180); }
inline Real reciprocal(Real value) { return 1 / value; }

/// Number of history variables of a law on each face: its static n_history, or 0.
template <class K, class = void>
constexpr int history_size = 0;
template <class K>
constexpr int history_size<K, std::void_t<decltype(K::n_history)>> = K::n_history;

/// Number of history variables in 2D: the static n_history_2d, or history_size. Only the law stored last may declare
/// n_history_2d.
template <class K, class = void>
constexpr int history_size_2d = history_size<K>;
template <class K>
constexpr int history_size_2d<K, std::void_t<decltype(K::n_history_2d)>> = K::n_history_2d;

/// True if a law declares output quantities by a static quantities().
template <class K, class = void>
constexpr bool tells_quantities = false;
template <class K>
constexpr bool tells_quantities<K, std::void_t<decltype(K::quantities())>> = true;
template <class K>
std::vector<Quantity<K>> quantities_of() {
  if constexpr (tells_quantities<K>) {
    return K::quantities();
  } else {
    return {};
  }
}

/// True if a friction law applies the factors of damage itself (static takes_damage). Otherwise its bound is multiplied
/// by the friction factor.
template <class K, class = void>
constexpr bool applies_damage = false;
template <class K>
constexpr bool applies_damage<K, std::void_t<decltype(K::takes_damage)>> = K::takes_damage;

/// True if K is a Kinds (below) or derived from one.
template <class K, class = void>
constexpr bool is_one_of_several = false;
template <class K>
constexpr bool is_one_of_several<K, std::void_t<typename K::OneOfSeveral>> = true;

/// Storage for one of several laws. Laws are copied as bytes.
template <class K, class... More>
union OneOf {
  K first;
  OneOf<More...> more;

  KOKKOS_INLINE_FUNCTION OneOf() : first() {}
  template <std::size_t i>
  KOKKOS_INLINE_FUNCTION auto& get() {
    if constexpr (i == 0) {
      return first;
    } else {
      return more.template get<i - 1>();
    }
  }
  template <std::size_t i>
  KOKKOS_INLINE_FUNCTION const auto& get() const {
    if constexpr (i == 0) {
      return first;
    } else {
      return more.template get<i - 1>();
    }
  }
};
template <class K>
union OneOf<K> {
  K first;

  KOKKOS_INLINE_FUNCTION OneOf() : first() {}
  template <std::size_t i>
  KOKKOS_INLINE_FUNCTION K& get() {
    return first;
  }
  template <std::size_t i>
  KOKKOS_INLINE_FUNCTION const K& get() const {
    return first;
  }
};

/// One of the laws Ks; the first of them by default. Each law is a struct of numbers with these members: static texts
/// `name` and `meaning`, a static parameters() that lists its numbers, and the functions of its role.
template <class... Ks>
class Kinds {
  static_assert((std::is_trivially_copyable_v<Ks> && ...), "laws are copied to the device as bytes");

 public:
  using OneOfSeveral = Kinds;
  Kinds() = default;
  template <class K, class = std::enable_if_t<(std::is_same_v<K, Ks> || ...)>>
  KOKKOS_INLINE_FUNCTION Kinds(const K& law) {
    set(law, std::index_sequence_for<Ks...>());
  }

  /// Returns use(law) for the stored law. Switches over all kinds.
  template <class Use>
  KOKKOS_INLINE_FUNCTION auto visit(const Use& use) const {
    return visit(use, std::index_sequence_for<Ks...>());
  }

  KOKKOS_INLINE_FUNCTION int n_history() const { return n_history_; }

 private:
  template <class K, std::size_t... i>
  KOKKOS_INLINE_FUNCTION void set(const K& law, std::index_sequence<i...>) {
    const auto set_one = [&](auto index) {
      constexpr std::size_t k = decltype(index)::value;
      if constexpr (std::is_same_v<K, std::decay_t<decltype(law_.template get<k>())>>) {
        kind_ = static_cast<int>(k);
        n_history_ = history_size<K>;
        law_.template get<k>() = law;
      }
    };
    (set_one(std::integral_constant<std::size_t, i>()), ...);
  }
  template <class Use, std::size_t... i>
  KOKKOS_INLINE_FUNCTION auto visit(const Use& use, std::index_sequence<i...>) const {
    std::decay_t<decltype(use(law_.template get<0>()))> result{};
    (void)((kind_ == static_cast<int>(i) && (result = use(law_.template get<i>()), true)) || ...);
    return result;
  }

  int kind_ = 0;
  int n_history_ = history_size<std::decay_t<decltype(std::declval<OneOf<Ks...>>().first)>>;
  OneOf<Ks...> law_;
};

/// Number of history variables of a law on each face; for Kinds, of the stored law.
template <class K>
KOKKOS_INLINE_FUNCTION int n_history(const K& law) {
  if constexpr (is_one_of_several<K>) {
    return law.n_history();
  } else {
    return history_size<K>;
  }
}

/// Number of history variables in 2D.
template <class K>
KOKKOS_INLINE_FUNCTION int n_history_2d(const K& law) {
  if constexpr (is_one_of_several<K>) {
    return law.visit([](const auto& one) { return history_size_2d<std::decay_t<decltype(one)>>; });
  } else {
    return history_size_2d<K>;
  }
}

/// True if a friction law (for Kinds, the stored one) applies the factors of damage itself.
template <class K>
KOKKOS_INLINE_FUNCTION bool takes_damage(const K& law) {
  if constexpr (is_one_of_several<K>) {
    return law.visit([](const auto& one) { return applies_damage<std::decay_t<decltype(one)>>; });
  } else {
    return applies_damage<K>;
  }
}

/// Returns use(law) for the law or, for Kinds, the stored law if it depends on the slip rate; otherwise Result().
template <class Result, class K, class Use>
KOKKOS_INLINE_FUNCTION Result if_rated(const K& law, const Use& use) {
  if constexpr (is_one_of_several<K>) {
    return law.visit([&](const auto& one) { return if_rated<Result>(one, use); });
  } else if constexpr (requires { law.depends_on_rate(); }) {
    return law.depends_on_rate() ? Result(use(law)) : Result();
  } else {
    return Result();
  }
}

/// Updates the history variables of a law at the end of a step by law.commit(contact, numbers), if the law has any.
template <class K, class At, class Values>
KOKKOS_INLINE_FUNCTION void commit(const K& law, const At& at, const Values& history) {
  if constexpr (is_one_of_several<K>) {
    law.visit([&](const auto& one) {
      commit(one, at, history);
      return 0;
    });
  } else if constexpr (history_size<K> != 0) {
    law.commit(at, history);
  }
}

}  // namespace sprekk::laws
