// Parameters: one expression each, in the describe() of the struct that holds them, says what there is to know. The
// same describe() reads the struct from a parameter list, writes it to one, and documents it.
#pragma once

#include <Teuchos_ParameterList.hpp>
#include <map>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "base/bounds.hpp"
#include "base/check.hpp"
#include "base/codec.hpp"

namespace sprekk::base {

/// One section of the input, as a struct's `void describe(Section&)` sees it.
///
/// Targets of entries are double, int, long long, bool, std::string, Expression, vectors of double, int, string and
/// Expression, and std::optional of those, which stay empty if the entry is absent. An entry's default is what the
/// target holds when describe() is called. Units are text, "-" for none.
class Section {
 public:
  /// An entry that may be left out.
  template <class T>
  void entry(T& target, const std::string& name, const std::string& unit, const Bounds& bounds,
             const std::string& meaning) {
    visit(target, {name, unit, bounds, meaning, false, {}});
  }
  template <class T>
  void entry(T& target, const std::string& name, const std::string& unit, const std::string& meaning) {
    visit(target, {name, unit, any(), meaning, false, {}});
  }

  /// An entry that must be there.
  template <class T>
  void required(T& target, const std::string& name, const std::string& unit, const Bounds& bounds,
                const std::string& meaning) {
    visit(target, {name, unit, bounds, meaning, true, {}});
  }
  template <class T>
  void required(T& target, const std::string& name, const std::string& unit, const std::string& meaning) {
    visit(target, {name, unit, any(), meaning, true, {}});
  }

  /// One word out of a list; T is std::string or an optional one.
  template <class T>
  void choice(T& target, const std::string& name, const std::vector<std::string>& allowed, const std::string& meaning) {
    visit(target, {name, "-", any(), meaning, false, allowed});
  }
  template <class T>
  void required_choice(T& target, const std::string& name, const std::vector<std::string>& allowed,
                       const std::string& meaning) {
    visit(target, {name, "-", any(), meaning, true, allowed});
  }

  /// A section of entries. One that is absent is read as if it were empty.
  template <class S>
  void section(S& target, const std::string& name, const std::string& meaning);
  /// A section that may be absent, which leaves the target as it is.
  template <class S>
  void section(std::optional<S>& target, const std::string& name, const std::string& meaning);
  /// A section of sections with names that the user chooses.
  template <class S>
  void named_sections(std::map<std::string, S>& target, const std::string& name, const std::string& meaning);
  /// A section that is handed on as it is.
  void passthrough(Teuchos::ParameterList& target, const std::string& name, const std::string& meaning);

  /// Reports what no single entry can tell, e.g. that two of them contradict each other; heard only while reading.
  void fail(const std::string& what);
  void fail(const std::string& entry, const std::string& what);
  /// The same of something further inside: `what` opens with its path, e.g. `Bulk > "material": is ...`.
  void fail_inside(const std::string& what);

  /// Whether everything of this section, so far, was read without an error: so that describe() can compare entries.
  bool complete() const { return mode_ == Mode::read && errors_->size() == n_errors_before_; }

  template <class S>
  static S read(const Teuchos::ParameterList& list, const std::string& file, const std::string& root);
  template <class S>
  static Teuchos::ParameterList effective(S& target, const std::string& root);
  template <class S>
  static std::string reference(const std::string& root);

 private:
  enum class Mode { read, write, document };
  struct Spec {
    std::string name, unit;
    Bounds bounds;
    std::string meaning;
    bool required;
    std::vector<std::string> choices;
  };

  Section(Mode mode, std::string path) : mode_(mode), path_(std::move(path)) {}

  template <class T>
  void visit(T& target, const Spec& spec);
  /// Describes a struct by a section inside of this one, on `input` or `output`.
  template <class S>
  void descend(S& target, const std::string& name, const Teuchos::ParameterList* input, Teuchos::ParameterList* output,
               const std::string& meaning);

  Section child(const std::string& name) const;
  std::string place(const std::string& entry) const;                 ///< `file: path > "entry"`
  const Teuchos::ParameterEntry* find(const Spec& spec);             ///< reports a required entry that is missing
  const Teuchos::ParameterList* find_list(const std::string& name);  ///< null if absent; reports an entry of that name
  bool is_a_choice(const Spec& spec, const Teuchos::ParameterEntry& entry);  ///< reports a text that is not
  /// Adds the row of an entry, whose default is in `defaults`, if there is one.
  void document(const Spec& spec, const std::string& type, const Teuchos::ParameterList& defaults);
  void finish(const std::string& meaning);  ///< reports names that are unknown; completes the documentation
  void throw_errors() const;

  Mode mode_;
  std::string path_;                ///< `Sprekk > Materials > joint`
  std::vector<std::string> names_;  ///< of all entries and sections described so far
  // reading
  std::string file_;
  const Teuchos::ParameterList* input_ = nullptr;
  std::vector<std::string>* errors_ = nullptr;
  std::size_t n_errors_before_ = 0;
  // writing
  Teuchos::ParameterList* output_ = nullptr;
  // documenting
  std::string rows_, inner_sections_;
};

/// An S filled from `list`; `file` and `root` open the paths in messages. Throws one Error with a line for each thing
/// that is wrong. The same on all ranks if the list is.
template <class S>
S read(const Teuchos::ParameterList& list, const std::string& file, const std::string& root) {
  return Section::read<S>(list, file, root);
}

/// All parameters with their values, defaults included; read() turns it back into an equal S. Every required entry of
/// `target` must hold a value.
template <class S>
Teuchos::ParameterList effective(S& target, const std::string& root) {
  return Section::effective(target, root);
}

/// Markdown: for every section that S{} can have a table with one row for each entry. Sections named by the user are
/// described once, as NAME.
template <class S>
std::string reference(const std::string& root) {
  return Section::reference<S>(root);
}

template <class T>
void Section::visit(T& target, const Spec& spec) {
  names_.push_back(spec.name);
  if (mode_ == Mode::read) {
    const auto* entry = find(spec);
    if (entry && is_a_choice(spec, *entry)) decode(*entry, {place(spec.name), spec.bounds, *errors_}, target);
  } else if (mode_ == Mode::write) {
    encode(*output_, spec.name, target);
  } else {
    Teuchos::ParameterList defaults;
    if (!spec.required) encode(defaults, spec.name, target);
    document(spec, type_name(target), defaults);
  }
}

template <class S>
void Section::descend(S& target, const std::string& name, const Teuchos::ParameterList* input,
                      Teuchos::ParameterList* output, const std::string& meaning) {
  Section inner = child(name);
  inner.input_ = input;
  inner.output_ = output;
  target.describe(inner);
  inner.finish(meaning);
  inner_sections_ += inner.rows_ + inner.inner_sections_;
}

template <class S>
void Section::section(S& target, const std::string& name, const std::string& meaning) {
  names_.push_back(name);
  const Teuchos::ParameterList nothing;
  const auto* input = mode_ == Mode::read ? find_list(name) : nullptr;
  if (mode_ == Mode::read && !input && input_->isParameter(name)) return;  // not a section, which is reported
  auto* output = mode_ == Mode::write ? &output_->sublist(name) : nullptr;
  descend(target, name, input ? input : &nothing, output, meaning);
}

template <class S>
void Section::section(std::optional<S>& target, const std::string& name, const std::string& meaning) {
  if (mode_ == Mode::document || (mode_ == Mode::read && find_list(name))) {
    S present{};
    section(present, name, meaning + " (may be absent)");
    if (mode_ == Mode::read) target = std::move(present);
  } else if (mode_ == Mode::write && target) {
    section(*target, name, meaning);
  } else {
    names_.push_back(name);
  }
}

template <class S>
void Section::named_sections(std::map<std::string, S>& target, const std::string& name, const std::string& meaning) {
  names_.push_back(name);
  Section middle = child(name);
  if (mode_ == Mode::document) {
    S any_of_them{};
    middle.descend(any_of_them, "NAME", nullptr, nullptr, meaning);
  } else if (mode_ == Mode::write) {
    auto& output = output_->sublist(name);
    for (auto& [key, value] : target) middle.descend(value, key, nullptr, &output.sublist(key), meaning);
  } else if (const auto* input = find_list(name)) {
    middle.input_ = input;
    for (const auto& named_entry : *input) {
      const auto& key = named_entry.first;
      if (const auto* list = middle.find_list(key)) middle.descend(target[key], key, list, nullptr, meaning);
    }
  }
  inner_sections_ += middle.inner_sections_;
}

template <class S>
S Section::read(const Teuchos::ParameterList& list, const std::string& file, const std::string& root) {
  std::vector<std::string> errors;
  Section section(Mode::read, root);
  section.file_ = file;
  section.input_ = &list;
  section.errors_ = &errors;
  S target{};
  target.describe(section);
  section.finish("");
  section.throw_errors();
  return target;
}

template <class S>
Teuchos::ParameterList Section::effective(S& target, const std::string& root) {
  Teuchos::ParameterList list(root);
  Section section(Mode::write, root);
  section.output_ = &list;
  target.describe(section);
  return list;
}

template <class S>
std::string Section::reference(const std::string& root) {
  Section section(Mode::document, root);
  S target{};
  target.describe(section);
  section.finish("");
  return section.rows_ + section.inner_sections_;
}

}  // namespace sprekk::base
