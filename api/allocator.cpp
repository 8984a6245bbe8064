// Repose: memory of a host.
#include "engine/base/allocator.h"

#include "api/error.h"

using namespace repose::api;

repose_status repose_set_allocator(const repose_allocator* allocator) {
  return guarded([&]() -> repose_status {
    if (const repose_status known = check_optional(allocator, "allocator"); known != REPOSE_OK) return known;
    repose::Allocator given;
    if (allocator != nullptr) {
      if (allocator->allocate == nullptr) return null_argument("allocator.allocate");
      if (allocator->release == nullptr) return null_argument("allocator.release");
      given = {allocator->allocate, allocator->release, allocator->user};
    }
    repose::set_allocator(given);
    return REPOSE_OK;
  });
}
