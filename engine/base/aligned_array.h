// Repose: memory of channels and fields: 64-byte aligned, never initialised twice, zero beyond its size so that
// a full register may be read at the end. Large arrays begin at different places of a page: the channels of a
// set are walked side by side, and with equal places all their lines would compete for one set of the first
// cache level.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstring>
#include <utility>

#include "engine/base/allocator.h"

namespace repose {

template <class T>
class AlignedArray {
 public:
  AlignedArray() = default;
  explicit AlignedArray(std::size_t size) { resize(size); }
  AlignedArray(AlignedArray&& other) noexcept { swap(*this, other); }
  AlignedArray& operator=(AlignedArray&& other) noexcept {
    swap(*this, other);
    return *this;
  }

  /// Makes room for `size` zeros; what was there is gone. Throws std::bad_alloc.
  void resize(std::size_t size) {
    if (size > capacity_) {
      *this = AlignedArray();  // the old memory first, or both would be there for a moment
      const std::size_t bytes = round_up((size + kPadding / sizeof(T)) * sizeof(T));
      const std::size_t shift = bytes >= kLarge ? next_shift() : 0;
      memory_ = AllocatedBytes(bytes + shift);
      data_ = reinterpret_cast<T*>(memory_.data() + shift);
      capacity_ = bytes / sizeof(T) - kPadding / sizeof(T);
    }
    size_ = size;
    clear();
  }
  /// Makes room for `size` values, which are whatever was there; for `room` of them if memory must be asked
  /// for.
  void reserve_uninitialized(std::size_t size, std::size_t room = 0) {
    if (size > capacity_) resize(room > size ? room : size);
    size_ = size;
  }
  /// The same with the values that were there kept. What grows once grows again: it asks for an eighth more.
  void resize_keeping(std::size_t size) {
    if (size > capacity_) {
      AlignedArray larger(size + size / 8);
      if (size_ > 0) std::memcpy(larger.data_, data_, size_ * sizeof(T));
      swap(*this, larger);
    }
    size_ = size;
  }
  void clear() {
    if (data_ != nullptr) std::memset(data_, 0, capacity_ * sizeof(T) + kPadding);
  }

  T* data() { return data_; }
  const T* data() const { return data_; }
  T& operator[](std::size_t i) { return data_[i]; }
  const T& operator[](std::size_t i) const { return data_[i]; }
  std::size_t size() const { return size_; }
  std::size_t capacity() const { return capacity_; }
  std::size_t bytes() const { return data_ != nullptr ? capacity_ * sizeof(T) + kPadding : 0; }

  friend void swap(AlignedArray& a, AlignedArray& b) noexcept {
    a.memory_.swap(b.memory_);
    std::swap(a.data_, b.data_);
    std::swap(a.size_, b.size_);
    std::swap(a.capacity_, b.capacity_);
  }

 private:
  static constexpr std::size_t kAlignment = AllocatedBytes::kAlignment;
  static constexpr std::size_t kPadding = 64;  // bytes
  static constexpr std::size_t round_up(std::size_t bytes) {
    return (bytes + kAlignment - 1) / kAlignment * kAlignment;
  }

  static constexpr std::size_t kLarge = 64 * 1024, kPage = 4096;
  /// Five lines beyond the last one: an odd number, so that all 64 places come round before one repeats.
  static std::size_t next_shift() {
    static std::atomic<std::size_t> arrays = 0;
    return arrays.fetch_add(1, std::memory_order_relaxed) * 5 * kAlignment % kPage;
  }

  AllocatedBytes memory_;
  T* data_ = nullptr;
  std::size_t size_ = 0;
  std::size_t capacity_ = 0;
};

}  // namespace repose
