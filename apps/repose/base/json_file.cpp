#include "apps/repose/base/json_file.h"

#include <json/reader.h>

#include <exception>
#include <fstream>

#include "engine/base/caught.h"
#include "engine/base/input_file.h"

namespace repose {

Result<Json::Value> read_json_file(const std::string& path) {
  std::ifstream file = open_input(path);
  if (!file) return Error{ErrorKind::kNoInput, "cannot be read", path};
  Json::CharReaderBuilder builder;
  builder["collectComments"] = false;
  builder["failIfExtra"] = true;
  builder["stackLimit"] = 64;  // what lies deeper makes the library throw
  Json::Value json;
  std::string message;
  try {
    if (Json::parseFromStream(builder, file, &json, &message)) return json;
  } catch (const std::exception& failure) {
    if (is_of_memory(failure)) throw std::bad_alloc();
    message = failure.what();
  }
  message = message.substr(0, message.find_last_not_of(" \n") + 1);
  return Error{ErrorKind::kIo, "is not JSON: " + message, path};
}

}  // namespace repose
