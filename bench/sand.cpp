#include "bench/sand.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <variant>

namespace repose {
namespace {

constexpr std::size_t kBlockParticles = 8 * kBlockNodes;
/// Blocks that differ from one another, so that no branch predictor learns them by heart.
constexpr std::size_t kDistinctBlocks = 64;

/// Our own scaling: distributions of the standard library differ between libraries.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}
  double operator()(double low, double high) {
    return low + (high - low) * (static_cast<double>(engine_() >> 11) * 0x1p-53);
  }

 private:
  std::mt19937_64 engine_;
};

int base_of(double x, std::size_t stencil) {
  return static_cast<int>(std::floor(x - kStencilFigures[stencil].base_shift));
}

/// Positions of a block in order: a lattice of two an axis and cell, from which each particle has strayed by up
/// to a lattice spacing, as sand has after some steps. Who leaves on one side comes back on the other.
template <class Real>
std::vector<std::array<Real, 3>> block_positions(std::size_t stencil, Random& random) {
  const double low = kStencilFigures[stencil].base_shift + kStencilFigures[stencil].block_shift;
  std::vector<std::array<Real, 3>> positions(kBlockParticles);
  for (std::size_t p = 0; p < kBlockParticles; ++p) {
    const std::size_t place[3] = {p / 64, p / 8 % 8, p % 8};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double strayed = (static_cast<double>(place[axis]) + 0.5) / 2 + random(-0.5, 0.5);
      const double x = static_cast<Real>(low + strayed - kBlockSide * std::floor(strayed / kBlockSide));
      positions[p][axis] = static_cast<Real>(x < low + kBlockSide ? x : low);
    }
  }
  const auto node = [stencil](const std::array<Real, 3>& x) {
    return std::array{base_of(x[0], stencil), base_of(x[1], stencil), base_of(x[2], stencil)};
  };
  std::stable_sort(positions.begin(), positions.end(),
                   [&](const auto& a, const auto& b) { return node(a) < node(b); });
  return positions;
}

template <class Real>
void fill_channel(Real* channel, std::size_t count, Random& random, double low, double high) {
  for (std::size_t p = 0; p < count; ++p) channel[p] = static_cast<Real>(random(low, high));
}

/// Strains of half a percent under pressure: most particles inside the cone or on it, some opened.
template <class Real>
void fill_block(Sand<Real>& sand, std::size_t first, std::size_t stencil, Random& random) {
  const auto positions = block_positions<Real>(stencil, random);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::size_t p = 0; p < kBlockParticles; ++p) sand.channel[axis][first + p] = positions[p][axis];
  }
  constexpr int kStrain = 15, kGained = 21;
  for (int k = 3; k <= kGained; ++k) {
    const bool diagonal = k == kStrain || k == kStrain + 3 || k == kStrain + 5;
    const double most = k < 6 ? 1.0 : k < kStrain ? 10.0 : k < kGained ? 2e-3 : 1e-5;
    const double shift = diagonal ? -1.5e-3 : 0.0;
    fill_channel(sand.channel[k].data() + first, kBlockParticles, random, shift - most, shift + most);
  }
}

template <class Real>
double particles_per_segment_in(const Sand<Real>& sand, std::size_t stencil) {
  std::size_t segments = 0;
  std::array<int, 3> last{-9, -9, -9};
  for (std::size_t p = 0; p < sand.count; ++p) {
    std::array<int, 3> base;
    for (std::size_t axis = 0; axis < 3; ++axis) base[axis] = base_of(sand.channel[axis][p], stencil);
    segments += base != last || p % kChunk == 0;
    last = base;
  }
  return static_cast<double>(sand.count) / static_cast<double>(segments);
}

}  // namespace

template <class Real>
ParticleSpan<Real> Workpiece<Real>::particles() const {
  ParticleSpan<Real> span;
  std::copy_n(channel, 3, span.position);
  std::copy_n(velocity(), 3, span.velocity);
  std::copy_n(affine(), kAffineComponents, span.affine);
  std::copy_n(strain(), kStrainComponents, span.strain);
  span.count = kChunk;
  span.ahead = ahead;
  return span;
}

template <class Real>
Lattice<Real> Workpiece<Real>::lattice(std::size_t stencil) const {
  const Real scale = static_cast<Real>(kStencilFigures[stencil].inverse_d / SandNumbers::kSpacing);
  return {static_cast<Real>(SandNumbers::kSpacing), {scale, scale, scale}, -1};
}

template <class Real>
MaterialInput<Real> Workpiece<Real>::material(const void* constants) const {
  MaterialInput<Real> in;
  in.constants = constants;
  std::copy_n(strain(), kStrainComponents, in.strain);
  std::copy_n(gradient(), kAffineComponents, in.gradient);
  std::copy_n(stress(), kStrainComponents, in.stress);
  in.dt = dt;
  in.count = kChunk;
  in.ahead = ahead;
  return in;
}

template <class Real>
YieldInput<Real> Workpiece<Real>::surface() const {
  return {near[22], near[23], near[24], near[25], near[26], near[27]};
}

template <class Real>
std::vector<std::span<Real>> Workpiece<Real>::arrays() const {
  std::vector<std::span<Real>> all;
  for (Real* one : channel) all.emplace_back(one, kChunk);
  for (Real* one : near) all.emplace_back(one, kChunk);
  all.emplace_back(arena, kArenaValues);
  for (int block = 0; block < kNeighbours; ++block)
    all.emplace_back(nodes + block * kBlockValues, kBlockValues);
  return all;
}

template <class Real>
void Sand<Real>::fill(std::size_t stencil, std::size_t blocks) {
  count = blocks * kBlockParticles;
  for (auto& one : channel) one.reserve_uninitialized(count);
  Random random(7);
  const std::size_t distinct = std::min(blocks, kDistinctBlocks);
  for (std::size_t b = 0; b < distinct; ++b) fill_block(*this, b * kBlockParticles, stencil, random);
  const std::size_t period = distinct * kBlockParticles;
  for (auto& one : channel) {
    for (std::size_t first = period; first < count; first += period) {
      std::copy_n(one.data(), std::min(period, count - first), one.data() + first);
    }
  }
}

template <class Real>
Chunk<Real>::Chunk(std::size_t stencil)
    : channels_(Workpiece<Real>::kChannels * kChunk),
      near_(Workpiece<Real>::kNear * kChunk),
      arena_(kArenaValues),
      nodes_(kNeighbours * kBlockValues) {
  Sand<Real> sand;
  sand.fill(stencil, 1);
  Random random(8);
  for (std::size_t k = 0; k < Workpiece<Real>::kChannels; ++k) {
    piece_.channel[k] = channels_.data() + k * kChunk;
    std::copy_n(sand.channel[k].data() + kChunk, kChunk, piece_.channel[k]);
  }
  for (std::size_t k = 0; k < Workpiece<Real>::kNear; ++k) {
    const double most = k < 6 ? 500.0 : k < 12 ? 1.0 : k < 21 ? 10.0 : k < 22 ? 2e-3 : k < 23 ? 2.0 : 0.2;
    // Cones, cohesions and dilatancies are not negative; cohesions are strains.
    const double scale = k == 23 ? 1e-3 : 1.0;
    piece_.near[k] = near_.data() + k * kChunk;
    fill_channel(piece_.near[k], kChunk, random, k < 22 ? -most : 0.0, scale * most);
  }
  piece_.arena = arena_.data();
  piece_.nodes = nodes_.data();
  for (AlignedArray<Real>* nodes : {&arena_, &nodes_}) {
    fill_channel(nodes->data(), nodes->size(), random, -1, 1);
    // Masses about 1, so that many divisions in place neither overflow nor vanish; some nodes are empty.
    for (std::size_t k = 0; k + 4 <= nodes->size(); k += 4) {
      (*nodes)[k] = static_cast<Real>(k % 44 == 0 ? 0.0 : random(0.9, 1.1));
    }
  }
}

template <class Real>
void Chunk<Real>::copy(const Workpiece<Real>& from) {
  const auto to = piece_.arrays(), source = from.arrays();
  for (std::size_t k = 0; k < to.size(); ++k) std::ranges::copy(source[k], to[k].begin());
}

template <class Real>
void Chunk<Real>::copy(const Workpiece<Real>& from, const std::vector<std::size_t>& arrays) {
  const auto to = piece_.arrays(), source = from.arrays();
  for (const std::size_t k : arrays) std::ranges::copy(source[k], to[k].begin());
}

std::uint64_t rows_of_block(std::size_t stencil) {
  constexpr auto kWidths = []<class... Stencil>(const std::tuple<Stencil...>&) {
    return std::array{Stencil::kWidth...};
  }(Stencils{});
  // A block that begins within a cell has base nodes in five.
  const int first = -kStencilFigures[stencil].lowest_base;
  const int cells = kStencilFigures[stencil].block_shift > 0 ? kBlockSide + 1 : kBlockSide;
  std::uint64_t rows = 0;
  for (int x = first; x < first + cells + kWidths[stencil] - 1; ++x) {
    for (int y = first; y < first + cells + kWidths[stencil] - 1; ++y) {
      rows |= std::uint64_t{1} << (x * kArenaSide + y);
    }
  }
  return rows;
}

double particles_per_segment(std::size_t stencil) {
  static const auto all = [] {
    std::array<double, kStencilFigures.size()> lengths;
    for (std::size_t s = 0; s < lengths.size(); ++s) {
      Sand<double> sand;
      sand.fill(s, kDistinctBlocks);
      lengths[s] = particles_per_segment_in(sand, s);
    }
    return lengths;
  }();
  return all[stencil];
}

template <class Real>
Sand<Real>& memory_sand(std::size_t stencil) {
  static std::variant<Sand<float>, Sand<double>> sand;
  if (!std::holds_alternative<Sand<Real>>(sand)) sand.emplace<Sand<Real>>();
  auto& own = std::get<Sand<Real>>(sand);
  own.fill(stencil, kMemoryBytes / (Workpiece<Real>::kChannels * sizeof(Real) * kBlockParticles));
  return own;
}

#define REPOSE_FOR(Real)           \
  template struct Workpiece<Real>; \
  template struct Sand<Real>;      \
  template class Chunk<Real>;      \
  template Sand<Real>& memory_sand(std::size_t);
REPOSE_FOR(float)
REPOSE_FOR(double)
#undef REPOSE_FOR

}  // namespace repose
