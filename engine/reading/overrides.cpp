// Repose: overrides of scene values.
#include "engine/reading/overrides.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <utility>

#include "engine/base/wording.h"
#include "engine/reading/expressions.h"
#include "engine/reading/json_text.h"

namespace repose {
namespace {

/// "a[0].b" as "a", "0", "b"; empty where brackets do not match or a step is missing.
std::vector<std::string> split_path(const std::string& path) {
  std::vector<std::string> steps;
  std::string step;
  bool bracket = false;
  bool closed = false;  // behind "]", where no empty step is meant
  const auto end_step = [&] {
    if (!step.empty()) steps.push_back(step);
    const bool filled = !step.empty() || closed;
    step.clear();
    closed = false;
    return filled;
  };
  for (const char c : path) {
    const bool opens = c == '[' && !bracket;
    const bool closes = c == ']' && bracket;
    if (opens || closes || (c == '.' && !bracket)) {
      if (!end_step()) return {};
      bracket = opens;
      closed = closes;
    } else if (c == '[' || c == ']' || closed) {
      return {};
    } else {
      step += c;
    }
  }
  if (bracket || !end_step()) return {};
  return steps;
}

/// Marks every value below `value` as coming from `offset`.
void place_at(Json::Value& value, std::ptrdiff_t offset) {
  value.setOffsetStart(offset);
  value.setOffsetLimit(offset);
  for (Json::Value& child : value) place_at(child, offset);
}

Json::Value parse_value(const std::string& text, std::ptrdiff_t offset) {
  Complaints unread;
  Json::Value value = parse_json(SourceText("", text), unread);
  if (!unread.empty()) value = Json::Value(text);
  place_at(value, offset);
  return value;
}

std::vector<std::string> names_within(const Json::Value& value) {
  if (value.isObject()) return value.getMemberNames();
  std::vector<std::string> names;
  for (const Json::Value& element : value) {
    if (element.isObject() && element["name"].isString()) names.push_back(element["name"].asString());
  }
  return names;
}

/// The element of a list at a position, or of that "name"; null where there is none.
Json::Value* find_element(Json::Value& list, const std::string& step) {
  Json::ArrayIndex index = 0;
  const auto parsed = std::from_chars(step.data(), step.data() + step.size(), index);
  if (parsed.ec == std::errc() && parsed.ptr == step.data() + step.size()) {
    return index < list.size() ? &list[index] : nullptr;
  }
  for (Json::Value& element : list) {
    if (!element.isObject()) continue;
    const Json::Value& name = std::as_const(element)["name"];  // the other operator[] would add a member
    if (name.isString() && name.asString() == step) return &element;
  }
  return nullptr;
}

/// What `step` leads to. An object gets a new key where there is none, with an object in it if the path goes on
/// by a name: "output.vtp=true" works on a scene without "output". A misspelt key then meets the reader like
/// any other.
Json::Value* find_step(Json::Value& value, const std::string& step, const std::string* following,
                       std::ptrdiff_t offset) {
  if (value.isArray()) return find_element(value, step);
  if (!value.isObject()) return nullptr;
  if (value.isMember(step) || following == nullptr) return &value[step];
  const bool index = following->find_first_not_of("0123456789") == std::string::npos;
  return index ? nullptr : &(value[step] = parse_value("{}", offset));
}

/// What the steps lead to, of what is there; null where they lead nowhere.
Json::Value* follow(Json::Value& root, const std::vector<std::string>& steps) {
  Json::Value* value = &root;
  for (const std::string& step : steps) {
    if (value->isArray()) {
      value = find_element(*value, step);
    } else {
      value = value->isObject() && value->isMember(step) ? &(*value)[step] : nullptr;
    }
    if (value == nullptr) return nullptr;
  }
  return value;
}

std::string missing_text(const Json::Value& value, const std::string& step, const std::string& reached) {
  const std::string parent = reached.empty() ? "the scene" : "\"" + reached + "\"";
  if (!value.isObject() && !value.isArray()) {
    return parent + " is " + found_text(value) + " and holds no \"" + step + "\"";
  }
  std::string text = parent + " has no \"" + step + "\"";
  if (value.isArray()) text += " among its " + std::to_string(value.size()) + " elements, which count from 0";
  const std::vector<std::string> names = names_within(value);
  return names.empty() ? text : text + "; " + did_you_mean(step, names);
}

void apply(const std::string& argument, Json::Value& root, std::ptrdiff_t offset, Complaints& complaints) {
  const std::size_t equals = argument.find('=');
  const std::vector<std::string> steps = split_path(argument.substr(0, equals));
  if (equals == std::string::npos || steps.empty()) {
    complaints.add(offset, "", "not an override; expected key.path=value, such as bodies[0].seed=2");
    return;
  }
  if (equals + 1 == argument.size()) {
    Json::Value* const holder = follow(root, {steps.begin(), steps.end() - 1});
    if (holder != nullptr && holder->isObject()) holder->removeMember(steps.back());
    return;
  }
  Json::Value* target = &root;
  std::string reached;
  for (const std::string& step : steps) {
    Json::Value* next = find_step(*target, step, &step == &steps.back() ? nullptr : &step + 1, offset);
    if (next == nullptr) {
      complaints.add(offset, "", missing_text(*target, step, reached));
      return;
    }
    reached += target->isArray() ? "[" + step + "]" : (reached.empty() ? "" : ".") + step;
    target = next;
  }
  *target = parse_value(argument.substr(equals + 1), offset);
}

/// Whether an expression somewhere in `value` names a parameter.
bool uses(const Json::Value& value, const std::string& name) {
  if (value.isString()) {
    const std::string text = value.asString();
    if (!Expressions::is_expression(text)) return false;
    const auto in_name = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; };
    for (std::size_t at = text.find(name); at != std::string::npos; at = text.find(name, at + 1)) {
      const std::size_t end = at + name.size();
      if (!in_name(text[at - 1]) && (end == text.size() || !in_name(text[end]))) return true;
    }
    return false;
  }
  return std::any_of(value.begin(), value.end(),
                     [&name](const Json::Value& child) { return uses(child, name); });
}

/// A parameter that the scene did not have, and that no expression names, changes nothing: it is misspelt.
void check_parameter(const std::string& argument, const std::vector<std::string>& known,
                     const Json::Value& root, std::ptrdiff_t offset, Complaints& complaints) {
  const std::vector<std::string> steps = split_path(argument.substr(0, argument.find('=')));
  if (steps.size() != 2 || steps[0] != "parameters") return;
  if (std::find(known.begin(), known.end(), steps[1]) != known.end() || uses(root, steps[1])) return;
  complaints.add(
      offset, "",
      "no expression of the scene names a parameter \"" + steps[1] + "\"; " + did_you_mean(steps[1], known));
}

}  // namespace

const Json::Value* find_value(Json::Value& root, const std::string& path) {
  const std::vector<std::string> steps = split_path(path);
  return steps.empty() ? nullptr : follow(root, steps);
}

void apply_overrides(const std::vector<std::string>& overrides, Json::Value& root, SourceText& source,
                     Complaints& complaints) {
  std::vector<std::string> parameters;
  if (root.isMember("parameters") && root["parameters"].isObject())
    parameters = root["parameters"].getMemberNames();
  std::vector<std::ptrdiff_t> places;
  for (const std::string& argument : overrides) {
    places.push_back(source.add_words("--set " + argument));
    apply(argument, root, places.back(), complaints);
  }
  for (std::size_t k = 0; k < overrides.size(); ++k)
    check_parameter(overrides[k], parameters, root, places[k], complaints);
}

}  // namespace repose
