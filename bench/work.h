// Repose: what each kernel has to do for one particle or node, in numbers read and written and in
// floating-point operations. Counted by hand; work.cpp holds the count as one table.
#pragma once

#include <cstddef>

namespace repose {

/// For one particle or node. Numbers are of the kernel's precision.
struct Work {
  double read = 0;     ///< numbers of the particles' own channels
  double written = 0;  ///< the same
  double fetched =
      0;  ///< of those written, the ones that are not read: their lines come from memory all the same
  double near_read = 0;     ///< numbers of scratch, arenas and nodes, which are in cache
  double near_written = 0;  ///< the same
  double flops = 0;         ///< see work.cpp for what counts

  double near_numbers() const { return read + written + near_read + near_written; }
  double far_read() const { return read + fetched; }
  double far_numbers() const { return read + written + fetched; }
};

/// The transfers, by their places in the lists of the kernels. `segment` is how many particles follow one
/// another with one base node: so many share a look at the arena.
Work scatter_work(std::size_t stencil, std::size_t transfer, double segment, bool measures);
Work gather_work(std::size_t stencil, std::size_t transfer, double segment, bool measures);

/// For strains small enough for the polynomials, as those of sand are.
template <class Real>
Work trial_work();
Work stress_hencky_work();
template <class Real>
Work stress_neo_hookean_work();
Work return_map_drucker_prager_work();
Work return_map_per_particle_drucker_prager_work();
template <class Real>
Work harden_work();
Work strengthen_work();
/// Where some strain of a pack may exceed the limit, so that all of the pack pay for eigenvalues.
template <class Real>
Work cut_tension_work();

Work advance_work();
Work first_failed_work();
Work open_volume_work();
Work close_volume_work();

/// Per node.
Work add_arena_work();
Work load_arena_work();
Work normalize_work();
Work accelerate_work();
Work bound_work();

}  // namespace repose
