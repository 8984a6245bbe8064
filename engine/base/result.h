// Repose: how bad input is reported. A function that can refuse its input returns Result<T>; nothing
// throws across a floor. Bugs are REPOSE_ASSERT, or kInternal where a plan can be checked before it runs;
// trouble in the physics is a StepReport.
#pragma once

#include <cstdio>
#include <cstdlib>
#include <string>
#include <utility>
#include <variant>

namespace repose {

/// What kind of refusal. The values are the exit codes of the command (sysexits.h).
enum class ErrorKind {
  kUsage = 64,         ///< wrong arguments
  kBadScene = 65,      ///< a scene, or geometry that it names, is wrong
  kNoInput = 66,       ///< an input file does not exist or cannot be read
  kPhysics = 70,       ///< the physics gave out
  kInternal = 71,      ///< a bug in Repose
  kCannotCreate = 73,  ///< the output cannot be written
  kIo = 74,            ///< reading or writing failed midway
  kInUse = 75,         ///< another run holds the output
  kMemory = 78,        ///< needs more memory than there is
};

/// One refusal: what is wrong and what would be right, and where ("file:line:col: key.path" or "file").
struct Error {
  ErrorKind kind = ErrorKind::kUsage;
  std::string message;
  std::string where;

  /// "where: message", as the command prints it.
  std::string text() const { return where.empty() ? message : where + ": " + message; }
};

/// A value, or the reason that there is none.
template <class T>
class [[nodiscard]] Result {
 public:
  Result(T value) : state_(std::in_place_index<0>, std::move(value)) {}
  Result(Error error) : state_(std::in_place_index<1>, std::move(error)) {}

  explicit operator bool() const { return state_.index() == 0; }
  T& value() { return std::get<0>(state_); }
  const T& value() const { return std::get<0>(state_); }
  T& operator*() { return value(); }
  const T& operator*() const { return value(); }
  T* operator->() { return &value(); }
  const T* operator->() const { return &value(); }
  const Error& error() const { return std::get<1>(state_); }

 private:
  std::variant<T, Error> state_;
};

/// Success without a value, or the reason of failure.
template <>
class [[nodiscard]] Result<void> {
 public:
  Result() = default;
  Result(Error error) : error_(std::move(error)), ok_(false) {}

  explicit operator bool() const { return ok_; }
  const Error& error() const { return error_; }

 private:
  Error error_;
  bool ok_ = true;
};

[[noreturn]] inline void assertion_failed(const char* condition, const char* file, int line) {
  std::fprintf(stderr, "%s:%d: internal error: %s does not hold\n", file, line, condition);
  std::abort();
}

}  // namespace repose

/// A condition whose failure is a bug in Repose.
#define REPOSE_ASSERT(condition) \
  ((condition) ? static_cast<void>(0) : ::repose::assertion_failed(#condition, __FILE__, __LINE__))

/// The same where the check is expensive: on in debug and sanitizer builds.
#ifdef REPOSE_VALIDATION
#define REPOSE_VALIDATE(condition) REPOSE_ASSERT(condition)
#else
#define REPOSE_VALIDATE(condition) static_cast<void>(0)
#endif
