// Reproducible damage of texts.
#pragma once

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace sprekk::fuzz {

class Mutator {
 public:
  explicit Mutator(unsigned long long seed) : random_(seed) {}

  /// Returns the text with one to four kinds of damage.
  std::string damaged(std::string text) {
    for (auto n = below(2) * below(4) + 1; n > 0; --n) damage(text);
    return text;
  }

 private:
  std::mt19937_64 random_;

  std::size_t below(std::size_t n) { return n == 0 ? 0 : random_() % n; }

  void damage(std::string& text) {
    switch (below(9)) {
      case 0:
        for (auto n = below(2) * below(8) + 1; n > 0 && !text.empty(); --n)
          text[below(text.size())] ^= static_cast<char>(1 << below(8));
        break;
      case 1:
        if (below(4) == 0) text.resize(below(text.size()));
        break;
      case 2:
      case 3:
        replace_number(text);
        break;
      case 4: {  // copy of a block elsewhere
        const auto at = below(text.size());
        text.insert(below(text.size()), text.substr(at, below(400)));
        break;
      }
      case 5:
      case 6:
        change_line(text);
        break;
      case 7:
        swap_numbers(text);
        break;
      default:
        overwrite_integer(text);
    }
  }

  /// Returns position and length of a number; length 0 if there is none.
  std::pair<std::size_t, std::size_t> some_number(const std::string& text) {
    const auto start = text.find_first_of("0123456789", below(text.size()));
    if (start == text.npos) return {0, 0};
    return {start, std::min(text.find_first_not_of("0123456789.+-eE", start), text.size()) - start};
  }

  void swap_numbers(std::string& text) {
    auto first = some_number(text), second = some_number(text);
    if (first > second) std::swap(first, second);
    if (first.first + first.second > second.first) return;
    const auto a = text.substr(first.first, first.second), b = text.substr(second.first, second.second);
    text.replace(second.first, second.second, a).replace(first.first, first.second, b);
  }

  void replace_number(std::string& text) {
    static const char* const extremes[] = {"0",
                                           "-1",
                                           "1",
                                           "2",
                                           "3",
                                           "9223372036854775807",
                                           "nan",
                                           "inf",
                                           "1e308",
                                           "1e-308",
                                           "-9223372036854775808",
                                           "4294967296",
                                           "2147483647",
                                           "-2147483648",
                                           "1e99",
                                           "",
                                           "x",
                                           "1e15",
                                           "99999999999999999999",
                                           "{}"};
    const auto [start, length] = some_number(text);
    if (length > 0) text.replace(start, length, extremes[below(std::size(extremes))]);
  }

  /// Deletes a line, duplicates it, or moves it.
  void change_line(std::string& text) {
    const auto start = text.find('\n', below(text.size()));
    if (start == text.npos) return;
    const auto end = std::min(text.find('\n', start + 1), text.size());
    const auto line = text.substr(start, end - start);
    const auto how = below(3);
    if (how != 1) text.erase(start, end - start);
    if (how == 0) return;
    const auto target = text.find('\n', below(text.size()));
    text.insert(target == text.npos ? text.size() : target, line);
  }

  void overwrite_integer(std::string& text) {
    static const long long extremes[] = {
        0, 1, -1, 2, 0x7fffffff, -0x80000000LL, 0x7fffffffffffffffLL, 1000, 0x7ff8000000000000LL};
    const auto value = extremes[below(std::size(extremes))];
    const std::size_t size = below(2) == 0 ? 4 : 8;
    if (text.size() < size) return;
    const auto* bytes = reinterpret_cast<const char*>(&value);
    text.replace(below(text.size() - size), size, bytes, size);
  }
};

/// Returns the contents of all files with this ending in a folder and its subfolders, in the order of their names.
inline std::vector<std::string> contents(const std::string& folder, const std::string& ending) {
  std::vector<std::filesystem::path> paths;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
    if (entry.path().extension() == ending) paths.push_back(entry.path());
  std::sort(paths.begin(), paths.end());
  std::vector<std::string> result;
  for (const auto& path : paths) {
    std::ifstream file(path, std::ios::binary);
    std::ostringstream text;
    text << file.rdbuf();
    result.push_back(text.str());
  }
  return result;
}

}  // namespace sprekk::fuzz
