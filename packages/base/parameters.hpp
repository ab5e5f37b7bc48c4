// Parameters. Each one is declared once, in the describe() of the struct that contains it. describe() reads the struct
// from a parameter list, checks a struct in place, writes it to a list, and documents it.
#pragma once

#include <Teuchos_ParameterList.hpp>
#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "base/bounds.hpp"
#include "base/check.hpp"
#include "base/codec.hpp"
#include "base/specification.hpp"
#include "base/value.hpp"

namespace sprekk::base {

/// Errors in the input.
struct Report {
  std::vector<std::string> errors;           ///< one line each
  std::set<std::string> defective;           ///< paths of sections with errors, e.g. `Sprekk > Mesh`
  std::set<std::string> with_unknown_names;  ///< those with unknown names: a missing entry may be misspelt

  bool is_sound(const std::string& section) const { return !defective.count(section); }
};

/// Struct S with its errors. Unreadable parts of the input retain their default values, wrong members their values.
template <class S>
struct Draft {
  S value{};
  Report report;
};

/// Section of the input, the argument of `void describe(Section&)` of a struct.
///
/// Targets of entries are double, int, long long, bool, std::string, Expression, vectors of double, int, string and
/// Expression, and std::optional of these. An absent optional entry stays empty. The default of an entry is the value
/// of the target when describe() is called. Units are those of value_in(), "-" for none. An array of expressions may
/// have one unit for each element, "m, Pa".
class Section {
 public:
  /// Declares an optional entry.
  template <class T>
  void entry(T& target, const std::string& name, const std::string& unit, const Bounds& bounds,
             const std::string& meaning) {
    visit(target, {name, unit, bounds, meaning, false, {}});
  }
  template <class T>
  void entry(T& target, const std::string& name, const std::string& unit, const std::string& meaning) {
    visit(target, {name, unit, any(), meaning, false, {}});
  }

  /// Declares a required entry.
  template <class T>
  void required(T& target, const std::string& name, const std::string& unit, const Bounds& bounds,
                const std::string& meaning) {
    visit(target, {name, unit, bounds, meaning, true, {}});
  }
  template <class T>
  void required(T& target, const std::string& name, const std::string& unit, const std::string& meaning) {
    visit(target, {name, unit, any(), meaning, true, {}});
  }

  /// Declares a word from a list of choices; T is `std::string` or `std::optional<std::string>`.
  template <class T>
  void choice(T& target, const std::string& name, const std::vector<std::string>& allowed, const std::string& meaning) {
    visit(target, {name, "-", any(), meaning, false, allowed});
  }
  template <class T>
  void required_choice(T& target, const std::string& name, const std::vector<std::string>& allowed,
                       const std::string& meaning) {
    visit(target, {name, "-", any(), meaning, true, allowed});
  }

  /// Declares a section of entries. An absent section is read as an empty one.
  template <class S>
  void section(S& target, const std::string& name, const std::string& meaning);
  /// Declares an optional section. If it is absent, the target is unchanged.
  template <class S>
  void section(std::optional<S>& target, const std::string& name, const std::string& meaning);
  /// Declares a section of sections with user-defined names.
  template <class S>
  void named_sections(std::map<std::string, S>& target, const std::string& name, const std::string& meaning);
  /// Declares a section of sections with user-defined names, and common entries described by common(section, first).
  /// Each struct is a copy of `first` before it is read.
  template <class S, class Common>
  void named_sections(std::map<std::string, S>& target, const std::string& name, const std::string& meaning,
                      const Common& common);
  /// Declares a section of expressions with user-defined names, to be compiled by expressions_call().
  void named_expressions(Expression::Named& target, const std::string& name, const std::string& meaning);
  /// Declares a section that is copied unchanged.
  void passthrough(Teuchos::ParameterList& target, const std::string& name, const std::string& meaning);

  /// Copies all sections not described before, unchanged.
  void other_sections(Teuchos::ParameterList& target, const std::string& meaning);

  /// Adds a hint to the error message for names that are unknown here but common elsewhere, e.g. `Did you mean "normal
  /// stiffness"?` for "kn". Names are compared by without_separators().
  void hint(const std::vector<std::string>& names, const std::string& what);

  /// Reports an error that involves several entries, e.g. a contradiction. Ignored except while reading or checking.
  void fail(const std::string& what);
  void fail(const std::string& entry, const std::string& what);
  /// Reports an error inside a subsection. `what` begins with its path, e.g. `Bulk > "material": is ...`.
  void fail_inside(const std::string& what);

  /// Defines the tables and named expressions that the expressions of all later entries may call. Compiles the named
  /// expressions, which may call each other, and then all later expressions. Without this call expressions are not
  /// compiled.
  void expressions_call(const Tables& tables, Expression::Named& named);

  /// True if no error has been found so far in this section.
  bool is_sound() const { return !report_ || report_->errors.size() == n_errors_before_; }

  /// True while the available parameters are documented, not read, checked or written.
  bool documents() const { return mode_ == Mode::document; }

  /// True if this section was read or checked without errors and all its names have been described. describe() may then
  /// compare entries after the last declaration. So a misspelt entry is not reported a second time as missing.
  bool complete() const;

  template <class S>
  static Draft<S> draft(const Teuchos::ParameterList& list, const std::string& file, const std::string& root,
                        std::vector<std::string> errors);
  template <class S>
  static Draft<S> checked(S value, const std::string& file, const std::string& root);
  template <class S>
  static Teuchos::ParameterList effective(S& target, const std::string& root);
  template <class S>
  static SectionSpecification specification(const std::string& root);

 private:
  enum class Mode { read, check, write, document };
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
  /// Decodes an entry of `input` if it is present and admissible.
  template <class T>
  void decode_from(const Teuchos::ParameterList& input, const Spec& spec, T& target);
  template <class S>
  Draft<S> described(S value, Report report);  ///< describes `value` with this section as its root
  /// Describes a struct by a subsection, with `input` or `output`.
  template <class S>
  void descend(S& target, const std::string& name, const Teuchos::ParameterList* input, Teuchos::ParameterList* output,
               const std::string& meaning);

  Section child(const std::string& name) const;
  std::string place(const std::string& entry) const;  ///< `file: path > "entry"`
  /// Returns an entry of `input`, null if absent. Reports a missing required entry.
  const Teuchos::ParameterEntry* find(const Teuchos::ParameterList& input, const Spec& spec);
  const Teuchos::ParameterList* find_list(const std::string& name);  ///< null if absent; reports an entry in its place
  bool is_a_choice(const Spec& spec, const Teuchos::ParameterEntry& entry);  ///< reports a word that is not a choice
  void refuse_units(const Teuchos::ParameterList& list, const std::string& path);  ///< reports units in a copied list
  bool is_unreadable(const Teuchos::ParameterEntry& entry);  ///< reports the message of an unreadable entry
  /// Adds the specification of an entry. `defaults` contains its default, if any.
  void document(const Spec& spec, const std::string& type, const Teuchos::ParameterList& defaults);
  std::vector<std::string> unknown_names() const;
  void finish(const std::string& meaning);  ///< reports unknown names; completes the specification
  void note_defects();                      ///< marks this section if errors were reported since its beginning
  static const Teuchos::ParameterList& empty();

  Mode mode_;
  std::string path_;                          ///< `Sprekk > Materials > joint`
  std::vector<std::string> names_;            ///< names of all entries and sections described so far
  std::map<std::string, std::string> hints_;  ///< hints by unknown name without separators
  // reading and checking
  std::string file_;
  const Teuchos::ParameterList* input_ = &empty();  ///< empty while checking
  Report* report_ = nullptr;                        ///< null while writing and documenting
  std::size_t n_errors_before_ = 0;
  std::shared_ptr<const Tables> tables_;
  Expression::Named named_;
  // writing
  Teuchos::ParameterList* output_ = nullptr;
  // documenting
  SectionSpecification specification_;
};

/// Reads an S from `list` as far as possible and collects errors after the known `errors`. `file` and `root` begin the
/// paths in messages. The result is the same on all ranks if the list is.
template <class S>
Draft<S> draft(const Teuchos::ParameterList& list, const std::string& file, const std::string& root,
               std::vector<std::string> errors = {}) {
  return Section::draft<S>(list, file, root, std::move(errors));
}

/// Checks the members of `value` like entries of an input, and completes it as describe() does. Members that are no
/// entries are unchanged. `file` and `root` as in draft().
template <class S>
Draft<S> checked(S value, const std::string& file, const std::string& root) {
  return Section::checked(std::move(value), file, root);
}

/// Throws one Error with all lines if there are any.
void throw_errors(const std::vector<std::string>& errors);

/// Reads an S from `list`. Throws one Error with one line for each error.
template <class S>
S read(const Teuchos::ParameterList& list, const std::string& file, const std::string& root,
       std::vector<std::string> errors = {}) {
  auto result = draft<S>(list, file, root, std::move(errors));
  throw_errors(result.report.errors);
  return std::move(result.value);
}

/// Returns all parameters with their values, including defaults. read() reproduces an equal S. Every required entry of
/// `target` must have a value.
template <class S>
Teuchos::ParameterList effective(S& target, const std::string& root) {
  return Section::effective(target, root);
}

/// Returns all entries and sections available in S.
template <class S>
SectionSpecification specification(const std::string& root) {
  return Section::specification<S>(root);
}

template <class T>
void Section::visit(T& target, const Spec& spec) {
  names_.push_back(spec.name);
  if (mode_ == Mode::read) return decode_from(*input_, spec, target);
  if (mode_ == Mode::write) return encode(*output_, spec.name, target);
  Teuchos::ParameterList present;
  if (mode_ == Mode::check || !spec.required) encode(present, spec.name, target);
  mode_ == Mode::check ? decode_from(present, spec, target) : document(spec, type_name(target), present);
}

template <class T>
void Section::decode_from(const Teuchos::ParameterList& input, const Spec& spec, T& target) {
  const auto* entry = find(input, spec);
  if (entry && is_a_choice(spec, *entry))
    decode(*entry, {place(spec.name), spec.unit, spec.bounds, tables_, named_, report_->errors}, target);
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
  const auto* input = mode_ == Mode::read ? find_list(name) : nullptr;
  if (!input && input_->isParameter(name)) return;  // not a section: already reported
  auto* output = mode_ == Mode::write ? &output_->sublist(name) : nullptr;
  descend(target, name, input ? input : &empty(), output, meaning);
}

template <class S>
void Section::section(std::optional<S>& target, const std::string& name, const std::string& meaning) {
  if (mode_ == Mode::document || (mode_ == Mode::read && find_list(name))) {
    S present{};
    section(present, name, meaning + " (may be absent)");
    if (mode_ == Mode::read) target = std::move(present);
  } else if (mode_ != Mode::read && target) {
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
    middle.descend(first, "", &empty(), nullptr, meaning);
    specification_.sections.push_back(std::move(middle.specification_));
  } else if (mode_ != Mode::read) {
    auto* output = mode_ == Mode::write ? &output_->sublist(name) : nullptr;
    middle.output_ = output;
    common(middle, first);
    for (auto& [key, value] : target)
      middle.descend(value, key, &empty(), output ? &output->sublist(key) : nullptr, meaning);
    middle.note_defects();
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
Draft<S> Section::described(S value, Report report) {
  Draft<S> result{std::move(value), std::move(report)};
  report_ = &result.report;
  n_errors_before_ = report_->errors.size();
  result.value.describe(*this);
  finish("");
  return result;
}

template <class S>
Draft<S> Section::draft(const Teuchos::ParameterList& list, const std::string& file, const std::string& root,
                        std::vector<std::string> errors) {
  Section section(Mode::read, root);
  section.file_ = file;
  section.input_ = &list;
  return section.described(S{}, {std::move(errors), {}, {}});
}

template <class S>
Draft<S> Section::checked(S value, const std::string& file, const std::string& root) {
  Section section(Mode::check, root);
  section.file_ = file;
  return section.described(std::move(value), {});
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
