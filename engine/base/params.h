// Repose: the one declaration of every scene key. A struct of parameters has a function describe(fields)
// that names its members; three visitors run it: the reader (JSON -> struct), the schema writer and the
// parameter reference. So a key, its unit, its range and its default are written once, beside the member.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "engine/base/vector.h"
#include "kernels/base/quantity.h"

namespace repose {

class Fields;

/// One form of an object whose "type" key selects among several.
struct Alternative {
  const char* name;
  const char* meaning;
  std::function<void(Fields&)> describe;
};

/// Visitor of scene keys. The value that a member holds when it is described is its default.
class Fields {
 public:
  virtual ~Fields() = default;

  virtual void number(const char* key, double& value, const Quantity& quantity) = 0;
  virtual void integer(const char* key, std::int64_t& value, const Quantity& quantity) = 0;
  virtual void flag(const char* key, bool& value, const char* meaning) = 0;
  virtual void text(const char* key, std::string& value, const char* meaning, bool required = false) = 0;
  /// A path, relative to the scene's folder, which it may not leave unless whoever reads the scene allows it.
  virtual void file(const char* key, std::string& value, const char* meaning, bool required = false) {
    text(key, value, meaning, required);
  }
  virtual void vector(const char* key, Vec3& value, const Quantity& quantity) = 0;
  virtual void integers(const char* key, std::array<std::int64_t, 3>& value, const Quantity& quantity) = 0;

  /// A list of fixed-length rows of numbers, such as the (radius, height) pairs of a profile.
  virtual void rows(const char* key, std::vector<std::vector<double>>& value, int width,
                    const Quantity& quantity) = 0;

  /// One of several names; `index` is the position in `choices`.
  virtual void choice(const char* key, int& index, std::span<const Choice> choices, const char* meaning) = 0;

  /// Any of several names, each at most once; `chosen` has their positions in `choices`, in the order given.
  virtual void choices(const char* key, std::vector<int>& chosen, std::span<const Choice> choices,
                       const char* meaning) = 0;

  /// A nested object. `present` tells, and is set to, whether the key is there; a required one must be.
  virtual void object(const char* key, bool& present, bool required, const char* meaning,
                      const std::function<void(Fields&)>& describe) = 0;
  /// An object that need not be there, and without which nothing of the kind happens; "off" says the same.
  virtual void feature(const char* key, bool& present, const char* meaning,
                       const std::function<void(Fields&)>& describe) {
    object(key, present, false, meaning, describe);
  }

  /// A list of objects; `item` is called once per element and appends what it reads. A required list holds
  /// at least one element; so does a required dictionary.
  virtual void list(const char* key, bool required, const char* meaning,
                    const std::function<void(Fields&)>& item) = 0;

  /// An object of named objects; `item` is called once per entry.
  virtual void dictionary(const char* key, bool required, const char* meaning,
                          const std::function<void(const std::string& name, Fields&)>& item) = 0;

  /// The object being described has a key "type" that chooses one of `alternatives`, whose further keys
  /// then belong to this same object. `chosen` is the position of the choice.
  virtual void alternatives(int& chosen, std::span<const Alternative> alternatives, const char* meaning) = 0;

  /// An object of freely named numbers, which expressions elsewhere in the file may use. It has no member
  /// to be read into: the reader evaluates it before anything else is described.
  virtual void parameters(const char* key, const char* meaning) = 0;

  /// A condition across several keys of the object being described, named at `key` when it fails. It is left
  /// out where a value of this object, or of one that holds it, could not be read: its member is no answer.
  virtual void check(bool holds, const char* key, const std::string& message) = 0;

  /// A choice held by an enum whose values count from 0 in the order of `choices`.
  template <class Enum>
  requires std::is_enum_v<Enum>
  void choice(const char* key, Enum& value, std::span<const Choice> choices, const char* meaning) {
    int index = static_cast<int>(value);
    choice(key, index, choices, meaning);
    value = static_cast<Enum>(index);
  }

  template <class Enum>
  requires std::is_enum_v<Enum>
  void choices(const char* key, std::vector<Enum>& values, std::span<const Choice> choices,
               const char* meaning) {
    std::vector<int> chosen;
    for (const Enum value : values) chosen.push_back(static_cast<int>(value));
    this->choices(key, chosen, choices, meaning);
    values.clear();
    for (const int index : chosen) values.push_back(static_cast<Enum>(index));
  }
};

}  // namespace repose
