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

}  // namespace

void apply_quality(Quality quality, Json::Value& root) {
  if (quality == Quality::kStandard) return;
  const bool spaced = root.isMember("grid") && root["grid"].isObject() && root["grid"].isMember("spacing");
  if (spaced) multiply(root["grid"]["spacing"], quality == Quality::kDraft ? 2.0 : 0.5);
}

}  // namespace repose
