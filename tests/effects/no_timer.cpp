// Preloaded where instructions are counted: libhwy reads the time stamp counter when it is loaded, for
// benchmarks that nobody runs, by an instruction (rdtscp) that valgrind does not know on every machine.
#include <cstdint>

namespace hwy::platform {

std::uint64_t TimerResolution();
std::uint64_t TimerResolution() {
  return 1;
}

}  // namespace hwy::platform
