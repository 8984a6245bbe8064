#include "apps/repose/base/memory_reserve.h"

#include <atomic>
#include <cstdlib>
#include <new>

namespace repose {
namespace {

constexpr std::size_t kBytes = std::size_t{16} << 20;

std::atomic<void*> g_reserve = nullptr;
std::atomic<bool> g_gave_out = false;

void give_back() {
  void* const reserve = g_reserve.exchange(nullptr);
  g_gave_out = true;
  if (reserve == nullptr) throw std::bad_alloc();
  std::free(reserve);
}

}  // namespace

void keep_memory_reserve() {
  g_reserve = std::malloc(kBytes);
  std::set_new_handler(give_back);
}

bool memory_gave_out() {
  return g_gave_out;
}

}  // namespace repose
