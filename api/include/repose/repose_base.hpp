/**
 * @file repose_base.hpp
 * What repose.hpp rests on, which includes it: errors as exceptions, spans, and handles that destroy
 * themselves.
 */
#ifndef REPOSE_REPOSE_BASE_HPP
#define REPOSE_REPOSE_BASE_HPP

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>

#include "repose.h"

namespace repose {
// Names apart from those of the engine, which the static library holds.
inline namespace host_1 {

/** What was refused: what() is the whole message. */
class Error : public std::runtime_error {
 public:
  Error(repose_status status, const std::string& message, std::string key, std::string place)
      : std::runtime_error(message), status_(status), key_(std::move(key)), place_(std::move(place)) {}
  repose_status status() const { return status_; }
  const std::string& key() const { return key_; }
  const std::string& place() const { return place_; }

 private:
  repose_status status_;
  std::string key_, place_;
};

/** Contiguous numbers of somebody else. */
template <class T>
class Span {
 public:
  Span() = default;
  Span(T* data, std::size_t size) : data_(data), size_(size) {}
  /** Of a vector or an array, also of one that lives as long as the call does. */
  template <class Container,
            class = std::enable_if_t<!std::is_same_v<std::decay_t<Container>, Span> &&
                                     std::is_convertible_v<decltype(std::declval<Container&>().data()), T*>>>
  Span(Container&& container) : data_(container.data()), size_(container.size()) {}
  T* data() const { return data_; }
  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  T* begin() const { return data_; }
  T* end() const { return data_ + size_; }
  T& operator[](std::size_t index) const { return data_[index]; }

 private:
  T* data_ = nullptr;
  std::size_t size_ = 0;
};

namespace detail {

template <class Copy>
std::string text(const Copy& copy) {
  std::string whole(copy(nullptr, 0), '\0');
  copy(whole.data(), whole.size() + 1);
  return whole;
}

inline void check(repose_status status) {
  if (status == REPOSE_OK) return;
  throw Error(status, text(repose_error_message), text(repose_error_key), text(repose_error_place));
}

/** A handle that is destroyed once. */
template <class Handle, repose_status (*Destroy)(Handle)>
class Owned {
 public:
  Owned() = default;
  explicit Owned(Handle handle) : handle_(handle) {}
  Owned(Owned&& other) noexcept : handle_(std::exchange(other.handle_, Handle{0})) {}
  Owned& operator=(Owned&& other) noexcept {
    std::swap(handle_, other.handle_);
    return *this;
  }
  ~Owned() {
    if (handle_.value != 0) Destroy(handle_);
  }
  Handle get() const { return handle_; }

 private:
  Handle handle_{0};
};

template <class T>
struct ElementType;
template <>
struct ElementType<float> {
  static constexpr std::int32_t value = REPOSE_FLOAT;
};
template <>
struct ElementType<double> {
  static constexpr std::int32_t value = REPOSE_DOUBLE;
};
template <>
struct ElementType<std::uint32_t> {
  static constexpr std::int32_t value = REPOSE_UINT32;
};

}  // namespace detail

}  // namespace host_1
}  // namespace repose

#endif
