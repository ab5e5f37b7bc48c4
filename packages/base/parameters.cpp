#include "base/parameters.hpp"

#include <Teuchos_Array.hpp>
#include <fmt/ranges.h>
#include <algorithm>

#include "base/text.hpp"
#include "base/units.hpp"
#include "base/value.hpp"

namespace sprekk::base {

void Section::passthrough(Teuchos::ParameterList& target, const std::string& name, const std::string& meaning) {
  names_.push_back(name);
  if (mode_ == Mode::document)
    specification_.sections.push_back({name, meaning, {}, {}, true});
  else if (mode_ == Mode::write)
    output_->sublist(name).setParameters(target);
  else if (const auto* list = find_list(name)) {
    for (const auto& message : unreadable(*list)) report_->errors.push_back(message);
    refuse_units(*list, path_ + " > " + name);
    target.setParameters(*list);
  }
}

void Section::other_sections(Teuchos::ParameterList& target, const std::string& meaning) {
  if (mode_ == Mode::document) specification_.sections.push_back({"", meaning, {}, {}, true});
  if (mode_ == Mode::write) output_->setParameters(target);
  if (mode_ != Mode::read) return;
  for (const auto& name : unknown_names())
    if (input_->isSublist(name)) {
      names_.push_back(name);
      const auto& list = input_->sublist(name);
      for (const auto& message : unreadable(list)) report_->errors.push_back(message);
      target.sublist(name).setParameters(list);
    }
}

void Section::refuse_units(const Teuchos::ParameterList& list, const std::string& path) {
  for (const auto& named_entry : list) {
    const auto& name = named_entry.first;
    const auto& entry = named_entry.second;
    if (entry.isList()) refuse_units(list.sublist(name), path + " > " + name);
    if (entry.isType<Quantity>() || entry.isType<Teuchos::Array<Quantity>>())
      report_->errors.push_back(
          fmt::format("{}: {} > \"{}\": is {}, must be without a unit", file_, path, name, base::describe(entry)));
  }
}

void Section::hint(const std::vector<std::string>& names, const std::string& what) {
  for (const auto& name : names) hints_[without_separators(name)] = ". " + what;
}

void Section::named_expressions(Expression::Named& target, const std::string& name, const std::string& meaning) {
  names_.push_back(name);
  Section middle = child(name);
  if (mode_ == Mode::document) {
    const std::string what = "expression of x, y, z, t and of other names";
    specification_.sections.push_back(
        {name, meaning, {{"", type_name(Expression()), "-", "absent", what, any(), false, {}}}, {}});
  } else if (mode_ == Mode::write) {
    for (const auto& [key, value] : target) encode(output_->sublist(name), key, value);
  } else {
    Teuchos::ParameterList present;
    for (const auto& [key, value] : target) encode(present, key, value);
    const auto* input = mode_ == Mode::check ? &present : find_list(name);
    const auto bounds = any();
    const Expression::Named none;
    for (const auto& named_entry : input ? *input : empty())
      if (const auto& key = named_entry.first; !is_unreadable(named_entry.second))
        decode(named_entry.second, {middle.place(key), "-", bounds, nullptr, none, report_->errors}, target[key]);
    middle.note_defects();
  }
}

void Section::expressions_call(const Tables& tables, Expression::Named& named) {
  if (!report_) return;
  const Table nothing{{-1e9, 1e9}, {0, 0}};  // replaces an invalid table, so that its name is known
  auto callable = std::make_shared<Tables>();
  for (const auto& [name, table] : tables) {
    const std::string defect = defect_of_name("a table", name);
    if (defect.empty())
      callable->emplace(name, table.defect().empty() ? table : nothing);
    else
      fail(defect);
  }
  tables_ = callable;
  for (auto named_one = named.begin(); named_one != named.end();) {
    const auto& name = named_one->first;
    const std::string defect =
        tables.count(name) ? "is the name of a table, too" : defect_of_name("an expression", name);
    if (!defect.empty()) fail_inside(fmt::format("Expressions > \"{}\": {}", name, defect));
    named_one = defect.empty() ? std::next(named_one) : named.erase(named_one);
  }
  named = named_ = Expression::compile_all(std::move(named), tables_, report_->errors);
}

void Section::fail(const std::string& what) {
  if (report_) report_->errors.push_back(fmt::format("{}: {}: {}", file_, path_, what));
}

void Section::fail(const std::string& entry, const std::string& what) {
  if (report_) report_->errors.push_back(place(entry) + ": " + what);
}

void Section::fail_inside(const std::string& what) {
  if (report_) report_->errors.push_back(fmt::format("{}: {} > {}", file_, path_, what));
}

Section Section::child(const std::string& name) const {
  Section inner(mode_, path_ + " > " + name);
  inner.file_ = file_;
  inner.report_ = report_;
  inner.tables_ = tables_;
  inner.named_ = named_;
  if (report_) inner.n_errors_before_ = report_->errors.size();
  return inner;
}

std::string Section::place(const std::string& entry) const {
  return fmt::format("{}: {} > \"{}\"", file_, path_, shortened(entry));
}

const Teuchos::ParameterEntry* Section::find(const Teuchos::ParameterList& input, const Spec& spec) {
  const auto* entry = input.getEntryPtr(spec.name);
  const std::string unit = spec.unit == "-" ? "" : fmt::format(" ({})", spec.unit);
  if (!entry && spec.required)
    report_->errors.push_back(fmt::format("{}{}: missing; it is required: {}", place(spec.name), unit, spec.meaning));
  return entry && is_unreadable(*entry) ? nullptr : entry;
}

bool Section::is_unreadable(const Teuchos::ParameterEntry& entry) {
  if (!entry.isType<Unreadable>()) return false;
  report_->errors.push_back(Teuchos::getValue<Unreadable>(entry).message);
  return true;
}

const Teuchos::ParameterList* Section::find_list(const std::string& name) {
  const auto* entry = input_->getEntryPtr(name);
  if (!entry) return nullptr;
  if (entry->isList()) return &input_->sublist(name);
  report_->defective.insert(path_ + " > " + name);
  if (is_unreadable(*entry)) return nullptr;
  fail(name, fmt::format("is {}, expected a section, e.g. <ParameterList name=\"{}\">", base::describe(*entry), name));
  return nullptr;
}

bool Section::is_a_choice(const Spec& spec, const Teuchos::ParameterEntry& entry) {
  if (spec.choices.empty() || !entry.isType<std::string>()) return true;
  const auto& value = Teuchos::getValue<std::string>(entry);
  if (std::count(spec.choices.begin(), spec.choices.end(), value)) return true;
  fail(spec.name, fmt::format("is \"{}\", must be one of {}{}", shortened(value), quoted_list(spec.choices),
                              did_you_mean(value, spec.choices)));
  return false;
}

void Section::document(const Spec& spec, const std::string& type, const Teuchos::ParameterList& defaults) {
  const auto* entry = defaults.getEntryPtr(spec.name);
  std::string value = spec.required ? "required" : entry ? value_text(*entry) : "absent";
  if (value.empty()) value = "\"\"";
  specification_.entries.push_back(
      {spec.name, type, spec.unit, value, spec.meaning, spec.bounds, spec.required, spec.choices});
}

std::vector<std::string> Section::unknown_names() const {
  std::vector<std::string> names;
  for (const auto& named_entry : *input_)
    if (!std::count(names_.begin(), names_.end(), named_entry.first)) names.push_back(named_entry.first);
  return names;
}

bool Section::complete() const { return report_ && is_sound() && unknown_names().empty(); }

void Section::finish(const std::string& meaning) {
  specification_.meaning = meaning;
  if (!report_) return;
  for (const auto& name : unknown_names()) {
    if (is_unreadable(*input_->getEntryPtr(name)) && name[0] == '<') continue;  // an element without a name
    const auto hint = hints_.find(without_separators(name));
    std::string help = hint == hints_.end() ? did_you_mean(name, names_) : hint->second;
    if (help.empty()) help = names_.empty() ? "; nothing is allowed here" : "; allowed are " + quoted_list(names_);
    fail(name, "unknown" + help);
    report_->with_unknown_names.insert(path_);
  }
  note_defects();
}

void Section::note_defects() {
  if (!is_sound()) report_->defective.insert(path_);
}

const Teuchos::ParameterList& Section::empty() {
  static const Teuchos::ParameterList list;
  return list;
}

void throw_errors(const std::vector<std::string>& errors) {
  constexpr std::size_t maximum = 20;  // in a message
  const std::size_t n = errors.size() <= maximum + 1 ? errors.size() : maximum;
  SPREKK_CHECK(errors.empty(), "{}{}", fmt::join(errors.begin(), errors.begin() + n, "\n"),
               n < errors.size() ? fmt::format("\nand {} more errors", errors.size() - n) : "");
}

}  // namespace sprekk::base
