// Repose: the words of messages about scenes.
#include "engine/base/wording.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <numeric>

namespace repose {
namespace {

constexpr std::size_t kMostCompared = 80;  // characters of a misspelt name that are compared with the known

std::string in_quotes(const std::string& text) {
  return "\"" + text + "\"";
}

char lower(char c) {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

/// Levenshtein's distance, a row at a time; capitals are as good as small letters.
std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = diagonal + (lower(a[i]) == lower(b[j]) ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({row[j] + 1, row[j + 1] + 1, replaced});
    }
  }
  return row.back();
}

}  // namespace

std::string number_text(double value) {
  char buffer[32];
  const auto end = std::to_chars(buffer, buffer + sizeof buffer, value).ptr;
  return {buffer, end};
}

std::string short_number(double value, int digits) {
  if (!std::isfinite(value)) return "-";
  const double size = std::abs(value);
  const bool whole = size >= 1e5 && size < 1e9 && value == std::floor(value);
  char text[32];
  std::snprintf(text, sizeof text, "%.*g", whole ? 9 : digits, value);
  return text;
}

std::string range_text(const Quantity& quantity) {
  const bool bounded_below = std::isfinite(quantity.low);
  const bool bounded_above = std::isfinite(quantity.high);
  if (bounded_below && quantity.low == quantity.high) return "exactly " + number_text(quantity.low);
  std::string text;
  if (bounded_below) text = (quantity.low_open ? "greater than " : "at least ") + number_text(quantity.low);
  if (bounded_below && bounded_above) text += " and ";
  if (bounded_above) text += (quantity.high_open ? "less than " : "at most ") + number_text(quantity.high);
  return text;
}

std::string expected_text(const std::string& noun, const Quantity& quantity) {
  const std::string unit = quantity.unit;
  const std::string range = range_text(quantity);
  return noun + (unit.empty() ? "" : " in " + unit) + (range.empty() ? "" : ", " + range);
}

std::string list_text(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + in_quotes(name);
  return text;
}

std::string plain_list_text(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

std::string trimmed(const std::string& text, const char* blank) {
  const std::size_t first = text.find_first_not_of(blank);
  return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(blank) - first + 1);
}

std::string nearest(const std::string& name, const std::vector<std::string>& candidates) {
  const std::string start = name.substr(0, kMostCompared);
  const auto best = std::min_element(candidates.begin(), candidates.end(), [&](const auto& a, const auto& b) {
    return edit_distance(start, a) < edit_distance(start, b);
  });
  return best == candidates.end() ? "" : *best;
}

bool alike(const std::string& name, const std::string& meant) {
  return edit_distance(name.substr(0, kMostCompared), meant) <= std::max<std::size_t>(2, meant.size() / 3);
}

std::string did_you_mean(const std::string& name, const std::vector<std::string>& candidates) {
  if (candidates.empty()) return "none is known here";
  const std::string best = nearest(name, candidates);
  if (alike(name, best)) return "did you mean " + in_quotes(best) + "?";
  return "the nearest is " + in_quotes(best) + "; known are " + list_text(candidates);
}

}  // namespace repose
