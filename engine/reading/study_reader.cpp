#include "engine/reading/study_reader.h"

#include "engine/base/wording.h"
#include "engine/reading/json_fields.h"
#include "engine/reading/json_text.h"
#include "engine/reading/overrides.h"

namespace repose {

/// The canonical text was written from a tree that has been read before, so there is nothing to complain of.
StudyDescription study_of(const Scene& scene) {
  const SourceText source(scene.name, scene.canonical);
  Complaints complaints;
  Json::Value root = parse_json(source, complaints);
  StudyDescription study;
  if (!root.isObject()) return study;
  Expressions expressions;
  Reading reading{source, expressions, complaints, true};
  JsonFields fields(root, "", reading);
  describe(fields, study);
  return study;
}

std::string value_at(const Scene& scene, const std::string& key) {
  Complaints complaints;
  Json::Value root = parse_json(SourceText(scene.name, scene.canonical), complaints);
  const Json::Value* const value = find_value(root, key);
  if (value == nullptr) return "";
  if (value->isString()) return value->asString();
  return value->isDouble() ? number_text(value->asDouble()) : compact_json(*value);
}

}  // namespace repose
