// Repose tests: the cases of the battery that go over many samples. The usual program takes some ten thousand
// of them, the long one a million.
#pragma once

#include <cstddef>

namespace repose::battery {

void wide_eigenvalues(std::size_t samples);          ///< 1
void equal_and_missing_values(std::size_t samples);  ///< 2
void scaled_matrices(std::size_t samples);           ///< 3
void subnormal_matrices(std::size_t samples);        ///< 3
void killer_matrices(std::size_t samples);           ///< 4
void return_over_a_decade(std::size_t samples);      ///< 6
void return_over_six_decades(std::size_t samples);   ///< 7
void cone_tip(std::size_t samples);                  ///< 8
void extreme_sands(std::size_t samples);             ///< 10
void turned_states(std::size_t samples);             ///< 11
void energy_and_work(std::size_t samples);           ///< 12
void stencil_sums(std::size_t samples);              ///< 14
void light_nodes(std::size_t samples);               ///< 22

/// Calls work(count, seed) until all samples are done, some thousands at a time.
template <class Work>
void in_batches(std::size_t samples, Work work) {
  constexpr std::size_t kMost = 20011;
  for (std::size_t done = 0, seed = 1; done < samples; ++seed) {
    const std::size_t count = samples - done < kMost ? samples - done : kMost;
    work(count, seed);
    done += count;
  }
}

}  // namespace repose::battery
