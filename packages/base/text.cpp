#include "base/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <limits>

namespace sprekk::base {

namespace {

std::string lower(std::string_view text) {
  std::string result(text);
  for (char& c : result) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return result;
}

template <class T>
std::optional<T> parse_whole(std::string_view text) {
  text = trimmed(text);
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  T value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

/// Number of insertions, deletions, replacements and swaps of neighbours that convert a to b.
std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::vector<std::size_t>> d(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i)
    for (std::size_t j = 0; j <= b.size(); ++j) {
      if (i == 0 || j == 0) {
        d[i][j] = i + j;
        continue;
      }
      d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, d[i - 1][j - 1] + (a[i - 1] != b[j - 1])});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
    }
  return d[a.size()][b.size()];
}

std::string_view unquoted(std::string_view text) {
  text = trimmed(text);
  const bool quotes = text.size() > 1 && (text[0] == '"' || text[0] == '\'') && text.back() == text[0] &&
                      text.find(text[0], 1) == text.size() - 1;
  return quotes ? text.substr(1, text.size() - 2) : text;
}

}  // namespace

std::string_view trimmed(std::string_view text) {
  const auto blanks = " \t\r\n";
  const auto first = text.find_first_not_of(blanks);
  return first == text.npos ? std::string_view() : text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

std::optional<Real> parse_number(std::string_view text) {
  constexpr Real infinity = std::numeric_limits<Real>::infinity();
  if (trimmed(text) == "infinite") return infinity;
  if (trimmed(text) == "-infinite") return -infinity;
  const auto value = parse_whole<Real>(text);
  return value && std::isfinite(*value) ? value : std::nullopt;
}

std::optional<long long> parse_integer(std::string_view text) { return parse_whole<long long>(text); }

std::optional<bool> parse_boolean(std::string_view text) {
  const std::string word = lower(trimmed(text));
  if (word == "true") return true;
  if (word == "false") return false;
  return std::nullopt;
}

std::optional<std::vector<std::string>> parse_list(std::string_view text) {
  text = trimmed(text);
  if (text.size() < 2 || text.front() != '{' || text.back() != '}') return std::nullopt;
  text = text.substr(1, text.size() - 2);
  std::vector<std::string> elements;
  if (trimmed(text).empty()) return elements;
  int depth = 0;
  char quote = 0;
  std::size_t begin = 0;
  for (std::size_t i = 0; i <= text.size(); ++i) {
    const char c = i < text.size() ? text[i] : ',';
    if (quote && i < text.size()) {
      if (c == quote) quote = 0;
    } else if (c == '"' || c == '\'') {
      quote = c;
    } else if (c == '(' || c == ')') {
      depth += c == '(' ? 1 : -1;
      if (depth < 0) return std::nullopt;
    } else if (c == '{' || c == '}') {
      return std::nullopt;
    } else if (c == ',' && (depth == 0 || i == text.size())) {
      const auto element = trimmed(text.substr(begin, i - begin));
      if (element.empty()) return std::nullopt;
      elements.emplace_back(unquoted(element));
      begin = i + 1;
    }
  }
  if (depth != 0 || quote) return std::nullopt;
  return elements;
}

std::string number_text(Real value) {
  if (std::isinf(value)) return value > 0 ? "infinite" : "-infinite";
  return fmt::format("{}", value);
}

std::string quoted_list(const std::vector<std::string>& names) {
  constexpr std::size_t maximum = 40, longest = 1500;  // in a message; the most similar name is given separately
  std::string text;
  std::size_t k = 0;
  for (; k < std::min(maximum, names.size()) && text.size() < longest; ++k)
    text += fmt::format("{}\"{}\"", text.empty() ? "" : ", ", shortened(names[k]));
  return k == names.size() ? text : fmt::format("{} and {} more", text, names.size() - k);
}

std::string shortened(const std::string& text) {
  constexpr std::size_t longest = 200, shown = 60;
  if (text.size() <= longest) return text;
  std::size_t end = shown;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xc0) == 0x80) --end;  // inside a UTF-8 character
  return fmt::format("{}... ({} bytes)", text.substr(0, end), text.size());
}

std::string xml_escaped(const std::string& text) {
  std::string result;
  for (char c : text) switch (c) {
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '&':
        result += "&amp;";
        break;
      case '"':
        result += "&quot;";
        break;
      default:
        result += c;
    }
  return result;
}

std::string counted(std::size_t n, const std::string& what) {
  return fmt::format("{} {}{}", n, what, n == 1 ? "" : "s");
}

std::string hint_on_digits(std::string_view text) {
  const auto digits = "0123456789";
  text = trimmed(text);
  if (!text.empty() && (text[0] == '+' || text[0] == '-')) text.remove_prefix(1);
  const auto end = text.find_first_not_of(digits);
  if (end == 0 || end == text.npos) return "";
  const auto next = text.find_first_not_of(text[end] == ',' || text[end] == '\'' ? text.substr(end, 1) : " ", end);
  if (next == end || next == text.npos || text.find_first_of(digits, next) != next) return "";
  return "; numbers have a decimal point and no separators of thousands: 1.5, 30000";
}

std::optional<std::size_t> where_not_utf8(std::string_view text) {
  const auto byte = [&](std::size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u; };
  for (std::size_t i = 0; i < text.size();) {
    const unsigned lead = byte(i);
    const int n = lead < 0x80 ? 0 : lead >> 5 == 6 ? 1 : lead >> 4 == 14 ? 2 : lead >> 3 == 30 ? 3 : -1;
    unsigned code = n <= 0 ? lead : lead & (0x3fu >> n);
    for (int k = 1; k <= n; ++k) {
      if (byte(i + k) >> 6 != 2) return i;
      code = code << 6 | (byte(i + k) & 0x3f);
    }
    constexpr unsigned minimum[] = {0, 0x80, 0x800, 0x10000};
    if (n < 0 || code < minimum[n] || code > 0x10ffff || (code >= 0xd800 && code < 0xe000)) return i;
    i += n + 1;
  }
  return std::nullopt;
}

std::string without_separators(const std::string& name) {
  std::string result = lower(name);
  const auto separator = [](char c) { return c == ' ' || c == '_' || c == '-'; };
  result.erase(std::remove_if(result.begin(), result.end(), separator), result.end());
  return result;
}

std::string did_you_mean(const std::string& name, const std::vector<std::string>& allowed) {
  constexpr std::size_t longest = 1000;
  if (name.size() > longest) return "";
  const std::string wanted = without_separators(name);
  std::size_t smallest = std::min(std::clamp<std::size_t>(wanted.size() / 3, 1, 3) + 1, wanted.size());
  std::string nearest;
  for (const auto& candidate : allowed) {
    const auto distance = edit_distance(wanted, without_separators(candidate));
    if (distance >= smallest) continue;
    smallest = distance;
    nearest = fmt::format(". Did you mean \"{}\"?", candidate);
  }
  return nearest;
}

}  // namespace sprekk::base
