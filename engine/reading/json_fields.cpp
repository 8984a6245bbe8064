// Repose: reading JSON objects into members, with a message for all that may be wrong there.
#include "engine/reading/json_fields.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>

#include "engine/base/wording.h"
#include "engine/reading/json_text.h"
#include "engine/reading/names_of_others.h"

namespace repose {
namespace {

template <class Named>
std::vector<std::string> names_of(std::span<const Named> named) {
  std::vector<std::string> names;
  for (const Named& entry : named) names.emplace_back(entry.name);
  return names;
}

bool in_range(double value, const Quantity& quantity) {
  const bool above = quantity.low_open ? value > quantity.low : value >= quantity.low;
  const bool below = quantity.high_open ? value < quantity.high : value <= quantity.high;
  return above && below;
}

std::string element(const std::string& path, Json::ArrayIndex index) {
  return path + "[" + std::to_string(index) + "]";
}

std::string one_of(const std::vector<std::string>& names) {
  return "one of " + list_text(names);
}

}  // namespace

JsonFields::JsonFields(Json::Value& object, std::string path, Reading& reading, const JsonFields* holder)
    : object_(object), path_(std::move(path)), reading_(reading), holder_(holder) {}

std::string JsonFields::path_of(const std::string& key) const {
  return path_.empty() ? key : path_ + "." + key;
}

Json::Value* JsonFields::find(const char* key, bool required, const std::string& expected) {
  known_.emplace_back(key);
  if (object_.isMember(key)) return &object_[key];
  if (required) {
    missing_.push_back({key, expected});
    failed_ = true;
  }
  return nullptr;
}

void JsonFields::complain(const Json::Value& value, const std::string& path, const std::string& message) {
  reading_.complaints.add(value.getOffsetStart(), path, message);
  failed_ = true;
}

void JsonFields::mistaken(const Json::Value& value, const std::string& path, const std::string& expected) {
  complain(value, path, "found " + found_text(value) + "; expected " + expected);
}

/// What other programs call by the name, where it stands here or elsewhere in the scene; else the nearest.
std::string JsonFields::meant_by(const std::string& key) const {
  for (const auto& [theirs, name, whole] : kNamesOfOthers) {
    if (key != theirs) continue;
    if (std::find(known_.begin(), known_.end(), name) != known_.end()) return did_you_mean(name, {name});
    if (path_.empty() && *whole != 0) return did_you_mean(whole, {whole});
  }
  return did_you_mean(key, known_);
}

void JsonFields::complain_of_unknown(const std::string& key) {
  const std::string of_type = type_.empty() ? "" : " for type \"" + type_ + "\"";
  reading_.complaints.add(reading_.source.key_of(object_[key].getOffsetStart()), path_of(key),
                          "unknown key" + of_type + "; " + meant_by(key));
}

void JsonFields::finish() {
  std::set<std::string> meant;  // missing keys that are there, misspelt: one message will do
  for (const std::string& key : object_.getMemberNames()) {
    if (any_key_ || std::find(known_.begin(), known_.end(), key) != known_.end()) continue;
    complain_of_unknown(key);
    const std::string best = nearest(key, known_);
    if (alike(key, best)) meant.insert(best);
  }
  for (const Missing& missing : missing_) {
    if (meant.contains(missing.key)) continue;
    complain(object_, path_of(missing.key), "missing; expected " + missing.expected);
  }
}

/// Replaces an expression by its value, in the tree.
bool JsonFields::evaluate(Json::Value& value, const std::string& path) {
  if (!value.isString() || !Expressions::is_expression(value.asString())) return true;
  const Evaluation evaluation = reading_.expressions.evaluate(value.asString().substr(1));
  if (!evaluation.value) {
    failed_ = true;
    if (!evaluation.error.empty()) complain(value, path, "\"" + value.asString() + "\" " + evaluation.error);
    return false;
  }
  Json::Value number(*evaluation.value);
  value.swapPayload(number);
  return true;
}

/// Where a text would do as an expression.
std::string JsonFields::hint_of_expression(const Json::Value& value) {
  const std::string text = value.isString() ? value.asString() : "";
  const bool looks_like_one = text.find_first_of("+*/(") != std::string::npos;
  if (text.empty() || (!looks_like_one && !reading_.expressions.evaluate(text).value)) return "";
  return "; an expression begins with \"=\": \"= " + text + "\"";
}

bool JsonFields::read_number(Json::Value& value, const std::string& path, const Quantity& quantity,
                             double& number) {
  const std::string expected = expected_text("a number", quantity);
  if (!evaluate(value, path)) return false;
  if (!value.isNumeric()) {
    mistaken(value, path, expected + hint_of_expression(value));
    return false;
  }
  const double read = value.asDouble();
  if (!std::isfinite(read) || !in_range(read, quantity)) {
    complain(value, path, number_text(read) + " is out of range; expected " + expected);
    return false;
  }
  number = read;
  return true;
}

bool JsonFields::read_integer(Json::Value& value, const std::string& path, const Quantity& quantity,
                              std::int64_t& number) {
  const std::string expected = expected_text("a whole number", quantity);
  if (!evaluate(value, path)) return false;
  if (!value.isNumeric() || (value.isDouble() && std::trunc(value.asDouble()) != value.asDouble())) {
    mistaken(value, path, expected + hint_of_expression(value));
    return false;
  }
  if (!value.isInt64() || !in_range(value.asDouble(), quantity)) {
    complain(value, path, found_text(value) + " is out of range; expected " + expected);
    return false;
  }
  number = value.asInt64();
  return true;
}

bool JsonFields::read_row(Json::Value& value, const std::string& path, int width, const Quantity& quantity,
                          std::vector<double>& row) {
  if (!value.isArray() || value.size() != static_cast<Json::ArrayIndex>(width)) {
    const std::string length = value.isArray() ? " of " + std::to_string(value.size()) : "";
    complain(value, path,
             "found " + found_text(value) + length + "; expected a list of " + std::to_string(width) +
                 ", each " + expected_text("a number", quantity));
    return false;
  }
  row.resize(static_cast<std::size_t>(width));
  bool read = true;
  for (Json::ArrayIndex i = 0; i < value.size(); ++i) {
    read = read_number(value[i], element(path, i), quantity, row[i]) && read;
  }
  return read;
}

/// The first keys of an object that is not there.
std::string JsonFields::hint_of_keys(const std::string& path, const std::function<void(Fields&)>& describe) {
  Json::Value empty(Json::objectValue);
  Complaints unheard;
  Reading aside{reading_.source, reading_.expressions, unheard, reading_.allow_outside_paths};
  JsonFields fields(empty, path, aside, this);
  describe(fields);
  constexpr std::size_t kTold = 3;
  std::vector<std::string> keys = fields.known_;
  keys.resize(std::min(keys.size(), kTold));
  return keys.empty() ? "" : " with keys such as " + list_text(keys);
}

void JsonFields::read_object(Json::Value& value, const std::string& path,
                             const std::function<void(Fields&)>& describe) {
  if (!value.isObject()) {
    mistaken(value, path, "an object {...}" + hint_of_keys(path, describe));
    return;
  }
  JsonFields fields(value, path, reading_, this);
  describe(fields);
  fields.finish();
}

void JsonFields::number(const char* key, double& value, const Quantity& quantity) {
  Json::Value* found = find(key, quantity.required, expected_text("a number", quantity));
  if (found != nullptr) read_number(*found, path_of(key), quantity, value);
}

void JsonFields::integer(const char* key, std::int64_t& value, const Quantity& quantity) {
  Json::Value* found = find(key, quantity.required, expected_text("a whole number", quantity));
  if (found != nullptr) read_integer(*found, path_of(key), quantity, value);
}

void JsonFields::flag(const char* key, bool& value, const char*) {
  Json::Value* found = find(key, false, "");
  if (found == nullptr) return;
  if (found->isBool()) {
    value = found->asBool();
  } else {
    mistaken(*found, path_of(key), "true or false");
  }
}

void JsonFields::text(const char* key, std::string& value, const char* meaning, bool required) {
  Json::Value* found = find(key, required, "text: " + std::string(meaning));
  if (found == nullptr) return;
  if (found->isString() && !(required && found->asString().empty())) {
    value = found->asString();
  } else {
    mistaken(*found, path_of(key), "text, such as \"sand\"");
  }
}

/// A path may not lead out of the scene's folder, so that a scene from elsewhere cannot read at will. Links are
/// followed later, where the file is opened; here the path as written is judged, at its place.
void JsonFields::file(const char* key, std::string& value, const char* meaning, bool required) {
  text(key, value, meaning, required);
  const Json::Value& found = std::as_const(object_)[key];
  if (!found.isString()) return;
  reading_.files.push_back(found.asString());
  if (reading_.allow_outside_paths) return;
  const std::filesystem::path normal = std::filesystem::path(found.asString()).lexically_normal();
  const bool leaves = normal.is_absolute() || (!normal.empty() && *normal.begin() == "..");
  if (leaves)
    complain(found, path_of(key),
             found_text(found) + " leads out of the scene's folder; name a file within it");
}

void JsonFields::vector(const char* key, Vec3& value, const Quantity& quantity) {
  Json::Value* found = find(key, quantity.required, "a list of 3, each " + expected_text("a number", quantity));
  std::vector<double> row;
  if (found == nullptr || !read_row(*found, path_of(key), 3, quantity, row)) return;
  value = Vec3(row[0], row[1], row[2]);
}

void JsonFields::integers(const char* key, std::array<std::int64_t, 3>& value, const Quantity& quantity) {
  const std::string expected = "a list of 3, each " + expected_text("a whole number", quantity);
  Json::Value* found = find(key, quantity.required, expected);
  if (found == nullptr) return;
  if (!found->isArray() || found->size() != 3) {
    mistaken(*found, path_of(key), expected);
    return;
  }
  for (Json::ArrayIndex i = 0; i < 3; ++i)
    read_integer((*found)[i], element(path_of(key), i), quantity, value[i]);
}

void JsonFields::rows(const char* key, std::vector<std::vector<double>>& value, int width,
                      const Quantity& quantity) {
  const std::string expected = "a list of lists of " + std::to_string(width) + " numbers";
  Json::Value* found = find(key, quantity.required, expected);
  if (found == nullptr) return;
  if (!found->isArray()) {
    mistaken(*found, path_of(key), expected);
    return;
  }
  value.clear();
  for (Json::ArrayIndex i = 0; i < found->size(); ++i) {
    std::vector<double> row;
    if (read_row((*found)[i], element(path_of(key), i), width, quantity, row)) value.push_back(row);
  }
}

bool JsonFields::read_name(const Json::Value& value, const std::string& path, std::span<const Choice> choices,
                           int& index) {
  const std::vector<std::string> names = names_of(choices);
  const std::string name = value.isString() ? value.asString() : "";
  const auto chosen = std::find(names.begin(), names.end(), name);
  if (!value.isString()) {
    mistaken(value, path, one_of(names));
  } else if (chosen == names.end()) {
    mistaken(value, path, one_of(names) + "; " + did_you_mean(name, names));
  } else {
    index = static_cast<int>(chosen - names.begin());
    return true;
  }
  return false;
}

void JsonFields::choice(const char* key, int& index, std::span<const Choice> choices, const char*) {
  const Json::Value* found = find(key, false, "");
  if (found != nullptr) read_name(*found, path_of(key), choices, index);
}

void JsonFields::choices(const char* key, std::vector<int>& chosen, std::span<const Choice> choices,
                         const char*) {
  const Json::Value* found = find(key, false, "");
  if (found == nullptr) return;
  if (!found->isArray()) {
    mistaken(*found, path_of(key), "a list of names, each " + one_of(names_of(choices)));
    return;
  }
  chosen.clear();
  for (Json::ArrayIndex i = 0; i < found->size(); ++i) {
    const Json::Value& value = (*found)[i];
    const std::string path = element(path_of(key), i);
    int index = 0;
    if (!read_name(value, path, choices, index)) continue;
    if (std::find(chosen.begin(), chosen.end(), index) != chosen.end()) {
      complain(value, path, found_text(value) + " is there twice; once is enough");
      continue;
    }
    chosen.push_back(index);
  }
}

void JsonFields::object(const char* key, bool& present, bool required, const char* meaning,
                        const std::function<void(Fields&)>& describe) {
  Json::Value* found = find(key, required, "an object: " + std::string(meaning));
  present = found != nullptr;
  if (present) read_object(*found, path_of(key), describe);
}

/// The tree then has what the words stand for.
void JsonFields::feature(const char* key, bool& present, const char* meaning,
                         const std::function<void(Fields&)>& describe) {
  const Json::Value& found = std::as_const(object_)[key];
  const std::string word = found.isString() ? found.asString() : "";
  if (word == "off") object_.removeMember(key);
  if (word == "on") {
    Json::Value all(Json::objectValue);
    object_[key].swapPayload(all);
  }
  object(key, present, false, meaning, describe);
}

void JsonFields::list(const char* key, bool required, const char* meaning,
                      const std::function<void(Fields&)>& item) {
  Json::Value* found = find(key, required, "a list: " + std::string(meaning));
  if (found == nullptr) return;
  if (!found->isArray() || (required && found->empty())) {
    mistaken(*found, path_of(key), required ? "a list of at least one object" : "a list of objects");
    return;
  }
  for (Json::ArrayIndex i = 0; i < found->size(); ++i) {
    read_object((*found)[i], element(path_of(key), i), item);
  }
}

void JsonFields::dictionary(const char* key, bool required, const char* meaning,
                            const std::function<void(const std::string&, Fields&)>& item) {
  Json::Value* found = find(key, required, "an object of named objects: " + std::string(meaning));
  if (found == nullptr) return;
  if (!found->isObject() || (required && found->empty())) {
    mistaken(*found, path_of(key),
             "an object of " + std::string(required ? "at least one " : "") + "named objects");
    return;
  }
  const std::string path = path_of(key);
  for (const std::string& name : found->getMemberNames()) {
    read_object((*found)[name], path + "." + name, [&](Fields& fields) { item(name, fields); });
  }
}

void JsonFields::alternatives(int& chosen, std::span<const Alternative> alternatives, const char*) {
  const std::vector<std::string> names = names_of(alternatives);
  Json::Value* found = find("type", true, one_of(names));
  any_key_ = true;
  if (found == nullptr) return;
  const auto named = std::find(names.begin(), names.end(), found->isString() ? found->asString() : "");
  if (named == names.end()) {
    const std::string hint = found->isString() ? "; " + did_you_mean(found->asString(), names) : "";
    mistaken(*found, path_of("type"), one_of(names) + hint);
    return;
  }
  any_key_ = false;
  type_ = *named;
  chosen = static_cast<int>(named - names.begin());
  alternatives[static_cast<std::size_t>(chosen)].describe(*this);
}

void JsonFields::parameters(const char* key, const char*) {
  find(key, false, "");
}

void JsonFields::check(bool holds, const char* key, const std::string& message) {
  if (holds) return;
  for (const JsonFields* fields = this; fields != nullptr; fields = fields->holder_) {
    if (fields->failed_) return;
  }
  const bool there = object_.isMember(key);
  reading_.complaints.add((there ? object_[key] : object_).getOffsetStart(), path_of(key), message);
}

}  // namespace repose
