#include "base/parameters.hpp"

#include <algorithm>

#include "base/text.hpp"
#include "base/value.hpp"

namespace sprekk::base {

namespace {

/// For a cell of a Markdown table.
std::string cell(const std::string& text) {
  std::string escaped;
  for (char c : text) escaped += c == '|' ? std::string("\\|") : std::string(1, c);
  return escaped;
}

}  // namespace

void Section::passthrough(Teuchos::ParameterList& target, const std::string& name, const std::string& meaning) {
  names_.push_back(name);
  if (mode_ == Mode::document)
    rows_ += fmt::format("| {} | section | - | as it is | any | {} |\n", name, cell(meaning));
  else if (mode_ == Mode::write)
    output_->sublist(name).setParameters(target);
  else if (const auto* list = find_list(name))
    target.setParameters(*list);
}

void Section::fail(const std::string& what) {
  if (mode_ == Mode::read) errors_->push_back(fmt::format("{}: {}: {}", file_, path_, what));
}

void Section::fail(const std::string& entry, const std::string& what) {
  if (mode_ == Mode::read) errors_->push_back(place(entry) + ": " + what);
}

void Section::fail_inside(const std::string& what) {
  if (mode_ == Mode::read) errors_->push_back(fmt::format("{}: {} > {}", file_, path_, what));
}

Section Section::child(const std::string& name) const {
  Section inner(mode_, path_ + " > " + name);
  inner.file_ = file_;
  inner.errors_ = errors_;
  if (errors_) inner.n_errors_before_ = errors_->size();
  return inner;
}

std::string Section::place(const std::string& entry) const {
  return fmt::format("{}: {} > \"{}\"", file_, path_, entry);
}

const Teuchos::ParameterEntry* Section::find(const Spec& spec) {
  const auto* entry = input_->getEntryPtr(spec.name);
  const std::string unit = spec.unit == "-" ? "" : fmt::format(" ({})", spec.unit);
  if (!entry && spec.required)
    errors_->push_back(fmt::format("{}{}: missing; it is required. {}", place(spec.name), unit, spec.meaning));
  return entry;
}

const Teuchos::ParameterList* Section::find_list(const std::string& name) {
  const auto* entry = input_->getEntryPtr(name);
  if (!entry) return nullptr;
  if (entry->isList()) return &input_->sublist(name);
  fail(name, fmt::format("is {}, expected a section, e.g. <ParameterList name=\"{}\">", base::describe(*entry), name));
  return nullptr;
}

bool Section::is_a_choice(const Spec& spec, const Teuchos::ParameterEntry& entry) {
  if (spec.choices.empty() || !entry.isType<std::string>()) return true;
  const auto& value = Teuchos::getValue<std::string>(entry);
  if (std::count(spec.choices.begin(), spec.choices.end(), value)) return true;
  fail(spec.name, fmt::format("is \"{}\", must be one of {}.{}", value, quoted_list(spec.choices),
                              did_you_mean(value, spec.choices)));
  return false;
}

void Section::document(const Spec& spec, const std::string& type, const Teuchos::ParameterList& defaults) {
  const auto* entry = defaults.getEntryPtr(spec.name);
  std::string value = spec.required ? "required" : entry ? value_text(*entry) : "absent";
  if (value.empty()) value = "\"\"";
  const bool numeric = type.find("double") != type.npos || type.find("int") != type.npos;
  std::string allowed = !spec.choices.empty() ? quoted_list(spec.choices) : numeric ? spec.bounds.text() : "any";
  if (spec.bounds.size()) allowed += ", " + spec.bounds.length_text();
  rows_ += fmt::format("| {} | {} | {} | {} | {} | {} |\n", spec.name, type, cell(spec.unit), cell(value),
                       cell(allowed), cell(spec.meaning));
}

void Section::finish(const std::string& meaning) {
  if (mode_ == Mode::read) {
    for (const auto& named_entry : *input_) {
      const std::string& name = named_entry.first;
      if (std::count(names_.begin(), names_.end(), name)) continue;
      std::string help = did_you_mean(name, names_);
      if (help.empty()) help = names_.empty() ? " Nothing is allowed here" : " Allowed are " + quoted_list(names_);
      fail(name, "unknown." + help);
    }
  } else if (mode_ == Mode::document) {
    std::string text = fmt::format("## {}\n\n", path_);
    if (!meaning.empty()) text += meaning + "\n\n";
    if (!rows_.empty())
      text += "| name | type | unit | default | allowed | meaning |\n|---|---|---|---|---|---|\n" + rows_ + "\n";
    rows_ = text;
  }
}

void Section::throw_errors() const {
  if (errors_->empty()) return;
  std::string text;
  for (const auto& error : *errors_) text += (text.empty() ? "" : "\n") + error;
  throw Error(text);
}

}  // namespace sprekk::base
