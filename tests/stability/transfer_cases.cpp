// Repose tests: cases 14 and 22 of the battery, the weights of the stencils and the velocity of the lightest
// nodes.
#include "tests/kernels/functions.h"
#include "tests/kernels/node_blocks.h"
#include "tests/stability/kernel_cases.h"
#include "tests/stability/worst.h"

namespace repose::battery {
namespace {

/// Sums over an axis or over all nodes, in roundings.
struct Sums {
  Worst weights, first_moment, slopes, first_moment_of_slopes;

  void report(Case& asked, const std::string& of) const {
    at_most(asked, "sum w - 1, " + of, weights, 8, "eps");
    at_most(asked, "first moment, " + of, first_moment, 8, "eps");
    at_most(asked, "sum grad w, " + of, slopes, 8, "eps");
    if (first_moment_of_slopes.figure() > 0) {
      at_most(asked, "first moment of grad w - 1, " + of, first_moment_of_slopes, 8, "eps");
    }
  }
};

/// A coordinate in [low, high): anywhere, or a face where the base node changes, or the middle between two; on
/// it or an ulp beside it.
template <class Real>
Real coordinate(Real low, Real high, Samples& samples) {
  const double whole = static_cast<double>(samples.index(static_cast<std::size_t>(high - low) + 1));
  const Real face = low + static_cast<Real>(whole + 0.5 * static_cast<double>(samples.index(2)));
  const Real choices[] = {static_cast<Real>(samples.uniform(low, high)), face, std::nextafter(face, low - 1),
                          std::nextafter(face, high + 1)};
  const Real x = choices[samples.index(4)];
  return x >= low && x < high ? x : std::nextafter(high, low);
}

template <class Real>
void sums_along_an_axis(Sums& sums, std::size_t stencil, std::size_t count, std::uint64_t seed) {
  constexpr double kEps = kEpsilon<Real>;
  const Real low = static_cast<Real>(kStencilFigures[stencil].base_shift);
  Samples samples(seed);
  std::vector<Real> f(count), weight(4 * count), slope(4 * count);
  for (Real& x : f) x = coordinate(low, low + 1, samples);
  for (const Functions<Real>& functions : all_functions<Real>()) {
    functions.weights[stencil](f.data(), weight.data(), count);
    functions.slopes[stencil](f.data(), slope.data(), count);
    const std::string where = std::string(kStencilFigures[stencil].name) + ", " + functions.name;
    for (std::size_t k = 0; k < count; ++k) {
      long double sum[4] = {-1, 0, 0, -1};
      for (std::size_t i = 0; i < 4; ++i) {
        const long double w = weight[4 * k + i], d = slope[4 * k + i];
        const long double distance = static_cast<long double>(i) - static_cast<long double>(f[k]);
        sum[0] += w;
        sum[1] += w * distance;
        sum[2] += d;
        sum[3] += d * distance;
      }
      sums.weights.add(static_cast<double>(std::fabs(sum[0])) / kEps, where);
      sums.first_moment.add(static_cast<double>(std::fabs(sum[1])) / kEps, where);
      sums.slopes.add(static_cast<double>(std::fabs(sum[2])) / kEps, where);
      sums.first_moment_of_slopes.add(static_cast<double>(std::fabs(sum[3])) / kEps, where);
    }
  }
}

/// One particle of mass 1 on cells of 1 m.
template <class Real>
Particles<Real> lone_particle(const TransferCase& transfer, Samples& samples) {
  const StencilFigures& nodes = transfer.nodes();
  Particles<Real> particle(1);
  for (auto& channel : particle.position) {
    channel[0] = coordinate(static_cast<Real>(nodes.lowest_base + nodes.base_shift),
                            static_cast<Real>(nodes.highest_base + 1 + nodes.base_shift), samples);
  }
  for (auto* channels : {particle.velocity, particle.own}) {
    for (int k = 0; k < 3; ++k) channels[k][0] = 0;
  }
  for (auto& channel : particle.affine) channel[0] = 0;
  for (auto& channel : particle.stress) channel[0] = 0;
  return particle;
}

/// The same through the kernels: mass that a particle gives to nodes, and the gradient that it finds where all
/// of them have one velocity.
template <class Real>
void sums_of_transfers(Sums& sums, const TransferCase& transfer, std::size_t count, std::uint64_t seed) {
  constexpr double kEps = kEpsilon<Real>;
  Samples samples(seed);
  Arena<Real> uniform(kArenaValues, Real(0)), masses(kArenaValues);
  for (std::size_t k = 0; k < kArenaNodes * kNodeValues; ++k) uniform[k] = Real(1);
  for (std::size_t k = 0; k < count; ++k) {
    auto particle = lone_particle<Real>(transfer, samples);
    for (const Target target : supported_targets()) {
      const std::string where = transfer.name() + ", " + target_name(target);
      std::fill(masses.begin(), masses.end(), Real(0));
      std::uint64_t rows = 0;
      transfer.scatter<Real>(target)(particle.scatter_input(transfer), masses.data(), rows);
      long double sum = -1, moment[3] = {};
      for (int node = 0; node < 512; ++node) {
        const int place[3] = {node / 64, node / 8 % 8, node % 8};
        const long double w = masses[arena_place(place[0], place[1], place[2])];
        sum += w;
        for (int axis = 0; axis < 3; ++axis) {
          const long double x = particle.position[axis][0];
          moment[axis] += w * (place[axis] + transfer.origin() - x);
        }
      }
      sums.weights.add(static_cast<double>(std::fabs(sum)) / kEps, where);
      for (const long double m : moment) {
        sums.first_moment.add(static_cast<double>(std::fabs(m)) / kEps, where);
      }
      if (transfer.figures().force != Force::kGradients) continue;
      Gathered<Real> found(1);
      transfer.gather<Real>(target)(found.input(particle, transfer), uniform.data());
      for (const auto& entry : found.gradient) sums.slopes.add(std::fabs(double{entry[0]}) / kEps, where);
    }
  }
}

template <class Real>
void stencil_sums_of(Case& asked, std::size_t samples) {
  Sums axis, transfers;
  in_batches(samples, [&](std::size_t count, std::uint64_t seed) {
    for (std::size_t stencil = 0; stencil < kStencilFigures.size(); ++stencil) {
      sums_along_an_axis<Real>(axis, stencil, count, 14000 + seed);
    }
    for (TransferCase transfer : all_cases()) {
      if (transfer.measures) continue;
      transfer.mass = transfer.spacing = 1;
      transfer.impulse_volume = 0;
      sums_of_transfers<Real>(transfers, transfer, count / 32 + 1, 14500 + seed);
    }
  });
  axis.report(asked, std::string("an axis, ") + kPrecision<Real>);
  transfers.report(asked, std::string("particles and nodes, ") + kPrecision<Real>);
}

/// A crowd, and before it one particle that hardly reaches its outermost nodes: by 1e-5 of a cell and more.
template <class Real>
Particles<Real> lone_before_crowd(const TransferCase& transfer, std::uint64_t seed) {
  constexpr std::size_t kCrowd = 64;
  auto particles = random_particles<Real>(kCrowd + 1, Order::kScattered, seed, transfer.stencil);
  Samples samples(seed);
  const int lowest = transfer.nodes().lowest_base;
  for (int axis = 0; axis < 3; ++axis) {
    auto& x = particles.position[axis];
    const Real face = static_cast<Real>(lowest + transfer.nodes().base_shift);
    x[0] = face + static_cast<Real>(samples.power_of_ten(-5, -1));
    for (std::size_t p = 1; p <= kCrowd; ++p) x[p] = std::max(x[p], face + static_cast<Real>(4));
  }
  return particles;
}

struct LightNodes {
  Worst excess, excess_with_all;
  std::size_t light = 0;  ///< nodes of 1e-30 of the mean and less
};

std::size_t place_of(int x, int y, int z) {
  return static_cast<std::size_t>(((x + 4) * 12 + y + 4) * 12 + z + 4);
}

/// |v| of all nodes against the largest |v_p + C (x_i - x_p)| of the particles that reach them, in roundings of
/// the terms of that.
template <class Real>
void measure_light_nodes(LightNodes& figures, const TransferCase& transfer, Target target, std::uint64_t seed) {
  auto particles = lone_before_crowd<Real>(transfer, seed);
  std::vector<double> fastest(12 * 12 * 12, 0.0), terms = fastest;
  for (std::size_t p = 0; p < particles.count; ++p) {
    int base[3];
    for (int k = 0; k < 3; ++k) base[k] = reference::base_node(transfer.stencil, particles.position[k][p]);
    const int width = stencil_width(transfer.stencil);
    for (int n = 0; n < width * width * width; ++n) {
      const int node[3] = {base[0] + n / (width * width), base[1] + n / width % width, base[2] + n % width};
      double square = 0, squares_of_terms = 0;
      for (int row = 0; row < 3; ++row) {
        double v = particles.velocity[row][p], sum = std::fabs(v);
        for (int k = 0; k < 3 && transfer.keeps_affine(); ++k) {
          const double distance = (node[k] - double{particles.position[k][p]}) * transfer.spacing;
          v += particles.affine[3 * row + k][p] * distance;
          sum += std::fabs(particles.affine[3 * row + k][p] * distance);
        }
        square += v * v;
        squares_of_terms += sum * sum;
      }
      const std::size_t place = place_of(node[0], node[1], node[2]);
      fastest[place] = std::max(fastest[place], std::sqrt(square));
      terms[place] = std::max(terms[place], std::sqrt(squares_of_terms));
    }
  }
  Arena<Real> arena(kArenaValues, Real(0));
  std::uint64_t rows = 0;
  transfer.scatter<Real>(target)(particles.scatter_input(transfer), arena.data(), rows);
  // As the engine empties nodes, and with all whose mass is a normal number.
  const double engines = 1e-12 * transfer.mass;
  for (const double least_mass : {engines, 16.0 * std::numeric_limits<Real>::min()}) {
    NodeBlocks<Real> blocks;
    transfer.stencil_kernel<Real>(target).add_arena(arena.data(), rows, blocks.pointers);
    double mass = 0;
    std::size_t nodes = 0;
    for_each_node([&](int x, int y, int z) {
      mass += blocks.at(x, y, z)[0];
      nodes += blocks.at(x, y, z)[0] > 0 ? 1 : 0;
    });
    const double mean = mass / static_cast<double>(nodes);
    for (Real* block : blocks.pointers) {
      kernels<Real>(target).node.normalize(block, static_cast<Real>(least_mass));
    }
    Worst& excess = least_mass == engines ? figures.excess : figures.excess_with_all;
    for_each_node([&](int x, int y, int z) {
      const Real* node = blocks.at(x, y, z);
      if (!(node[0] > 0)) return;
      const double speed = std::hypot(double{node[1]}, double{node[2]}, double{node[3]});
      const std::size_t place = place_of(x, y, z);
      const double beyond = (speed - fastest[place]) / (kEpsilon<Real> * terms[place]);
      excess.add(beyond, transfer.name() + ", " + target_name(target));
      figures.light += node[0] <= 1e-30 * mean ? 1 : 0;
    });
  }
}

template <class Real>
void light_nodes_of(Case& asked, std::size_t samples) {
  LightNodes figures;
  for (TransferCase transfer : all_cases()) {
    if (transfer.measures || transfer.figures().affine == Affine::kSkew) continue;
    transfer.impulse_volume = 0;
    for (const Target target : supported_targets()) {
      for (std::size_t k = 0; k < samples; ++k) measure_light_nodes<Real>(figures, transfer, target, 22000 + k);
    }
  }
  const std::string precision = kPrecision<Real>;
  at_most(asked, "speed beyond that of particles, " + precision, figures.excess, 16, "eps");
  at_most(asked, "the same with no node emptied, " + precision, figures.excess_with_all, 16, "eps");
  asked.at_least("nodes of 1e-30 of the mean, " + precision, static_cast<double>(figures.light), 10);
}

}  // namespace

void stencil_sums(std::size_t samples) {
  Case asked(14, "weights and their slopes, on faces +- 1 ulp too");
  stencil_sums_of<float>(asked, samples);
  stencil_sums_of<double>(asked, samples);
}

void light_nodes(std::size_t samples) {
  Case asked(22, "nodes of hardly any mass");
  light_nodes_of<float>(asked, samples);
  light_nodes_of<double>(asked, samples);
}

}  // namespace repose::battery
