// Repose: how functions of the C API refuse: a status, and per thread what it is about. Nothing that is thrown
// leaves a function of the API: each is the body of guarded().
#pragma once

#include <exception>
#include <new>
#include <string>

#include "api/include/repose/repose.h"
#include "engine/base/clean_floating_point.h"
#include "engine/base/result.h"

namespace repose::api {

/// Keeps what was refused, for the thread, and returns the status.
repose_status fail(repose_status status, const char* message, const std::string& key = "") noexcept;
repose_status fail(const Error& error) noexcept;

/// What a handle is answered with that is of nothing.
repose_status no_handle(const char* kind) noexcept;
/// A null pointer where there must be something.
repose_status null_argument(const char* name) noexcept;

/// Whether a struct is one that this library knows; `out` says what it is called.
template <class Struct>
repose_status check(const Struct* given, const char* name) noexcept {
  if (given == nullptr) return null_argument(name);
  if (given->size >= sizeof(Struct) && given->version == REPOSE_STRUCT_VERSION) return REPOSE_OK;
  return fail(REPOSE_ERROR_VERSION,
              "is of a version, or a size, that this library does not know; make it by the function _init",
              name);
}
/// The same where null is as good as defaults.
template <class Struct>
repose_status check_optional(const Struct* given, const char* name) noexcept {
  return given == nullptr ? REPOSE_OK : check(given, name);
}

/// The body of a function of the API, in a clean floating-point environment whatever the host has set.
template <class Body>
repose_status guarded(const Body& body) noexcept {
  try {
    const CleanFloatingPoint clean;
    return body();
  } catch (const std::bad_alloc&) {
    return fail(REPOSE_ERROR_MEMORY, "memory ran out");
  } catch (const std::exception& error) {
    return fail(REPOSE_ERROR_INTERNAL, error.what());
  } catch (...) {
    return fail(REPOSE_ERROR_INTERNAL, "something that is no exception of the standard library was thrown");
  }
}

/// Copies a text, ended by a zero, as far as there is room. Returns its whole length.
std::size_t copy_text(const std::string& text, char* buffer, std::size_t capacity) noexcept;

}  // namespace repose::api
