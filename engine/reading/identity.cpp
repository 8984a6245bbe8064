#include "engine/reading/identity.h"

#include <set>

#include "engine/base/wording.h"
#include "engine/reading/json_text.h"

namespace repose {
namespace {

void strip(Json::Value& root) {
  Json::Value none(Json::objectValue);
  for (Json::Value& material : root.isMember("materials") ? root["materials"] : none) {
    if (!material.isObject()) continue;  // of these, only attributes of points know
    material.removeMember("grain_diameter");
    material.removeMember("grain_density");
  }
  root.removeMember("output");
  root.removeMember("camera");
  root.removeMember("study");
  if (!root["time"].isObject()) {
    root.removeMember("time");  // asking for it made it
    return;
  }
  root["time"].removeMember("frames");
  root["time"].removeMember("energy_alarm");  // it changes no state
  if (root["time"].empty()) root.removeMember("time");
}

std::string value_text(const Json::Value& value) {
  return value.isDouble() ? number_text(value.asDouble()) : compact_json(value);
}

std::string element_path(const std::string& path, const Json::Value& a, const Json::Value& b,
                         Json::ArrayIndex i) {
  const bool named = a.isObject() && b.isObject() && a["name"].isString() && a["name"] == b["name"];
  return path + (named ? "." + a["name"].asString() : "[" + std::to_string(i) + "]");
}

std::string difference(const Json::Value& before, const Json::Value& now, const std::string& path) {
  if (compact_json(before) == compact_json(now)) return "";
  if (before.isArray() && now.isArray() && before.size() == now.size()) {
    for (Json::ArrayIndex i = 0; i < before.size(); ++i) {
      const std::string found = difference(before[i], now[i], element_path(path, before[i], now[i], i));
      if (!found.empty()) return found;
    }
  }
  if (!before.isObject() || !now.isObject()) {
    return path + " was " + value_text(before) + " and is " + value_text(now) + " now";
  }
  std::set<std::string> keys;
  for (const Json::Value* object : {&before, &now}) {
    for (const std::string& key : object->getMemberNames()) keys.insert(key);
  }
  for (const std::string& key : keys) {
    const std::string at = (path.empty() ? "" : path + ".") + key;
    if (!before.isMember(key)) return at + " was not there and is " + value_text(now[key]) + " now";
    if (!now.isMember(key)) return at + " was " + value_text(before[key]) + " and is not there now";
    const std::string found = difference(before[key], now[key], at);
    if (!found.empty()) return found;
  }
  return "";
}

}  // namespace

std::string identity_text(Json::Value root) {
  strip(root);
  return compact_json(root);
}

std::string first_difference(const std::string& before, const std::string& now) {
  Complaints unread;
  Json::Value a = parse_json(SourceText("", before), unread);
  Json::Value b = parse_json(SourceText("", now), unread);
  if (!unread.empty() || !a.isObject() || !b.isObject()) return "";
  strip(a);
  strip(b);
  const Json::Value &parameters = std::as_const(a)["parameters"], &others = std::as_const(b)["parameters"];
  const std::string found = difference(parameters, others, "parameters");
  return found.empty() ? difference(a, b, "") : found;
}

}  // namespace repose
