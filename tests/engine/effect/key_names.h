// Repose tests: which keys a function `describe` or `declare` names, without a scene.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "engine/base/params.h"

namespace repose {

/// The names of the keys that are described, but not of those within them.
class KeyNames final : public Fields {
 public:
  std::vector<std::string> names;

  void number(const char* key, double&, const Quantity&) override { names.push_back(key); }
  void integer(const char* key, std::int64_t&, const Quantity&) override { names.push_back(key); }
  void flag(const char* key, bool&, const char*) override { names.push_back(key); }
  void text(const char* key, std::string&, const char*, bool) override { names.push_back(key); }
  void vector(const char* key, Vec3&, const Quantity&) override { names.push_back(key); }
  void integers(const char* key, std::array<std::int64_t, 3>&, const Quantity&) override {
    names.push_back(key);
  }
  void rows(const char* key, std::vector<std::vector<double>>&, int, const Quantity&) override {
    names.push_back(key);
  }
  void choice(const char* key, int&, std::span<const Choice>, const char*) override { names.push_back(key); }
  void choices(const char* key, std::vector<int>&, std::span<const Choice>, const char*) override {
    names.push_back(key);
  }
  void object(const char* key, bool&, bool, const char*, const std::function<void(Fields&)>&) override {
    names.push_back(key);
  }
  void list(const char* key, bool, const char*, const std::function<void(Fields&)>&) override {
    names.push_back(key);
  }
  void dictionary(const char* key, bool, const char*,
                  const std::function<void(const std::string&, Fields&)>&) override {
    names.push_back(key);
  }
  void alternatives(int&, std::span<const Alternative>, const char*) override {}
  void parameters(const char*, const char*) override {}
  void check(bool, const char*, const std::string&) override {}
};

}  // namespace repose
