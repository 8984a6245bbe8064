// Repose: the visitor that writes the JSON Schema of scene files. An object whose "type" chooses among forms
// becomes a oneOf of closed objects, each with the keys that all forms share: an editor that knows only older
// drafts understands these too, which it would not with "unevaluatedProperties".
#include <json/value.h>

#include <cmath>
#include <vector>

#include "engine/base/wording.h"
#include "engine/reading/json_text.h"
#include "engine/reading/reader.h"
#include "engine/study/study.h"

namespace repose {
namespace {

constexpr unsigned kDigits = 15;  // of defaults: as they were written

/// "type" of a value that may also be an expression. "pattern" binds only text and "minimum" only numbers.
void allow_expression(Json::Value& schema, const char* type) {
  schema["type"].append(type);
  schema["type"].append("string");
  schema["pattern"] = "^=";
}

Json::Value number_schema(const char* type, const Quantity& quantity) {
  Json::Value schema;
  allow_expression(schema, type);
  if (std::isfinite(quantity.low)) schema[quantity.low_open ? "exclusiveMinimum" : "minimum"] = quantity.low;
  if (std::isfinite(quantity.high)) schema[quantity.high_open ? "exclusiveMaximum" : "maximum"] = quantity.high;
  return schema;
}

Json::Value row_schema(Json::Value item, int width) {
  Json::Value schema;
  schema["type"] = "array";
  schema["items"] = std::move(item);
  schema["minItems"] = width;
  schema["maxItems"] = width;
  return schema;
}

std::string with_unit(const Quantity& quantity) {
  const std::string unit = quantity.unit;
  return std::string(quantity.meaning) + (unit.empty() ? "" : ", in " + unit);
}

class SchemaFields final : public Fields {
 public:
  Json::Value schema() const {
    if (forms_.empty()) return properties_.closed();
    Json::Value schema;
    schema["type"] = "object";
    for (const Properties& form : forms_) schema["oneOf"].append(form.joined(properties_).closed());
    return schema;
  }

  void number(const char* key, double& value, const Quantity& quantity) override {
    // What stands for "none" is no number of JSON.
    const Json::Value standard = std::isfinite(value) ? Json::Value(value) : Json::Value();
    add(key, number_schema("number", quantity), with_unit(quantity), quantity.required, standard);
  }

  void integer(const char* key, std::int64_t& value, const Quantity& quantity) override {
    const Json::Value standard(static_cast<Json::Int64>(value));
    add(key, number_schema("integer", quantity), with_unit(quantity), quantity.required, standard);
  }

  void flag(const char* key, bool& value, const char* meaning) override {
    Json::Value schema;
    schema["type"] = "boolean";
    add(key, schema, meaning, false, value);
  }

  void text(const char* key, std::string& value, const char* meaning, bool required) override {
    Json::Value schema;
    schema["type"] = "string";
    if (required) schema["minLength"] = 1;
    add(key, schema, meaning, required, value);
  }

  void vector(const char* key, Vec3& value, const Quantity& quantity) override {
    Json::Value standard;
    for (const double x : value) standard.append(x);
    add(key, row_schema(number_schema("number", quantity), 3), with_unit(quantity), quantity.required,
        standard);
  }

  void integers(const char* key, std::array<std::int64_t, 3>& value, const Quantity& quantity) override {
    Json::Value standard;
    for (const std::int64_t x : value) standard.append(static_cast<Json::Int64>(x));
    add(key, row_schema(number_schema("integer", quantity), 3), with_unit(quantity), quantity.required,
        standard);
  }

  void rows(const char* key, std::vector<std::vector<double>>&, int width, const Quantity& quantity) override {
    Json::Value schema;
    schema["type"] = "array";
    schema["items"] = row_schema(number_schema("number", quantity), width);
    add(key, schema, with_unit(quantity), quantity.required, Json::Value(Json::arrayValue));
  }

  void choice(const char* key, int& index, std::span<const Choice> choices, const char* meaning) override {
    Json::Value schema;
    std::string words = meaning;
    for (const Choice& choice : choices) {
      schema["enum"].append(choice.name);
      words += std::string("\n- ") + choice.name + ": " + choice.meaning;
    }
    add(key, schema, words, false, choices[static_cast<std::size_t>(index)].name);
  }

  void choices(const char* key, std::vector<int>& chosen, std::span<const Choice> choices,
               const char* meaning) override {
    Json::Value schema, standard(Json::arrayValue);
    schema["type"] = "array";
    schema["uniqueItems"] = true;
    std::string words = meaning;
    for (const Choice& choice : choices) {
      schema["items"]["enum"].append(choice.name);
      words += std::string("\n- ") + choice.name + ": " + choice.meaning;
    }
    for (const int index : chosen) standard.append(choices[static_cast<std::size_t>(index)].name);
    add(key, schema, words, false, standard);
  }

  void object(const char* key, bool&, bool required, const char* meaning,
              const std::function<void(Fields&)>& describe) override {
    SchemaFields fields;
    describe(fields);
    add(key, fields.schema(), meaning, required, Json::Value());
  }

  void list(const char* key, bool required, const char* meaning,
            const std::function<void(Fields&)>& item) override {
    SchemaFields fields;
    item(fields);
    Json::Value schema;
    schema["type"] = "array";
    schema["items"] = fields.schema();
    if (required) schema["minItems"] = 1;
    add(key, schema, meaning, required, Json::Value());
  }

  void dictionary(const char* key, bool required, const char* meaning,
                  const std::function<void(const std::string&, Fields&)>& item) override {
    SchemaFields fields;
    item("NAME", fields);
    Json::Value schema;
    schema["type"] = "object";
    schema["additionalProperties"] = fields.schema();
    if (required) schema["minProperties"] = 1;
    add(key, schema, meaning, required, Json::Value());
  }

  void alternatives(int&, std::span<const Alternative> alternatives, const char* meaning) override {
    for (const Alternative& alternative : alternatives) {
      Json::Value type;
      type["const"] = alternative.name;
      SchemaFields fields;
      fields.add("type", type, std::string(meaning) + ": " + alternative.meaning, true, Json::Value());
      alternative.describe(fields);
      forms_.push_back(fields.properties_);
    }
  }

  void parameters(const char* key, const char* meaning) override {
    Json::Value schema;
    schema["type"] = "object";
    allow_expression(schema["additionalProperties"], "number");
    add(key, schema, meaning, false, Json::Value());
  }

  void check(bool, const char*, const std::string&) override {}  // a schema cannot state it

 private:
  struct Properties {
    Json::Value by_key{Json::objectValue};
    Json::Value required{Json::arrayValue};

    Properties joined(const Properties& other) const {
      Properties both = *this;
      for (const std::string& key : other.by_key.getMemberNames()) both.by_key[key] = other.by_key[key];
      for (const Json::Value& key : other.required) both.required.append(key);
      return both;
    }

    Json::Value closed() const {
      Json::Value schema;
      schema["type"] = "object";
      schema["additionalProperties"] = false;
      schema["properties"] = by_key;
      if (!required.empty()) schema["required"] = required;
      return schema;
    }
  };

  /// A null `standard` stands for a key without default.
  void add(const char* key, Json::Value schema, const std::string& meaning, bool required,
           const Json::Value& standard) {
    schema["description"] = meaning;
    if (!required && !standard.isNull()) schema["default"] = standard;
    if (required) properties_.required.append(key);
    properties_.by_key[key] = std::move(schema);
  }

  Properties properties_;
  std::vector<Properties> forms_;
};

}  // namespace

std::string scene_schema() {
  Scene scene;
  SchemaFields fields;
  describe(fields, scene);
  StudyDescription study;
  describe(fields, study);
  Json::Value schema = fields.schema();
  schema["$schema"] = "https://json-schema.org/draft/2020-12/schema";
  schema["title"] = "A scene of Repose";
  return compact_json(schema, kDigits) + "\n";
}

}  // namespace repose
