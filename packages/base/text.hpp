// Numbers and lists as text, strictly: a text that is not wholly what is asked for is refused.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/types.hpp"

namespace sprekk::base {

std::string_view trimmed(std::string_view text);

/// The number that the whole of `text` (blanks at the ends aside) is, or nothing: "1.0abc", "1,5", "" and NaN are none,
/// nor is what a Real or a long long cannot hold. "infinite" is the number infinity, "-infinite" its negative.
std::optional<Real> parse_number(std::string_view text);
std::optional<long long> parse_integer(std::string_view text);
std::optional<bool> parse_boolean(std::string_view text);  ///< "true" or "false", in any case

/// The elements of "{a, f(b, c)}", split at commas outside of parentheses and quotes; an element in double or single
/// quotes stands for what is inside them. Nothing if braces, quotes or parentheses do not match or an element is empty.
std::optional<std::vector<std::string>> parse_list(std::string_view text);

/// The shortest text that parse_number turns back into exactly `value`.
std::string number_text(Real value);

/// `"a", "b", "c"`
std::string quoted_list(const std::vector<std::string>& names);

/// A text as a message repeats it: one of more than 200 bytes by its first 60 characters and its length.
std::string shortened(const std::string& text);

/// As an attribute of XML: with &lt; &gt; &amp; &quot; for < > & ".
std::string xml_escaped(const std::string& text);

/// "1 value", "2 values"
std::string counted(std::size_t n, const std::string& what);

/// What helps where `text`, which is no number, opens like one with groups of digits: "30,000 MPa", "1,5", "30 000";
/// else empty.
std::string hint_on_digits(std::string_view text);

/// Where `text` stops being UTF-8; nothing if it is UTF-8 from end to end.
std::optional<std::size_t> where_not_utf8(std::string_view text);

/// In lower case, without blanks, "-" and "_".
std::string without_separators(const std::string& name);

/// `. Did you mean "..."?` for the nearest of `allowed`, case, blanks, "-" and "_" aside; empty if none is near.
std::string did_you_mean(const std::string& name, const std::vector<std::string>& allowed);

}  // namespace sprekk::base
