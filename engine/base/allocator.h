// Repose: where the memory of large arrays comes from: the C library, or functions of a host, for the whole
// process.
#pragma once

#include <cstddef>
#include <utility>

namespace repose {

/// Both functions null: the C library. Any thread may call them.
struct Allocator {
  /// `bytes` is a multiple of `alignment`; null where there are none to be had.
  void* (*allocate)(void* user, std::size_t bytes, std::size_t alignment) = nullptr;
  void (*release)(void* user, void* memory, std::size_t bytes, std::size_t alignment) = nullptr;
  void* user = nullptr;
};

/// That of arrays that are made from now on; what others have given goes back to them.
void set_allocator(const Allocator& allocator);

/// Bytes, and whom they go back to.
class AllocatedBytes {
 public:
  static constexpr std::size_t kAlignment = 64;

  AllocatedBytes() = default;
  /// Throws std::bad_alloc.
  explicit AllocatedBytes(std::size_t bytes);
  AllocatedBytes(AllocatedBytes&& other) noexcept { swap(other); }
  AllocatedBytes& operator=(AllocatedBytes&& other) noexcept {
    swap(other);
    return *this;
  }
  ~AllocatedBytes();

  std::byte* data() const { return data_; }
  void swap(AllocatedBytes& other) noexcept {
    std::swap(data_, other.data_);
    std::swap(bytes_, other.bytes_);
    std::swap(from_, other.from_);
  }

 private:
  std::byte* data_ = nullptr;
  std::size_t bytes_ = 0;
  const Allocator* from_ = nullptr;  // null: the C library
};

}  // namespace repose
