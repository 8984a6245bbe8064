// Repose: JSON text to tree and back, on JsonCpp. JsonCpp reads numbers through the C++ locale of the process,
// so that a host with decimal commas would get 1 for 1.5, or be refused where points part thousands, and it
// takes "-" and "01" for numbers; so it is shown whole numbers in the place of others, and numbers are decoded
// again here, from their text.
#include "engine/reading/json_text.h"

#include <json/reader.h>
#include <json/writer.h>

#include <algorithm>
#include <charconv>
#include <memory>
#include <optional>
#include <sstream>
#include <string_view>
#include <system_error>

#include "engine/base/caught.h"
#include "engine/base/wording.h"

namespace repose {
namespace {

constexpr int kMostNested = 64;
constexpr std::size_t kMostQuoted = 40;  // characters of a found text that a message repeats

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

std::size_t digits_at(std::string_view text, std::size_t from) {
  std::size_t end = from;
  while (end < text.size() && is_digit(text[end])) ++end;
  return end - from;
}

/// The grammar of RFC 8259, section 6.
bool is_number(std::string_view text) {
  std::size_t i = text.starts_with('-') ? 1 : 0;
  const std::size_t whole = digits_at(text, i);
  if (whole == 0 || (whole > 1 && text[i] == '0')) return false;
  i += whole;
  if (i < text.size() && text[i] == '.') {
    const std::size_t fraction = digits_at(text, i + 1);
    if (fraction == 0) return false;
    i += 1 + fraction;
  }
  if (i < text.size() && (text[i] == 'e' || text[i] == 'E')) {
    ++i;
    if (i < text.size() && (text[i] == '+' || text[i] == '-')) ++i;
    const std::size_t exponent = digits_at(text, i);
    if (exponent == 0) return false;
    i += exponent;
  }
  return i == text.size();
}

/// Whether what is a number is one with a fraction or an exponent.
bool has_fraction(std::string_view number) {
  return number.find_first_of(".eE") != std::string_view::npos;
}

/// The text with whole numbers, as long as they were, where there are fractions and exponents.
std::string with_whole_numbers(const SourceText& source) {
  std::string text = source.text();
  source.for_each_word([&text](std::size_t start, std::size_t length) {
    const std::string_view word = std::string_view(text).substr(start, length);
    double decoded = 0.0;
    if (!is_number(word) || !has_fraction(word)) return;
    // What is too large for a double is left to JsonCpp, which says so.
    if (std::from_chars(word.data(), word.data() + word.size(), decoded).ec != std::errc()) return;
    const std::size_t sign = word[0] == '-' ? 1 : 0;
    std::fill_n(text.begin() + static_cast<std::ptrdiff_t>(start + sign), length - sign, '1');
  });
  return text;
}

/// Decodes the numbers below `value` again from `text`, independently of any locale.
void decode_numbers(Json::Value& value, std::string_view text, Complaints& complaints) {
  for (Json::Value& child : value) decode_numbers(child, text, complaints);
  if (!value.isNumeric()) return;
  const std::ptrdiff_t start = value.getOffsetStart();
  const std::ptrdiff_t limit = value.getOffsetLimit();
  const std::string_view digits =
      text.substr(static_cast<std::size_t>(start), static_cast<std::size_t>(limit - start));
  if (!is_number(digits)) {
    complaints.add(start, "",
                   "\"" + std::string(digits) + "\" is not a number; write for example 0.5, -2 or 1e-3");
    return;
  }
  if (value.type() != Json::realValue && !has_fraction(digits)) return;
  double decoded = 0.0;
  // Out of range means too small for a double here, as what is too large did not parse: zero stands for it.
  std::from_chars(digits.data(), digits.data() + digits.size(), decoded);
  Json::Value number(decoded);
  value.swapPayload(number);  // keeps the offsets of `value`
}

/// Where a bracket closes at `at`, the comma before it.
std::optional<std::ptrdiff_t> comma_before_an_end(std::string_view text, std::ptrdiff_t at) {
  if (at <= 0 || static_cast<std::size_t>(at) >= text.size()) return {};
  const char end = text[static_cast<std::size_t>(at)];
  const std::size_t before = text.find_last_not_of(" \t\r\n", static_cast<std::size_t>(at - 1));
  if ((end != '}' && end != ']') || before == text.npos || text[before] != ',') return {};
  return static_cast<std::ptrdiff_t>(before);
}

/// JsonCpp reports "* Line 3, Column 5" and on the next line, indented, what is wrong. Of several errors the
/// first counts; the others mostly follow from it.
void complain_of_syntax(const std::string& report, const SourceText& source, Complaints& complaints) {
  std::istringstream lines(report);
  lines.imbue(std::locale::classic());
  std::string word;
  std::ptrdiff_t line = 1;
  std::ptrdiff_t column = 1;
  char comma = ',';
  lines >> word >> word >> line >> comma >> word >> column >> std::ws;
  std::string message;
  std::getline(lines, message);
  const std::ptrdiff_t at = source.offset_of(line, column);
  if (const auto useless = comma_before_an_end(source.text(), at)) {
    complaints.add(*useless, "", "not JSON: a comma after which nothing comes; remove it");
    return;
  }
  complaints.add(at, "", "not JSON: " + message);
}

}  // namespace

Json::Value parse_json(const SourceText& source, Complaints& complaints) {
  Json::Value root;
  if (const auto deep = source.deeper_than(kMostNested)) {
    complaints.add(*deep, "", "nested too deep; at most " + std::to_string(kMostNested) + " levels are read");
    return root;
  }
  if (const std::size_t nul = source.text().find('\0'); nul != std::string::npos) {
    complaints.add(static_cast<std::ptrdiff_t>(nul), "",
                   "not JSON: a byte of value 0; a scene is text in UTF-8");
    return root;
  }
  Json::CharReaderBuilder builder;
  builder["collectComments"] = false;
  builder["allowTrailingCommas"] = false;
  builder["failIfExtra"] = true;
  builder["rejectDupKeys"] = true;
  builder["stackLimit"] = kMostNested + 8;  // never met: the scanner above gives the place as well
  const std::unique_ptr<Json::CharReader> reader(builder.newCharReader());
  const std::string text = with_whole_numbers(source);
  std::string report;
  bool parsed = false;
  try {
    parsed = reader->parse(text.data(), text.data() + text.size(), &root, &report);
  } catch (const std::exception& exception) {
    if (is_of_memory(exception)) throw std::bad_alloc();
    complaints.add(0, "", std::string("not JSON: ") + exception.what());
    return root;
  }
  if (parsed) {
    decode_numbers(root, source.text(), complaints);
  } else {
    complain_of_syntax(report, source, complaints);
  }
  return root;
}

std::string compact_json(const Json::Value& value, unsigned digits) {
  Json::StreamWriterBuilder builder;
  builder["indentation"] = "";
  builder["commentStyle"] = "None";
  builder["precision"] = digits;
  return Json::writeString(builder, value);
}

std::string found_text(const Json::Value& value) {
  switch (value.type()) {
    case Json::nullValue:
      return "null";
    case Json::booleanValue:
      return value.asBool() ? "true" : "false";
    case Json::intValue:
      return std::to_string(value.asInt64());
    case Json::uintValue:
      return std::to_string(value.asUInt64());
    case Json::realValue:
      return number_text(value.asDouble());
    case Json::arrayValue:
      return "a list";
    case Json::objectValue:
      return "an object";
    case Json::stringValue:
      break;
  }
  const std::string text = value.asString();
  return "text \"" + (text.size() <= kMostQuoted ? text : text.substr(0, kMostQuoted) + "...") + "\"";
}

}  // namespace repose
