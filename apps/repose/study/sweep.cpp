#include "apps/repose/study/sweep.h"

#include "engine/base/wording.h"

namespace repose {
namespace {

/// Parts of a text between marks that stand in no bracket and no quotation.
std::vector<std::string> split(const std::string& text, char mark) {
  std::vector<std::string> parts(1);
  int depth = 0;
  bool quoted = false;
  for (const char c : text) {
    if (c == '"') quoted = !quoted;
    if (!quoted && (c == '[' || c == '{' || c == '(')) ++depth;
    if (!quoted && (c == ']' || c == '}' || c == ')')) --depth;
    if (c == mark && depth == 0 && !quoted) {
      parts.emplace_back();
    } else {
      parts.back() += c;
    }
  }
  for (std::string& part : parts) part = trimmed(part);
  return parts;
}

/// What is wrong with the values of a key; empty if nothing is.
std::string fault(const Vary& vary) {
  for (std::size_t k = 0; k < vary.values.size(); ++k) {
    if (vary.values[k].empty())
      return "a value is missing; write for example 0.02,0.01, or absent to leave the key out";
    for (std::size_t i = 0; i < k; ++i) {
      if (vary.values[i] == vary.values[k]) return "the value " + vary.values[k] + " is there twice";
    }
  }
  return "";
}

}  // namespace

Result<Vary> parse_vary(const std::string& words) {
  const std::size_t equals = words.find('=');
  Vary vary{trimmed(words.substr(0, equals)), {}};
  if (equals == std::string::npos || vary.key.empty())
    return Error{ErrorKind::kUsage,
                 "'" + words + "' varies nothing; expected key=value,value, such as grid.spacing=0.02,0.01",
                 "--vary"};
  vary.values = split(words.substr(equals + 1), ',');
  if (const std::string wrong = fault(vary); !wrong.empty())
    return Error{ErrorKind::kUsage, vary.key + ": " + wrong, "--vary"};
  return vary;
}

Result<Vary> vary_of(const VariedKey& varied) {
  Vary vary{trimmed(varied.key), split(varied.values, ',')};
  if (const std::string wrong = fault(vary); !wrong.empty())
    return Error{ErrorKind::kBadScene, vary.key + ": " + wrong, "study.vary"};
  return vary;
}

std::vector<std::string> Point::overrides() const {
  std::vector<std::string> words;
  for (const Setting& setting : settings)
    words.push_back(setting.key + "=" + (setting.value == kAbsent ? "" : setting.value));
  return words;
}

std::string Point::text() const {
  std::string text;
  for (const Setting& setting : settings)
    text += (text.empty() ? "" : ", ") + setting.key + " " + setting.value;
  return text.empty() ? "as written" : text;
}

std::vector<Point> points_of(const std::vector<Vary>& vary, Design design) {
  std::vector<Point> points(1);
  for (const Vary& each : vary) {
    std::vector<Point> more;
    if (design == Design::kOneByOne) {
      for (const std::string& value : each.values) more.push_back({{{each.key, value}}});
      points.insert(points.end(), more.begin(), more.end());
      continue;
    }
    for (const Point& point : points) {
      for (const std::string& value : each.values) {
        more.push_back(point);
        more.back().settings.push_back({each.key, value});
      }
    }
    points = std::move(more);
  }
  return points;
}

Result<Point> parse_settings(const std::string& words) {
  Point point;
  for (const std::string& word : split(words, ';')) {
    if (word.empty()) continue;
    const std::size_t equals = word.find('=');
    if (equals == std::string::npos || equals == 0)
      return Error{ErrorKind::kUsage, "'" + word + "' is no setting; expected key=value; key=value", "finest"};
    const std::string value = trimmed(word.substr(equals + 1));
    point.settings.push_back({trimmed(word.substr(0, equals)), value.empty() ? kAbsent : value});
  }
  return point;
}

}  // namespace repose
