// Strict conversion of text to numbers and lists, and texts for messages.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/types.hpp"

namespace sprekk::base {

/// Removes blanks at both ends.
std::string_view trimmed(std::string_view text);

/// Converts the whole of `text` (except for blanks at the ends) to a number. Returns nothing for other texts, e.g.
/// "1.0abc", "1,5", "" and NaN, and for numbers out of range. "infinite" is infinity, "-infinite" its negative.
std::optional<Real> parse_number(std::string_view text);
std::optional<long long> parse_integer(std::string_view text);
std::optional<bool> parse_boolean(std::string_view text);  ///< "true" or "false", not case-sensitive

/// Returns the elements of "{a, f(b, c)}", split at commas outside of parentheses and quotes. Double or single quotes
/// around an element are removed. Returns nothing if braces, quotes or parentheses do not match or an element is empty.
std::optional<std::vector<std::string>> parse_list(std::string_view text);

/// Returns the shortest text from which parse_number() reproduces exactly `value`.
std::string number_text(Real value);

/// Returns `"a", "b", "c"`.
std::string quoted_list(const std::vector<std::string>& names);

/// Returns a text for a message; if it exceeds 200 bytes, its first 60 bytes (whole characters) and its length.
std::string shortened(const std::string& text);

/// Returns the text as an XML attribute, with &lt; &gt; &amp; &quot; for < > & ".
std::string xml_escaped(const std::string& text);

/// Returns "1 value", "2 values".
std::string counted(std::size_t n, const std::string& what);

/// Returns a hint if `text` is not a number but begins with grouped digits: "30,000 MPa", "1,5", "30 000"; else "".
std::string hint_on_digits(std::string_view text);

/// Position of the first byte that is not UTF-8; nothing if the whole text is UTF-8.
std::optional<std::size_t> where_not_utf8(std::string_view text);

/// Converts to lower case and removes blanks, "-" and "_".
std::string without_separators(const std::string& name);

/// Returns `. Did you mean "..."?` for the most similar of `allowed`, or "". Case, blanks, "-" and "_" are ignored.
std::string did_you_mean(const std::string& name, const std::vector<std::string>& allowed);

}  // namespace sprekk::base
