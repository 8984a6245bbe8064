// Repose: times the loops of peak_loops.h.
#include <time.h>

#include <algorithm>
#include <array>
#include <optional>

#include "bench/peak_loops.h"
#include "bench/peaks.h"
#include "bench/sand.h"
#include "engine/base/aligned_array.h"

namespace repose {
namespace {

constexpr int kTries = 20;
constexpr int kMemoryTries = 2;
constexpr double kLeastSeconds = 5e-4;  ///< of a try

/// Time that this thread has had a core: other programs on the machine do not count.
double thread_seconds() {
  timespec now;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Most of `amount` per second that `run` gets through, repeated until a try is long enough.
template <class Run>
double best_rate(double amount, int tries, Run run) {
  double best = 0.0;
  int repeats = 1;
  for (int attempt = 0; attempt < tries;) {
    const double start = thread_seconds();
    for (int k = 0; k < repeats; ++k) run();
    const double seconds = thread_seconds() - start;
    if (seconds < kLeastSeconds) {
      repeats *= 2;
      continue;
    }
    best = std::max(best, amount * repeats / seconds);
    ++attempt;
  }
  return best;
}

/// Results of loops go here, so that they are results.
template <class Real>
volatile Real g_kept = 0;

template <class Real>
CorePeaks measure_core(Target target) {
  const PeakLoops<Real> loops = peak_loops<Real>(target);
  CorePeaks peaks{};
  constexpr std::size_t kRounds = 20000;
  peaks.flops = best_rate(static_cast<double>(loops.flops_per_round * kRounds), kTries,
                          [&] { g_kept<Real> = loops.chains(kRounds, Real(0.999), Real(0.001)); });

  // A few lines more between the arrays of the triad than their length: the same place in a page would hold up
  // loads.
  constexpr std::size_t kThird = 8192 / sizeof(Real), kAll = 3 * kThird, kApart = kThird + 320 / sizeof(Real);
  AlignedArray<Real> small(3 * kApart);
  Real* const x = small.data();
  constexpr double kBytes = kAll * sizeof(Real);
  peaks.l1_read = best_rate(kBytes, kTries, [&] { g_kept<Real> = loops.sum(x, kAll); });
  peaks.l1_update =
      best_rate(2 * kBytes, kTries, [&] { loops.update(&x, 1, 0, kAll, 0, Real(0.999), Real(0.001)); });
  peaks.l1_triad =
      best_rate(kBytes, kTries, [&] { loops.triad(x + 2 * kApart, x, x + kApart, kThird, Real(0.5)); });

  constexpr std::size_t kHalfMegabyte = (std::size_t{512} << 10) / sizeof(Real);
  AlignedArray<Real> large(kHalfMegabyte);
  Real* const w = large.data();
  peaks.l2_update = best_rate(2.0 * kHalfMegabyte * sizeof(Real), kTries,
                              [&] { loops.update(&w, 1, 0, kHalfMegabyte, 0, Real(0.999), Real(0.001)); });
  return peaks;
}

template <class Real>
MemoryPeaks& best_memory(Target target) {
  static std::array<MemoryPeaks, kTargets> best;
  return best[static_cast<std::size_t>(target)];
}

}  // namespace

double CorePeaks::l1() const {
  return std::max({l1_read, l1_update, l1_triad});
}

double MemoryPeaks::best_update() const {
  return *std::ranges::max_element(update);
}

template <class Real>
const CorePeaks& core_peaks(Target target) {
  static std::array<std::optional<CorePeaks>, kTargets> known;
  auto& peaks = known[static_cast<std::size_t>(target)];
  if (!peaks) peaks = measure_core<Real>(target);
  return *peaks;
}

template <class Real>
const MemoryPeaks& memory_peaks(Target target) {
  return best_memory<Real>(target);
}

/// Factor 1 and summand 0: the sand stays what it was.
template <class Real>
void try_memory(Target target, Sand<Real>& sand) {
  constexpr int kChannels = Workpiece<Real>::kChannels;
  const PeakLoops<Real> loops = peak_loops<Real>(target);
  Real* streams[kChannels];
  for (int k = 0; k < kChannels; ++k) streams[k] = sand.channel[k].data();
  MemoryPeaks& best = best_memory<Real>(target);
  const double bytes = static_cast<double>(sand.count) * sizeof(Real);
  const double read = best_rate(kChannels * bytes, kMemoryTries, [&] {
    for (const Real* one : streams) g_kept<Real> = loops.sum(one, sand.count);
  });
  best.read = std::max(best.read, read);
  for (std::size_t k = 0; k < std::size(MemoryPeaks::kStreams); ++k) {
    const int together = MemoryPeaks::kStreams[k], all = kChannels / together * together;
    const double update = best_rate(2 * all * bytes, kMemoryTries, [&] {
      for (int first = 0; first < all; first += together) {
        loops.update(streams + first, static_cast<std::size_t>(together), 0, sand.count, kChunk, Real(1),
                     Real(0));
      }
    });
    best.update[k] = std::max(best.update[k], update);
  }
}

#define REPOSE_FOR(Real)                                  \
  template const CorePeaks& core_peaks<Real>(Target);     \
  template const MemoryPeaks& memory_peaks<Real>(Target); \
  template void try_memory(Target, Sand<Real>&);
REPOSE_FOR(float)
REPOSE_FOR(double)
#undef REPOSE_FOR

}  // namespace repose
