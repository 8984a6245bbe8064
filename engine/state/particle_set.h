// Repose: the particles of one body: one material, one mass and one volume for all, as a structure of arrays in
// the order of blocks. A set has the channels that every particle needs and those that its law and effects
// asked for.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/aligned_array.h"
#include "kernels/layout/particle_span.h"

namespace repose {

/// One number per particle that an effect, or the law of the material, asked for, such as the volume gained.
template <class Real>
struct ExtraChannel {
  std::string name;
  AlignedArray<Real> values;
};

template <class Real>
struct ParticleSet {
  std::string name;
  int material = 0;              ///< position in the scene's materials
  double particle_mass = 0.0;    ///< m, kg
  double particle_volume = 0.0;  ///< V0, m^3
  std::size_t count = 0;

  AlignedArray<Real> position[3];  ///< cells from the origin of the particle's block
  AlignedArray<Real> velocity[3];  ///< m/s
  bool keeps_affine = true;        ///< whether the transfer stores C; if not, `affine` has no room
  AlignedArray<Real> affine[kAffineComponents];
  AlignedArray<Real> strain[kStrainComponents];
  AlignedArray<std::uint32_t> id;
  std::vector<ExtraChannel<Real>> extra;  ///< those of the material's law, then those of effects
  std::size_t law_channels = 0;           ///< how many are the law's

  /// Particles of occupied block b of the block grid: [begin[b], begin[b + 1]).
  std::vector<std::uint32_t> begin;

  /// Calls visit(AlignedArray<Real>&, name) for every real channel, in an order that never changes.
  template <class Visit>
  void for_each_real(Visit visit) {
    for (auto& channel : position) visit(channel);
    for (auto& channel : velocity) visit(channel);
    for (auto& channel : affine) {
      if (keeps_affine) visit(channel);
    }
    for (auto& channel : strain) visit(channel);
    for (auto& channel : extra) visit(channel.values);
  }
  template <class Visit>
  void for_each_real(Visit visit) const {
    const_cast<ParticleSet*>(this)->for_each_real([&](const AlignedArray<Real>& channel) { visit(channel); });
  }

  void allocate(std::size_t particles) {
    count = particles;
    for_each_real([&](AlignedArray<Real>& channel) { channel.resize(particles); });
    id.resize(particles);
  }

  ParticleSpan<Real> span(std::size_t first, std::size_t particles) {
    ParticleSpan<Real> result;
    for (int axis = 0; axis < 3; ++axis) {
      result.position[axis] = position[axis].data() + first;
      result.velocity[axis] = velocity[axis].data() + first;
    }
    for (int k = 0; k < kAffineComponents; ++k) {
      result.affine[k] = keeps_affine ? affine[k].data() + first : nullptr;
    }
    for (int k = 0; k < kStrainComponents; ++k) result.strain[k] = strain[k].data() + first;
    result.count = particles;
    return result;
  }

  /// Where the channel of an effect lies in `extra`; extra.size() if no effect asked for it.
  std::size_t extra_index(std::string_view channel) const {
    std::size_t index = 0;
    while (index < extra.size() && extra[index].name != channel) ++index;
    return index;
  }

  std::size_t bytes() const {
    std::size_t sum = id.bytes() + begin.capacity() * sizeof(std::uint32_t);
    for_each_real([&](const AlignedArray<Real>& channel) { sum += channel.bytes(); });
    return sum;
  }
};

}  // namespace repose
