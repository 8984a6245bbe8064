#include "engine/base/allocator.h"

#include <atomic>
#include <cstdlib>
#include <forward_list>
#include <mutex>
#include <new>

namespace repose {
namespace {

std::atomic<const Allocator*> current = nullptr;

/// For ever: an array may outlive those who made it, and statics.
const Allocator* keep(const Allocator& allocator) {
  static std::mutex mutex;
  static auto* const all = new std::forward_list<Allocator>;
  const std::lock_guard lock(mutex);
  return &all->emplace_front(allocator);
}

}  // namespace

void set_allocator(const Allocator& allocator) {
  current.store(allocator.allocate == nullptr ? nullptr : keep(allocator));
}

AllocatedBytes::AllocatedBytes(std::size_t bytes) : bytes_(bytes), from_(current.load()) {
  void* const memory = from_ == nullptr ? std::aligned_alloc(kAlignment, bytes)
                                        : from_->allocate(from_->user, bytes, kAlignment);
  if (memory == nullptr) throw std::bad_alloc();
  data_ = static_cast<std::byte*>(memory);
}

AllocatedBytes::~AllocatedBytes() {
  if (data_ == nullptr) return;
  if (from_ == nullptr) {
    std::free(data_);
  } else {
    from_->release(from_->user, data_, bytes_, kAlignment);
  }
}

}  // namespace repose
