#include "api/error.h"

#include <algorithm>
#include <cstring>

namespace repose::api {
namespace {

/// Of the last refusal of a thread.
struct LastError {
  repose_status status = REPOSE_OK;
  std::string message, key, place;
};

thread_local LastError last_error;

void keep(repose_status status, const std::string& message, const std::string& key, const std::string& place) {
  last_error.status = status;
  last_error.message.clear();
  last_error.key.clear();
  last_error.place.clear();
  last_error.message = message;
  last_error.key = key;
  last_error.place = place;
}

}  // namespace

repose_status fail(repose_status status, const char* message, const std::string& key) noexcept {
  try {
    keep(status, key.empty() ? message : key + ": " + message, key, "");
  } catch (const std::bad_alloc&) {
    last_error.status = status;  // without words
  }
  return status;
}

repose_status fail(const Error& error) noexcept {
  const auto status = static_cast<repose_status>(error.kind);
  try {
    const std::size_t parts = error.where.rfind(": ");  // "file:line:column: key.path", or one of the two
    const bool both = parts != std::string::npos;
    keep(status, error.text(), both ? error.where.substr(parts + 2) : error.where,
         both ? error.where.substr(0, parts) : "");
  } catch (const std::bad_alloc&) {
    last_error.status = status;
  }
  return status;
}

repose_status no_handle(const char* kind) noexcept {
  return fail(REPOSE_ERROR_HANDLE, "is null, was destroyed, or is a handle of another kind", kind);
}

repose_status null_argument(const char* name) noexcept {
  return fail(REPOSE_ERROR_ARGUMENT, "must not be null", name);
}

std::size_t copy_text(const std::string& text, char* buffer, std::size_t capacity) noexcept {
  if (buffer != nullptr && capacity > 0) {
    const std::size_t count = std::min(text.size(), capacity - 1);
    std::memcpy(buffer, text.data(), count);
    buffer[count] = '\0';
  }
  return text.size();
}

}  // namespace repose::api

using namespace repose::api;

repose_status repose_error_status(void) {
  return last_error.status;
}

size_t repose_error_message(char* buffer, size_t capacity) {
  return copy_text(last_error.message, buffer, capacity);
}

size_t repose_error_key(char* buffer, size_t capacity) {
  return copy_text(last_error.key, buffer, capacity);
}

size_t repose_error_place(char* buffer, size_t capacity) {
  return copy_text(last_error.place, buffer, capacity);
}

uint32_t repose_version(void) {
  return REPOSE_VERSION;
}
static_assert(REPOSE_VERSION == REPOSE_PROJECT_VERSION, "the header has the version of the project");

const char* repose_status_text(repose_status status) {
  switch (status) {
    case REPOSE_OK:
      return "done";
    case REPOSE_ERROR_USAGE:
      return "wrong arguments";
    case REPOSE_ERROR_SCENE:
      return "wrong scene or geometry";
    case REPOSE_ERROR_NO_INPUT:
      return "no such input";
    case REPOSE_ERROR_PHYSICS:
      return "the physics gave out";
    case REPOSE_ERROR_INTERNAL:
      return "a bug in Repose";
    case REPOSE_ERROR_CANNOT_WRITE:
      return "cannot be written";
    case REPOSE_ERROR_IO:
      return "reading or writing failed, or bytes are damaged";
    case REPOSE_ERROR_MEMORY:
      return "not enough memory";
    case REPOSE_ERROR_HANDLE:
      return "no such handle";
    case REPOSE_ERROR_ARGUMENT:
      return "an argument that cannot be";
    case REPOSE_ERROR_VERSION:
      return "a struct of an unknown version";
    case REPOSE_ERROR_BUSY:
      return "another call on this engine is under way";
    case REPOSE_ERROR_STALE:
      return "a stale view";
    default:
      return "unknown";
  }
}
