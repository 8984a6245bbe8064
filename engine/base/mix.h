// Repose: the finalizer of splitmix64 (Steele, Lea and Flood 2014): a bijection of 64 bits, for hashes and for
// numbers that look random.
#pragma once

#include <cstdint>

namespace repose {

constexpr std::uint64_t mix_bits(std::uint64_t x) {
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ull;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebull;
  return x ^ (x >> 31);
}

}  // namespace repose
