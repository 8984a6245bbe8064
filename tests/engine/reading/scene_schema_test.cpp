// Repose: the schema and the reference say of every key what the reader does with it.
#include <gtest/gtest.h>
#include <json/json.h>

#include <memory>
#include <set>
#include <string>

#include "engine/effect/effects.h"
#include "engine/reading/reader.h"
#include "tests/engine/effect/key_names.h"

namespace repose {
namespace {

Json::Value parsed_schema() {
  const std::string text = scene_schema();
  Json::CharReaderBuilder builder;
  Json::CharReaderBuilder::strictMode(&builder.settings_);
  const std::unique_ptr<Json::CharReader> reader(builder.newCharReader());
  Json::Value schema;
  std::string errors;
  EXPECT_TRUE(reader->parse(text.data(), text.data() + text.size(), &schema, &errors)) << errors;
  return schema;
}

const Json::Value& property(const Json::Value& object, const std::string& key) {
  EXPECT_TRUE(object["properties"].isMember(key)) << key;
  return object["properties"][key];
}

/// The form of a oneOf whose "type" is `name`.
const Json::Value& form(const Json::Value& object, const std::string& name) {
  for (const Json::Value& candidate : object["oneOf"]) {
    if (candidate["properties"]["type"]["const"] == name) return candidate;
  }
  ADD_FAILURE() << "no form " << name;
  return object;
}

/// All keys that a schema names, at any depth.
void collect_keys(const Json::Value& schema, std::set<std::string>& keys) {
  if (schema.isObject() && schema["properties"].isObject()) {
    for (const std::string& key : schema["properties"].getMemberNames()) keys.insert(key);
  }
  for (const Json::Value& child : schema) collect_keys(child, keys);
}

TEST(SceneSchema, Root_ListsEveryKeyAndNoOther) {
  const Json::Value schema = parsed_schema();
  EXPECT_EQ(schema["$schema"].asString(), "https://json-schema.org/draft/2020-12/schema");
  std::set<std::string> keys{"$schema", "bodies",     "camera", "grid",  "implicit", "materials", "name",
                             "output",  "parameters", "repose", "study", "time",     "up"};
  Effects effects;
  for_each_effect(effects, [&](auto& effect) {
    KeyNames names;
    effect.declare(names, {});
    keys.insert(names.names.begin(), names.names.end());
  });
  const auto known = schema["properties"].getMemberNames();
  EXPECT_EQ((std::set<std::string>(known.begin(), known.end())), keys);
  EXPECT_FALSE(schema["additionalProperties"].asBool());
  std::set<std::string> required;
  for (const Json::Value& key : schema["required"]) required.insert(key.asString());
  EXPECT_EQ(required, (std::set<std::string>{"repose", "name", "grid", "materials"}));
}

TEST(SceneSchema, Defaults_AreThoseOfTheStructs) {
  const Json::Value schema = parsed_schema();
  const Json::Value& time = property(schema, "time");
  const TimeDescription standard;
  EXPECT_EQ(property(time, "frames")["default"].asInt64(), standard.frames);
  EXPECT_EQ(property(time, "frames_per_second")["default"].asDouble(), standard.frames_per_second);
  EXPECT_EQ(property(time, "max_step")["default"].asDouble(), standard.max_step);
  EXPECT_EQ(property(time, "cfl")["default"].asDouble(), standard.cfl);
  EXPECT_EQ(property(time, "sound")["default"].asDouble(), standard.sound);
  EXPECT_EQ(property(time, "isolated")["default"].asDouble(), standard.isolated);
  EXPECT_EQ(property(time, "strain")["default"].asDouble(), standard.strain);

  const Json::Value& body = property(schema, "bodies")["items"];
  EXPECT_EQ(property(body, "particles_per_cell")["default"].asInt64(), BodyDescription{}.particles_per_cell);
  EXPECT_EQ(property(body, "sampling")["default"].asString(), "jittered");
  const Json::Value& collider = property(schema, "colliders")["items"];
  EXPECT_EQ(property(collider, "contact")["default"].asString(), "separating");
  EXPECT_EQ(property(property(schema, "output"), "vdb")["default"].asBool(), OutputDescription{}.vdb);
  const Json::Value& gravity = property(property(schema, "gravity"), "acceleration")["default"];
  EXPECT_EQ(gravity[1].asDouble(), Gravity{}.acceleration[1]);

  const Json::Value& material = property(schema, "materials")["additionalProperties"];
  const DruckerPragerParameters sand;
  const Json::Value& sand_form = form(material, "drucker_prager");
  EXPECT_EQ(property(sand_form, "density")["default"].asDouble(), sand.elasticity.density);
  EXPECT_EQ(property(sand_form, "youngs_modulus")["default"].asDouble(), sand.elasticity.youngs_modulus);
  EXPECT_EQ(property(sand_form, "friction_angle")["default"].asDouble(), sand.friction_angle);
  EXPECT_EQ(property(form(material, "elastic"), "youngs_modulus")["default"].asDouble(),
            HenckyParameters{}.elasticity.youngs_modulus);
}

TEST(SceneSchema, Number_HasRangeUnitAndExpression) {
  const Json::Value schema = parsed_schema();
  const Json::Value& spacing = property(property(schema, "grid"), "spacing");
  EXPECT_EQ(spacing["exclusiveMinimum"].asDouble(), 0.0);
  EXPECT_EQ(spacing["pattern"].asString(), "^=");
  EXPECT_EQ(spacing["type"][0].asString(), "number");
  EXPECT_EQ(spacing["type"][1].asString(), "string");
  EXPECT_TRUE(spacing["description"].asString().ends_with(", in m"));
  EXPECT_FALSE(spacing.isMember("default"));  // required
}

TEST(SceneSchema, Forms_AreClosedAndShareCommonKeys) {
  const Json::Value schema = parsed_schema();
  const Json::Value& shape = property(property(schema, "bodies")["items"], "shape");
  EXPECT_EQ(shape["oneOf"].size(), 6u);
  const Json::Value& sphere = form(shape, "sphere");
  EXPECT_TRUE(sphere["properties"].isMember("radius"));
  EXPECT_TRUE(sphere["properties"].isMember("translation"));
  EXPECT_FALSE(sphere["properties"].isMember("upper"));
  EXPECT_FALSE(sphere["additionalProperties"].asBool());
  EXPECT_TRUE(form(shape, "box")["properties"].isMember("upper"));
  const Json::Value& emitter = property(schema, "emitters")["items"];
  EXPECT_EQ(emitter["oneOf"].size(), 4u);
  EXPECT_TRUE(form(emitter, "disc")["properties"].isMember("speed"));
  EXPECT_TRUE(form(emitter, "volume")["properties"].isMember("rate"));
  EXPECT_TRUE(form(emitter, "volume")["properties"].isMember("start"));
  EXPECT_FALSE(form(emitter, "host")["properties"].isMember("start"));
  EXPECT_TRUE(form(emitter, "host")["properties"].isMember("particles_per_cell"));
}

TEST(SceneSchema, ListOfNames_IsClosedAndHasNoneTwice) {
  const Json::Value schema = parsed_schema();
  const Json::Value& attributes = property(property(schema, "output"), "attributes");
  EXPECT_EQ(attributes["type"].asString(), "array");
  EXPECT_EQ(attributes["items"]["enum"].size(), 11u);
  EXPECT_TRUE(attributes["uniqueItems"].asBool());
  EXPECT_TRUE(attributes["default"].isArray() && attributes["default"].empty());
  EXPECT_NE(scene_reference().find("| `attributes` | | [] | list of any of `stress`: Cauchy stress"),
            std::string::npos);
}

TEST(SceneReference, EveryKeyOfTheSchema_HasARow) {
  std::set<std::string> keys;
  collect_keys(parsed_schema(), keys);
  EXPECT_GT(keys.size(), 50u);
  const std::string reference = scene_reference();
  for (const std::string& key : keys) {
    EXPECT_NE(reference.find("| `" + key + "` |"), std::string::npos) << key;
  }
}

TEST(SceneReference, Row_KeyUnitDefaultRangeMeaning) {
  const std::string reference = scene_reference();
  EXPECT_NE(reference.find("## `materials.NAME`"), std::string::npos);
  EXPECT_NE(reference.find("| `spacing` | m | required | greater than 0 | distance between nodes, dx |"),
            std::string::npos);
  EXPECT_NE(reference.find(
                "| `friction_angle` | degrees | 35 | at least 0 and less than 90 | `drucker_prager`: angle"),
            std::string::npos);
}

}  // namespace
}  // namespace repose
