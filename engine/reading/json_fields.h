// Repose: the visitor that reads JSON into members. It writes evaluated expressions back into the tree, so
// that the tree read is the canonical form of the scene.
#pragma once

#include <json/value.h>

#include <string>
#include <vector>

#include "engine/base/params.h"
#include "engine/reading/complaints.h"
#include "engine/reading/expressions.h"
#include "engine/reading/source_text.h"

namespace repose {

/// What all objects of a file share while it is read.
struct Reading {
  const SourceText& source;
  Expressions& expressions;
  Complaints& complaints;
  bool allow_outside_paths = false;
  std::vector<std::string> files = {};  ///< that the scene names, as it has them
};

/// Reads one JSON object. Members whose key is missing or wrong keep the value that they had.
class JsonFields final : public Fields {
 public:
  /// `path` is the key path of `object`, `holder` the object that it lies in.
  JsonFields(Json::Value& object, std::string path, Reading& reading, const JsonFields* holder = nullptr);

  /// Complains of required keys that are missing and of keys that were not described. Call it last.
  void finish();

  void number(const char* key, double& value, const Quantity& quantity) override;
  void integer(const char* key, std::int64_t& value, const Quantity& quantity) override;
  void flag(const char* key, bool& value, const char* meaning) override;
  void text(const char* key, std::string& value, const char* meaning, bool required) override;
  void file(const char* key, std::string& value, const char* meaning, bool required) override;
  void vector(const char* key, Vec3& value, const Quantity& quantity) override;
  void integers(const char* key, std::array<std::int64_t, 3>& value, const Quantity& quantity) override;
  void rows(const char* key, std::vector<std::vector<double>>& value, int width,
            const Quantity& quantity) override;
  void choice(const char* key, int& index, std::span<const Choice> choices, const char* meaning) override;
  void choices(const char* key, std::vector<int>& chosen, std::span<const Choice> choices,
               const char* meaning) override;
  void object(const char* key, bool& present, bool required, const char* meaning,
              const std::function<void(Fields&)>& describe) override;
  void feature(const char* key, bool& present, const char* meaning,
               const std::function<void(Fields&)>& describe) override;
  void list(const char* key, bool required, const char* meaning,
            const std::function<void(Fields&)>& item) override;
  void dictionary(const char* key, bool required, const char* meaning,
                  const std::function<void(const std::string&, Fields&)>& item) override;
  void alternatives(int& chosen, std::span<const Alternative> alternatives, const char* meaning) override;
  void parameters(const char* key, const char* meaning) override;
  void check(bool holds, const char* key, const std::string& message) override;

 private:
  struct Missing {
    std::string key;
    std::string expected;
  };

  std::string path_of(const std::string& key) const;
  Json::Value* find(const char* key, bool required, const std::string& expected);
  void complain(const Json::Value& value, const std::string& path, const std::string& message);
  std::string meant_by(const std::string& key) const;
  void complain_of_unknown(const std::string& key);
  std::string hint_of_expression(const Json::Value& value);
  std::string hint_of_keys(const std::string& path, const std::function<void(Fields&)>& describe);
  void mistaken(const Json::Value& value, const std::string& path, const std::string& expected);
  bool evaluate(Json::Value& value, const std::string& path);
  bool read_number(Json::Value& value, const std::string& path, const Quantity& quantity, double& number);
  bool read_integer(Json::Value& value, const std::string& path, const Quantity& quantity,
                    std::int64_t& number);
  bool read_row(Json::Value& value, const std::string& path, int width, const Quantity& quantity,
                std::vector<double>& row);
  bool read_name(const Json::Value& value, const std::string& path, std::span<const Choice> choices,
                 int& index);
  void read_object(Json::Value& value, const std::string& path, const std::function<void(Fields&)>& describe);

  Json::Value& object_;
  std::string path_;
  Reading& reading_;
  const JsonFields* holder_;
  std::vector<std::string> known_;
  std::vector<Missing> missing_;
  std::string type_;      // the alternative that was chosen
  bool any_key_ = false;  // the alternative is unknown, so any further key may be right
  bool failed_ = false;   // a value of this object could not be read
};

}  // namespace repose
