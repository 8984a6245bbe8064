// Repose: numbers in half precision.
#pragma once

#include <bit>
#include <cstdint>

namespace repose::api {

/// The bits of the nearest binary16, ties to even; infinite beyond 65504, and not a number where it is none.
inline std::uint16_t half_of(float value) {
  const std::uint32_t bits = std::bit_cast<std::uint32_t>(value);
  const std::uint32_t sign = bits >> 16 & 0x8000u, rest = bits & 0x7fffffffu;
  constexpr std::uint32_t kInfinity = 0x7f800000u, kTooLarge = 0x477ff000u, kNormal = 0x38800000u;
  if (rest > kInfinity) return static_cast<std::uint16_t>(sign | 0x7e00u);
  if (rest >= kTooLarge) return static_cast<std::uint16_t>(sign | 0x7c00u);
  std::uint32_t shift = 13, mantissa = rest;
  if (rest < kNormal) {  // below 2^-14 steps are 2^-24, whatever the exponent
    const std::uint32_t exponent = rest >> 23;
    if (exponent < 102) return static_cast<std::uint16_t>(sign);  // less than half of the least
    mantissa = (rest & 0x7fffffu) | 0x800000u;
    shift = 126 - exponent;
  } else {
    mantissa -= (127u - 15u) << 23;
  }
  const std::uint32_t half = 1u << (shift - 1), left = mantissa & ((1u << shift) - 1);
  std::uint32_t made = mantissa >> shift;
  if (left > half || (left == half && (made & 1u) != 0)) ++made;
  return static_cast<std::uint16_t>(sign | made);
}

}  // namespace repose::api
