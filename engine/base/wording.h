// Repose: the words of messages about scenes and of their reference: what is expected of a value,
// and which known name a misspelt one is nearest to.
#pragma once

#include <string>
#include <vector>

#include "kernels/base/quantity.h"

namespace repose {

/// The shortest decimal that reads back as `value`.
std::string number_text(double value);
/// So many significant digits, without zeros at the end: "0.0123", "1.5e-07"; "-" for what is no number.
std::string short_number(double value, int digits = 3);

/// "greater than 0 and at most 1"; empty where there is no bound.
std::string range_text(const Quantity& quantity);

/// "a number in m, greater than 0", with `noun` for "a number".
std::string expected_text(const std::string& noun, const Quantity& quantity);

/// "a, b, c", each in quotation marks.
std::string list_text(const std::vector<std::string>& names);

/// "a, b, c", as they are.
std::string plain_list_text(const std::vector<std::string>& names);

/// Without what is in `blank` at either end.
std::string trimmed(const std::string& text, const char* blank = " \t\r\n");

/// The candidate with the least edit distance to `name`; empty where there is none.
std::string nearest(const std::string& name, const std::vector<std::string>& candidates);

/// Whether `name` may be `meant`, misspelt.
bool alike(const std::string& name, const std::string& meant);

/// "did you mean \"radius\"?", or all candidates where none is much like `name`.
std::string did_you_mean(const std::string& name, const std::vector<std::string>& candidates);

}  // namespace repose
