// Repose: what becomes of exceptions of libraries, at the few places that catch them.
#pragma once

#include <exception>
#include <new>
#include <string>
#include <string_view>
#include <system_error>

#include "engine/base/result.h"

namespace repose {

/// Whether an exception tells of memory that ran out: JsonCpp and streams say so in words alone, and a thread
/// that finds no room for its stack says to try again.
inline bool is_of_memory(const std::exception& failure) {
  const std::string_view words = failure.what();
  const auto* const of_system = dynamic_cast<const std::system_error*>(&failure);
  if (of_system != nullptr && of_system->code() == std::errc::resource_unavailable_try_again) return true;
  return dynamic_cast<const std::bad_alloc*>(&failure) != nullptr ||
         words.find("pthread_create has failed") != words.npos ||
         words.find("Failed to allocate") != words.npos || words.find("allocation failed") != words.npos;
}

/// The error of an exception that nothing has turned into one: 78 of memory, 71 of all others.
inline Error error_of(const std::exception& failure, const std::string& where) {
  if (is_of_memory(failure)) return {ErrorKind::kMemory, "memory ran out", where};
  return {ErrorKind::kInternal, failure.what(), where};
}

}  // namespace repose
