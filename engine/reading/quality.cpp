#include "engine/reading/quality.h"

#include "engine/base/wording.h"
#include "engine/reading/expressions.h"

namespace repose {
namespace {

/// Keeps the value's place in the file, so that messages still point at what the user wrote.
void multiply(Json::Value& value, double factor) {
  Json::Value product;
  if (value.isNumeric()) {
    product = value.asDouble() * factor;
  } else if (value.isString() && Expressions::is_expression(value.asString())) {
    product = "= " + number_text(factor) + " * (" + value.asString().substr(1) + ")";
  } else {
    return;
  }
  value.swapPayload(product);
}

void halve_limits(Json::Value& time, std::ptrdiff_t offset) {
  const TimeDescription defaults;
  const std::pair<const char*, double> limits[] = {{"cfl", defaults.cfl},
                                                   {"sound", defaults.sound},
                                                   {"isolated", defaults.isolated},
                                                   {"strain", defaults.strain}};
  for (const auto& [key, standard] : limits) {
    if (!time.isMember(key)) {
      time[key] = standard;
      time[key].setOffsetStart(offset);
      time[key].setOffsetLimit(offset);
    }
    multiply(time[key], 0.5);
  }
}

}  // namespace

void apply_quality(Quality quality, Json::Value& root, SourceText& source) {
  if (quality == Quality::kStandard) return;
  if (quality == Quality::kDraft) {
    const bool spaced = root.isMember("grid") && root["grid"].isObject() && root["grid"].isMember("spacing");
    if (spaced) multiply(root["grid"]["spacing"], 2.0);
    return;
  }
  const std::ptrdiff_t offset = source.add_words("--quality reference");
  if (!root.isMember("time")) {
    Json::Value& time = root["time"] = Json::Value(Json::objectValue);
    time.setOffsetStart(offset);
    time.setOffsetLimit(offset);
  }
  if (root["time"].isObject()) halve_limits(root["time"], offset);
}

}  // namespace repose
