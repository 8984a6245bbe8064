// Repose: memory of channels and fields: 64-byte aligned, never initialised twice, zero beyond its size so that
// a full register may be read at the end.
#pragma once

#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <new>
#include <utility>

namespace repose {

template <class T>
class AlignedArray {
 public:
  AlignedArray() = default;
  explicit AlignedArray(std::size_t size) { resize(size); }

  /// Makes room for `size` zeros; what was there is gone. Throws std::bad_alloc.
  void resize(std::size_t size) {
    if (size > capacity_) {
      const std::size_t bytes = round_up((size + kPadding / sizeof(T)) * sizeof(T));
      T* raw = static_cast<T*>(std::aligned_alloc(kAlignment, bytes));
      if (raw == nullptr) throw std::bad_alloc();
      data_.reset(raw);
      capacity_ = bytes / sizeof(T) - kPadding / sizeof(T);
    }
    size_ = size;
    clear();
  }
  /// Makes room for `size` values, which are whatever was there.
  void reserve_uninitialized(std::size_t size) {
    if (size > capacity_) return resize(size);
    size_ = size;
  }
  void clear() {
    if (data_) std::memset(data_.get(), 0, capacity_ * sizeof(T) + kPadding);
  }

  T* data() { return data_.get(); }
  const T* data() const { return data_.get(); }
  T& operator[](std::size_t i) { return data_.get()[i]; }
  const T& operator[](std::size_t i) const { return data_.get()[i]; }
  std::size_t size() const { return size_; }
  std::size_t bytes() const { return data_ ? capacity_ * sizeof(T) + kPadding : 0; }

  friend void swap(AlignedArray& a, AlignedArray& b) noexcept {
    a.data_.swap(b.data_);
    std::swap(a.size_, b.size_);
    std::swap(a.capacity_, b.capacity_);
  }

 private:
  static constexpr std::size_t kAlignment = 64;
  static constexpr std::size_t kPadding = 64;  // bytes
  static constexpr std::size_t round_up(std::size_t bytes) {
    return (bytes + kAlignment - 1) / kAlignment * kAlignment;
  }

  struct Free {
    void operator()(T* raw) const { std::free(raw); }
  };
  std::unique_ptr<T[], Free> data_;
  std::size_t size_ = 0;
  std::size_t capacity_ = 0;
};

}  // namespace repose
