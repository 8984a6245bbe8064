// Repose: scene files: JSON with comments. Every error names file, line, column, key path and what would be
// right; all errors of a file are reported together, one line each.
#pragma once

#include <string>
#include <vector>

#include "engine/base/result.h"
#include "engine/scene/scene.h"

namespace repose {

/// What "--quality" can be; apply_quality says what each does.
enum class Quality { kDraft, kStandard, kReference };
inline constexpr const char* kQualityNames[] = {"draft", "standard", "reference"};

struct ReadOptions {
  /// "a.b=value" and "a[0].b=value", applied before the scene is read; value is JSON, else taken as text.
  std::vector<std::string> overrides;
  bool allow_outside_paths = false;      ///< allow mesh paths that leave the scene's folder
  Quality quality = Quality::kStandard;  ///< applied before the overrides, so that these win
};

/// Reads a scene. A number may be written as text that begins with "=", an expression over the scene's
/// "parameters" (an object of numbers): "= 2 * radius". Errors: 66 no such file, 65 all else.
Result<Scene> read_scene(const std::string& path, const ReadOptions& options = {});

/// The same from text; `name` stands in for the file in errors.
Result<Scene> read_scene_text(const std::string& text, const std::string& name, const std::string& folder,
                              const ReadOptions& options = {});

/// The JSON Schema (draft 2020-12) of scene files, from the same declarations that read them.
std::string scene_schema();

/// The reference of every scene key as Markdown: key, unit, default, range, meaning.
std::string scene_reference();

}  // namespace repose
