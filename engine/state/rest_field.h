// Repose: which blocks sleep, and for how long the others have been calm; per occupied block. Empty where the
// scene does not ask for it.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace repose {

struct RestField {
  bool on = false;                         ///< whether blocks may sleep at all
  std::vector<std::uint8_t> asleep;        ///< 0 or 1
  std::vector<double> calm;                ///< s, for which all particles of one that is awake have been slow
  std::vector<std::array<double, 3>> way;  ///< m: net way of its particles in that time; asleep, of its nodes

  void resize(std::size_t occupied) {
    asleep.assign(occupied, 0);
    calm.assign(occupied, 0.0);
    way.assign(occupied, {});
  }
  void begin_anew(std::size_t occupied) {
    calm[occupied] = 0.0;
    way[occupied] = {};
  }
  void wake(std::size_t occupied) {
    asleep[occupied] = 0;
    begin_anew(occupied);
  }
  void take(std::size_t occupied, const RestField& from, std::size_t other) {
    asleep[occupied] = from.asleep[other];
    calm[occupied] = from.calm[other];
    way[occupied] = from.way[other];
  }
};

}  // namespace repose
