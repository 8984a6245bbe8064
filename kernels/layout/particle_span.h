// Repose: the particles of one block as kernels see them: a structure of arrays, one pointer per component.
// Positions are in cells, relative to the origin of the particles' block, so that no digit is lost far from the
// origin of the scene; everything else is in SI units.
#pragma once

#include <cstddef>

namespace repose {

/// Components of the channels that every particle has. Matrices are stored by rows; the symmetric strain as
/// xx xy xz yy yz zz.
inline constexpr int kAffineComponents = 9;
inline constexpr int kStrainComponents = 6;

/// Particles per call: what a pass hands to the next through scratch stays in the first cache level.
inline constexpr std::size_t kChunk = 128;

template <class Real>
struct ParticleSpan {
  Real* position[3];                ///< cells, from the block's origin
  Real* velocity[3];                ///< m/s
  Real* affine[kAffineComponents];  ///< C, 1/s: the matrix that APIC carries; null where none is kept
  Real* strain[kStrainComponents];  ///< Hencky strain log(b)/2 of the elastic part, no unit
  std::size_t count;
  /// Distance to the particles that are worked on next: kernels ask memory for those while they do these. There
  /// are more channels than the streams that processors follow by themselves. 0: nothing to ask for.
  std::ptrdiff_t ahead = 0;
};

}  // namespace repose
