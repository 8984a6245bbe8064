// Repose: handles of the C API. A handle is a number, its kind, a place in a table and how often that place has
// been used, so that one that was destroyed, or never made, is known as such and never followed. Who has found
// an object shares it: it lasts until the calls that are under way on it have ended.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <mutex>
#include <vector>

namespace repose::api {

template <class Object>
class Registry {
 public:
  /// `kind` in [1, 255] parts the handles of one registry from those of others.
  explicit Registry(std::uint8_t kind) : kind_(kind) {}

  std::uint64_t add(std::shared_ptr<Object> object) {
    const std::lock_guard<std::mutex> lock(mutex_);
    std::uint32_t place = 0;
    if (free_.empty()) {
      place = static_cast<std::uint32_t>(slots_.size());
      slots_.push_back({});
    } else {
      place = free_.back();
      free_.pop_back();
    }
    slots_[place].object = std::move(object);
    return value(place);
  }

  /// Null where the handle is of nothing that is there.
  std::shared_ptr<Object> find(std::uint64_t handle) const {
    const std::lock_guard<std::mutex> lock(mutex_);
    const auto place = static_cast<std::uint32_t>(handle);
    return place < slots_.size() && value(place) == handle ? slots_[place].object : nullptr;
  }

  /// The object, which is then nobody's but the caller's and of calls under way; null as find().
  std::shared_ptr<Object> remove(std::uint64_t handle) {
    const std::lock_guard<std::mutex> lock(mutex_);
    const auto place = static_cast<std::uint32_t>(handle);
    if (place >= slots_.size() || value(place) != handle || slots_[place].object == nullptr) return nullptr;
    std::shared_ptr<Object> object = std::move(slots_[place].object);
    slots_[place].object = nullptr;
    ++slots_[place].uses;
    if (slots_[place].uses < kMostUses) free_.push_back(place);  // else it is never used again
    return object;
  }

 private:
  static constexpr std::uint32_t kMostUses = 1u << 24;
  struct Slot {
    std::uint32_t uses = 0;
    std::shared_ptr<Object> object;
  };

  std::uint64_t value(std::uint32_t place) const {
    return std::uint64_t{kind_} << 56 | std::uint64_t{slots_[place].uses & (kMostUses - 1)} << 32 | place;
  }

  std::uint8_t kind_;
  mutable std::mutex mutex_;
  std::vector<Slot> slots_;
  std::vector<std::uint32_t> free_;
};

}  // namespace repose::api
