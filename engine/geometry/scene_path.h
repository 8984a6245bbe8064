// Repose: where a file lies that a scene names. A scene from elsewhere may name only files beside it.
#pragma once

#include <string>

#include "engine/base/result.h"

namespace repose {

/// The full path of `file` seen from `folder`; `what` is what messages call it, such as "mesh file". Refuses
/// (65) absolute paths and paths that leave the folder, by ".." or through a link, unless `allow_outside`; (66)
/// what is not a regular file.
Result<std::string> resolve_path(const std::string& folder, const std::string& file, const std::string& what,
                                 bool allow_outside);

}  // namespace repose
