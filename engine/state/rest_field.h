// Repose: which blocks sleep, and for how long the others have been calm; per owner. Empty where the scene does
// not ask for it.
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

  void resize(std::size_t owners) {
    asleep.assign(owners, 0);
    calm.assign(owners, 0.0);
    way.assign(owners, {});
  }
  void begin_anew(std::size_t owner) {
    calm[owner] = 0.0;
    way[owner] = {};
  }
  void wake(std::size_t owner) {
    asleep[owner] = 0;
    begin_anew(owner);
  }
  void take(std::size_t owner, const RestField& from, std::size_t other) {
    asleep[owner] = from.asleep[other];
    calm[owner] = from.calm[other];
    way[owner] = from.way[other];
  }
};

}  // namespace repose
