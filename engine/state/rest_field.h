// Repose: which blocks sleep, and for how long the others have been calm; per owner. Empty where the scene does
// not ask for it.
#pragma once

#include <cstdint>
#include <vector>

namespace repose {

struct RestField {
  bool on = false;                   ///< whether blocks may sleep at all
  std::vector<std::uint8_t> asleep;  ///< 0 or 1
  std::vector<double> calm;          ///< s, for which all its particles have been slow
  std::vector<double> path;          ///< m, that nodes of a sleeping owner have moved in all

  void resize(std::size_t owners) {
    asleep.assign(owners, 0);
    calm.assign(owners, 0.0);
    path.assign(owners, 0.0);
  }
  void wake(std::size_t owner) {
    asleep[owner] = 0;
    calm[owner] = path[owner] = 0.0;
  }
  void take(std::size_t owner, const RestField& from, std::size_t other) {
    asleep[owner] = from.asleep[other];
    calm[owner] = from.calm[other];
    path[owner] = from.path[other];
  }
};

}  // namespace repose
