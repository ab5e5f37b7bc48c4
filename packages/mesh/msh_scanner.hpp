// Strict reader of words and numbers of a gmsh file, text or binary.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <string_view>

#include "base/check.hpp"
#include "base/text.hpp"

namespace sprekk::mesh {

/// Returns up to 40 characters of the content of a file, for messages; non-printable characters become "?".
inline std::string printable(std::string_view text) {
  std::string result(text.substr(0, 40));
  for (char& c : result)
    if (static_cast<unsigned char>(c) < 32 || static_cast<unsigned char>(c) > 126) c = '?';
  return result + (text.size() > 40 ? "..." : "");
}

/// Reads words, lines and numbers from a text, which must outlive the scanner. Numbers are text or binary. Throws
/// Errors that name the file, the section, the line (binary: the byte) and the node or element.
class MshScanner {
 public:
  MshScanner(std::string_view text, const std::string& file) : text_(text), file_(file) {}

  void set_format(bool is_binary, bool has_wide_tags) {
    is_binary_ = is_binary;
    has_wide_tags_ = has_wide_tags;
  }
  bool is_binary() const { return is_binary_; }
  void enter(const std::string& section) {
    section_ = section;
    about("", 0);
  }
  /// Sets the item for messages: kind and number of the node or element.
  void about(const char* kind, GlobalIndex tag) {
    kind_ = kind;
    tag_ = tag;
  }

  [[noreturn]] void fail(const std::string& message) const {
    const auto newlines = std::count(text_.begin(), text_.begin() + start_, '\n');
    const auto place = is_binary_ ? fmt::format("byte {}", start_) : fmt::format("line {}", newlines + 1);
    const auto item = *kind_ ? fmt::format("{} {}: ", kind_, tag_) : "";
    throw Error(
        fmt::format("{}: {}{}: {}{}", file_, section_.empty() ? "" : "$" + section_ + ", ", place, item, message));
  }

  bool at_end() {
    at_ = std::min(text_.find_first_not_of(" \t\r\n", at_), text_.size());
    return at_ == text_.size();
  }

  /// Reads the rest of the line, without blanks at its ends.
  std::string_view line() {
    start_ = at_;
    const auto end = std::min(text_.find('\n', at_), text_.size());
    at_ = std::min(end + 1, text_.size());
    return base::trimmed(text_.substr(start_, end - start_));
  }

  void skip_behind(const std::string& word) {
    start_ = at_;
    const auto found = text_.find(word, at_);
    if (found == text_.npos) fail(fmt::format("{} is missing; is the file complete?", word));
    at_ = found + word.size();
  }

  GlobalIndex text_integer(const char* what) {
    const auto found = word(what);
    const auto value = base::parse_integer(found);
    if (!value) fail(fmt::format("{} is \"{}\", must be an integer", what, printable(found)));
    return *value;
  }

  /// Reads an integer of four bytes; text integers must have the same range.
  int integer(const char* what) {
    const GlobalIndex value = is_binary_ ? raw<std::int32_t>(what) : text_integer(what);
    constexpr GlobalIndex largest = std::numeric_limits<int>::max();
    if (value < -largest || value > largest) fail(fmt::format("{} is {}, which cannot be", what, value));
    return static_cast<int>(value);
  }

  /// Reads an integer of eight bytes, or of four bytes in binary files of version 2.2.
  GlobalIndex long_integer(const char* what) {
    if (!is_binary_) return text_integer(what);
    return has_wide_tags_ ? static_cast<GlobalIndex>(raw<std::uint64_t>(what)) : raw<std::int32_t>(what);
  }

  /// Reads the number of a node or element. It must be positive.
  GlobalIndex tag(const char* what) {
    const auto value = long_integer(what);
    if (value <= 0) fail(fmt::format("{} is {}, must be positive", what, value));
    return value;
  }

  /// Reads a count of items with at least `n_numbers` numbers each. Throws an Error if the rest of the file cannot
  /// contain them.
  GlobalIndex count(const char* what, GlobalIndex n_numbers = 1) {
    return checked_count(what, long_integer(what), n_numbers);
  }

  /// Reads a count like count(), from text on a separate line, also in binary files.
  GlobalIndex text_count(const char* what, GlobalIndex n_numbers) {
    const auto value = text_integer(what);
    if (is_binary_ && !line().empty()) fail(fmt::format("the line with the number of {} goes on", what));
    return checked_count(what, value, n_numbers);
  }

  Real number(const char* what) {
    Real value = 0;
    if (is_binary_) {
      value = raw<double>(what);
    } else {
      const auto found = word(what);
      const auto parsed = base::parse_number(found);
      if (!parsed) fail(fmt::format("{} is \"{}\", must be a number", what, printable(found)));
      value = *parsed;
    }
    if (!(std::abs(value) <= 1e100)) fail(fmt::format("{} is {}, must be a number of at most 1e100", what, value));
    return value;
  }

  /// Skips a floating-point number of any value.
  void skip_number(const char* what) {
    if (is_binary_)
      raw<double>(what);
    else
      word(what);
  }

  template <class T>
  T raw(const char* what) {
    start_ = at_;
    T value;
    if (text_.size() - at_ < sizeof value) fail(fmt::format("the file ends before {}", what));
    std::memcpy(&value, text_.data() + at_, sizeof value);
    at_ += sizeof value;
    return value;
  }

 private:
  std::string_view text_;
  std::string file_, section_;
  const char* kind_ = "";
  GlobalIndex tag_ = 0;
  std::size_t at_ = 0, start_ = 0;  ///< positions of the next item and of the last item read
  bool is_binary_ = false, has_wide_tags_ = false;

  GlobalIndex checked_count(const char* what, GlobalIndex value, GlobalIndex n_numbers) const {
    const auto rest = static_cast<GlobalIndex>(text_.size() - at_);
    const auto largest = is_binary_ ? rest / (4 * n_numbers) : (rest + 1) / (2 * n_numbers);
    if (value < 0 || value > largest)
      fail(fmt::format("the number of {} is {}, which the rest of the file, {} bytes, cannot hold", what, value, rest));
    return value;
  }

  std::string_view word(const char* what) {
    at_end();
    start_ = at_;
    at_ = std::min(text_.find_first_of(" \t\r\n", at_), text_.size());
    if (start_ == at_) fail(fmt::format("the file ends before {}", what));
    return text_.substr(start_, at_ - start_);
  }
};

}  // namespace sprekk::mesh
