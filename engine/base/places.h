// Repose: where the keys of a scene stand in its file, for errors that are found after reading.
#pragma once

#include <map>
#include <string>

namespace repose {

struct Places {
  std::map<std::string, std::string> of_key;  ///< "file:line:col"; empty where a host filled the scene

  /// "file:line:col: grid.spacing", or the key alone where its place is not known. Elements of lists go by
  /// name: "bodies.box.shape".
  std::string where(const std::string& key) const {
    const auto place = of_key.find(key);
    return place == of_key.end() ? key : place->second + ": " + key;
  }
};

}  // namespace repose
