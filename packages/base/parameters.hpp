// Parameters: one expression each, in the describe() of the struct that holds them, says what there is to know. The
// same describe() reads the struct from a parameter list, writes it to one, and documents it.
#pragma once

#include <Teuchos_ParameterList.hpp>
#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <type_traits>
#include <vector>

#include "base/bounds.hpp"
#include "base/check.hpp"
#include "base/codec.hpp"
#include "base/specification.hpp"
#include "base/value.hpp"

namespace sprekk::base {

/// What is wrong with the input.
struct Report {
  std::vector<std::string> errors;           ///< a line each
  std::set<std::string> defective;           ///< paths of the sections that have errors in them, `Sprekk > Mesh`
  std::set<std::string> with_unknown_names;  ///< of those with unknown names: what they lack may be there, misspelt

  bool is_sound(const std::string& section) const { return !defective.count(section); }
};

/// An S as far as it could be read: what could not be is what it was before.
template <class S>
struct Draft {
  S value{};
  Report report;
};

/// One section of the input, as a struct's `void describe(Section&)` sees it.
///
/// Targets of entries are double, int, long long, bool, std::string, Expression, vectors of double, int, string and
/// Expression, and std::optional of those, which stay empty if the entry is absent. An entry's default is what the
/// target holds when describe() is called. Units are those that value_in() knows, "-" for none; an array of expressions
/// may have one for each element, "m, Pa".
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
  /// The same with entries beside them, which common(section, first) describes; `first` is what each struct is before
  /// it is read.
  template <class S, class Common>
  void named_sections(std::map<std::string, S>& target, const std::string& name, const std::string& meaning,
                      const Common& common);
  /// A section of expressions with names that the user chooses, which expressions_call() may compile.
  void named_expressions(Expression::Named& target, const std::string& name, const std::string& meaning);
  /// A section that is handed on as it is.
  void passthrough(Teuchos::ParameterList& target, const std::string& name, const std::string& meaning);

  /// All sections that are not described before, handed on as they are.
  void other_sections(Teuchos::ParameterList& target, const std::string& meaning);

  /// What to say of names that are unknown here but common elsewhere, compared without_separators(): `Did you mean
  /// "normal stiffness"?` of "kn".
  void hint(const std::vector<std::string>& names, const std::string& what);

  /// Reports what no single entry can tell, e.g. that two of them contradict each other; heard only while reading.
  void fail(const std::string& what);
  void fail(const std::string& entry, const std::string& what);
  /// The same of something further inside: `what` opens with its path, e.g. `Bulk > "material": is ...`.
  void fail_inside(const std::string& what);

  /// The tables and named expressions that the expressions of all later entries may call, and with which they are
  /// compiled; the named ones are compiled here, and may call each other. Without this call expressions are not
  /// compiled.
  void expressions_call(const Tables& tables, Expression::Named& named);

  /// Whether nothing that this section has described so far is wrong.
  bool is_sound() const { return mode_ != Mode::read || report_->errors.size() == n_errors_before_; }

  /// Whether all that the section could have is asked for, not what it has.
  bool documents() const { return mode_ == Mode::document; }

  /// Whether this section was read without an error and has no name that is not yet described: so that describe() can
  /// compare entries after the last of them. A misspelt entry is not also told as a missing one.
  bool complete() const;

  template <class S>
  static Draft<S> draft(const Teuchos::ParameterList& list, const std::string& file, const std::string& root,
                        std::vector<std::string> errors);
  template <class S>
  static Teuchos::ParameterList effective(S& target, const std::string& root);
  template <class S>
  static SectionSpecification specification(const std::string& root);

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
  bool is_a_choice(const Spec& spec, const Teuchos::ParameterEntry& entry);        ///< reports a text that is not
  void refuse_units(const Teuchos::ParameterList& list, const std::string& path);  ///< of a list that is handed on
  bool is_unreadable(const Teuchos::ParameterEntry& entry);                        ///< reports what is in place of it
  /// Adds the specification of an entry, whose default is in `defaults`, if there is one.
  void document(const Spec& spec, const std::string& type, const Teuchos::ParameterList& defaults);
  std::vector<std::string> unknown_names() const;
  void finish(const std::string& meaning);  ///< reports names that are unknown; completes the specification
  void note_defects();                      ///< that were reported since this section was opened

  Mode mode_;
  std::string path_;                          ///< `Sprekk > Materials > joint`
  std::vector<std::string> names_;            ///< of all entries and sections described so far
  std::map<std::string, std::string> hints_;  ///< what to say of unknown names, without separators
  // reading
  std::string file_;
  const Teuchos::ParameterList* input_ = nullptr;
  Report* report_ = nullptr;
  std::size_t n_errors_before_ = 0;
  std::shared_ptr<const Tables> tables_;
  Expression::Named named_;
  // writing
  Teuchos::ParameterList* output_ = nullptr;
  // documenting
  SectionSpecification specification_;
};

/// An S filled from `list` as far as possible, and what is wrong, after `errors` that are known before; `file` and
/// `root` open the paths in messages. The same on all ranks if the list is.
template <class S>
Draft<S> draft(const Teuchos::ParameterList& list, const std::string& file, const std::string& root,
               std::vector<std::string> errors = {}) {
  return Section::draft<S>(list, file, root, std::move(errors));
}

/// Throws one Error with all lines, if there are any.
void throw_errors(const std::vector<std::string>& errors);

/// The same, where everything must be right: throws one Error with a line for each thing that is wrong.
template <class S>
S read(const Teuchos::ParameterList& list, const std::string& file, const std::string& root,
       std::vector<std::string> errors = {}) {
  auto result = draft<S>(list, file, root, std::move(errors));
  throw_errors(result.report.errors);
  return std::move(result.value);
}

/// All parameters with their values, defaults included; read() turns it back into an equal S. Every required entry of
/// `target` must hold a value.
template <class S>
Teuchos::ParameterList effective(S& target, const std::string& root) {
  return Section::effective(target, root);
}

/// All entries and sections that S{} can have.
template <class S>
SectionSpecification specification(const std::string& root) {
  return Section::specification<S>(root);
}

template <class T>
void Section::visit(T& target, const Spec& spec) {
  names_.push_back(spec.name);
  if (mode_ == Mode::read) {
    const auto* entry = find(spec);
    if (entry && is_a_choice(spec, *entry))
      decode(*entry, {place(spec.name), spec.unit, spec.bounds, tables_, named_, report_->errors}, target);
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
  inner.specification_.name = name;
  target.describe(inner);
  inner.finish(meaning);
  if (mode_ == Mode::document) specification_.sections.push_back(std::move(inner.specification_));
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
  named_sections(target, name, meaning, [](Section&, S&) {});
}

template <class S, class Common>
void Section::named_sections(std::map<std::string, S>& target, const std::string& name, const std::string& meaning,
                             const Common& common) {
  names_.push_back(name);
  Section middle = child(name);
  S first{};
  if (mode_ == Mode::document) {
    middle.specification_.name = name;
    common(middle, first);
    middle.descend(first, "", nullptr, nullptr, meaning);
    specification_.sections.push_back(std::move(middle.specification_));
  } else if (mode_ == Mode::write) {
    auto& output = output_->sublist(name);
    middle.output_ = &output;
    common(middle, first);
    for (auto& [key, value] : target) middle.descend(value, key, nullptr, &output.sublist(key), meaning);
  } else if (const auto* input = find_list(name)) {
    middle.input_ = input;
    common(middle, first);
    const auto beside = middle.names_;
    for (const auto& named_entry : *input) {
      const auto& key = named_entry.first;
      if (std::find(beside.begin(), beside.end(), key) != beside.end()) continue;
      const auto* list = middle.find_list(key);
      if (list) middle.descend(target.emplace(key, first).first->second, key, list, nullptr, meaning);
    }
    middle.note_defects();
  }
}

template <class S>
Draft<S> Section::draft(const Teuchos::ParameterList& list, const std::string& file, const std::string& root,
                        std::vector<std::string> errors) {
  Draft<S> result;
  result.report.errors = std::move(errors);
  Section section(Mode::read, root);
  section.file_ = file;
  section.input_ = &list;
  section.report_ = &result.report;
  section.n_errors_before_ = result.report.errors.size();
  result.value.describe(section);
  section.finish("");
  return result;
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
SectionSpecification Section::specification(const std::string& root) {
  Section section(Mode::document, root);
  section.specification_.name = root;
  S target{};
  target.describe(section);
  section.finish("");
  return section.specification_;
}

}  // namespace sprekk::base
