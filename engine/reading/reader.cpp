// Repose: from a scene file to a Scene: text, tree, quality, overrides, parameters, then the keys. Complaints
// of all these are gathered; only a file that is not JSON at all ends it early.
#include "engine/reading/reader.h"

#include <filesystem>
#include <fstream>

#include "engine/base/input_file.h"
#include "engine/base/wording.h"
#include "engine/reading/complaints.h"
#include "engine/reading/identity.h"
#include "engine/reading/json_fields.h"
#include "engine/reading/json_text.h"
#include "engine/reading/overrides.h"
#include "engine/reading/parameters.h"
#include "engine/reading/quality.h"
#include "engine/study/study.h"

namespace repose {
namespace {

constexpr std::size_t kMostBytes = std::size_t{16} << 20;

Error too_large(const std::string& name) {
  return {ErrorKind::kBadScene, "larger than 16 MB; put geometry into mesh files", name};
}

Result<std::string> read_text(const std::string& path) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored)) {
    const bool exists = std::filesystem::exists(path, ignored);
    return Error{ErrorKind::kNoInput,
                 exists ? "not a file; give a scene file" : "no such file; give a scene file", path};
  }
  std::ifstream file = open_input(path);
  if (!file) return Error{ErrorKind::kNoInput, "cannot be opened; it must be readable", path};
  // One byte more than allowed tells a file that is too large from one that just fits.
  std::string text(kMostBytes + 1, '\0');
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (file.bad()) return Error{ErrorKind::kNoInput, "cannot be read to its end", path};
  text.resize(static_cast<std::size_t>(file.gcount()));
  return text;
}

/// Notes where the values of objects stand, for errors that only the compiler can find.
void find_places(const Json::Value& value, const std::string& path, const SourceText& source,
                 std::map<std::string, std::string>& places) {
  if (!path.empty()) places[path] = source.place(value.getOffsetStart());
  const std::string start = path.empty() ? "" : path + ".";
  if (value.isObject()) {
    for (const std::string& name : value.getMemberNames())
      find_places(value[name], start + name, source, places);
  } else if (value.isArray()) {
    for (const Json::Value& element : value) {
      const bool named = element.isObject() && element["name"].isString();
      if (named) find_places(element, start + element["name"].asString(), source, places);
    }
  }
}

}  // namespace

Result<Scene> read_scene_text(const std::string& text, const std::string& name, const std::string& folder,
                              const ReadOptions& options) {
  if (text.size() > kMostBytes) return too_large(name);
  SourceText source(name, text);
  Complaints complaints;
  Json::Value root = parse_json(source, complaints);
  if (!complaints.empty()) return complaints.error(source);
  if (!root.isObject()) {
    complaints.add(root.getOffsetStart(), "", "found " + found_text(root) + "; a scene is an object {...}");
    return complaints.error(source);
  }

  Expressions expressions;
  apply_quality(options.quality, root);
  apply_overrides(options.overrides, root, source, complaints);
  evaluate_parameters(root, expressions, complaints);
  Scene scene;
  Reading reading{source, expressions, complaints, options.allow_outside_paths};
  JsonFields fields(root, "", reading);
  describe(fields, scene);
  StudyDescription study;  // only to find what is wrong with it; study_of reads it where it is wanted
  describe(fields, study);
  fields.finish();
  if (!complaints.empty()) return complaints.error(source);

  find_places(root, "", source, scene.places.of_key);
  scene.folder = folder;
  scene.files = std::move(reading.files);
  scene.identity = identity_text(root);
  scene.canonical = compact_json(root);
  return scene;
}

Result<Scene> read_scene(const std::string& path, const ReadOptions& options) {
  const Result<std::string> text = read_text(path);
  if (!text) return text.error();
  const std::string folder = std::filesystem::path(path).parent_path().string();
  return read_scene_text(*text, path, folder.empty() ? "." : folder, options);
}

}  // namespace repose
