// Repose: see transfer.h.
#include "kernels/reference/transfer.h"

#include <array>
#include <cmath>

namespace repose::reference {
namespace {

static_assert(kStencilFigures.size() == 3, "weight() and slope() know the stencils quadratic, cubic, linear");
enum Spline : std::size_t { kQuadratic, kCubic, kLinear };
constexpr int kWidths[] = {3, 4, 2};

constexpr int kSymmetric[3][3] = {{0, 1, 2}, {1, 3, 4}, {2, 4, 5}};
using Matrix = std::array<std::array<double, 3>, 3>;

/// A node of a particle's stencil.
struct Neighbour {
  double weight;
  double gradient[3];       ///< of the weight, 1/m
  double distance[3];       ///< x_i - x_p, m
  std::size_t arena_place;  ///< of its first value
};

template <class Real, class Visit>
void for_each_node(std::size_t stencil, const ParticleSpan<Real>& particles, std::size_t p, int flat_axis,
                   double spacing, Visit visit) {
  const int width = kWidths[stencil];
  int base[3];
  double w[3][4], d[3][4], distance[3][4];
  for (int axis = 0; axis < 3; ++axis) {
    const double x = particles.position[axis][p];
    base[axis] = base_node(stencil, x);
    for (int k = 0; k < width; ++k) {
      const double cells = base[axis] + k - x;
      distance[axis][k] = cells * spacing;
      w[axis][k] = axis != flat_axis ? weight(stencil, cells) : k == 0 ? 1.0 : 0.0;
      d[axis][k] = axis != flat_axis ? slope(stencil, cells) / spacing : 0.0;
    }
  }
  const int origin = kStencilFigures[stencil].lowest_base;
  for (int i = 0; i < width; ++i) {
    for (int j = 0; j < width; ++j) {
      for (int k = 0; k < width; ++k) {
        const int row = (base[0] + i - origin) * kArenaSide + base[1] + j - origin;
        const int node = row * kArenaSide + base[2] + k - origin;
        visit(Neighbour{w[0][i] * w[1][j] * w[2][k],
                        {d[0][i] * w[1][j] * w[2][k], w[0][i] * d[1][j] * w[2][k], w[0][i] * w[1][j] * d[2][k]},
                        {distance[0][i], distance[1][j], distance[2][k]},
                        static_cast<std::size_t>(node * kNodeValues)});
      }
    }
  }
}

/// D^-1 of an axis, 1/m^2.
double inverse_d(std::size_t stencil, double spacing, bool flat) {
  return flat ? 0.0 : (stencil == kCubic ? 3.0 : 4.0) / (spacing * spacing);
}

/// A of particle p.
template <class Real>
Matrix p2g_affine(Affine affine, const ScatterInput<Real>& in, std::size_t p) {
  Matrix a{};
  if (affine == Affine::kNone) return a;
  const double kept = affine == Affine::kFull ? 1.0 : double{in.kept_stretching};
  for (int row = 0; row < 3; ++row) {
    for (int axis = 0; axis < 3; ++axis) {
      const double c = in.particles.affine[3 * row + axis][p],
                   transposed = in.particles.affine[3 * axis + row][p];
      a[row][axis] = (c - transposed) / 2 + kept * (c + transposed) / 2;
      // Across plane strain there is one node and no lever.
      if (affine == Affine::kSkew && axis == in.lattice.flat_axis) a[row][axis] = 0.0;
    }
  }
  return a;
}

/// Forces by moments ask for a D that is the same everywhere.
bool by_moments(std::size_t stencil, std::size_t transfer) {
  return stencil != kLinear && kTransferFigures[transfer].force == Force::kMoments;
}

}  // namespace

double weight(std::size_t stencil, double distance) {
  const double r = std::fabs(distance);
  switch (stencil) {
    case kQuadratic:
      if (r < 0.5) return 0.75 - r * r;
      return r < 1.5 ? (1.5 - r) * (1.5 - r) / 2 : 0.0;
    case kCubic:
      if (r < 1) return r * r * r / 2 - r * r + 2.0 / 3;
      return r < 2 ? (2 - r) * (2 - r) * (2 - r) / 6 : 0.0;
    default:
      return r < 1 ? 1 - r : 0.0;
  }
}

double slope(std::size_t stencil, double distance) {
  const double r = std::fabs(distance), toward = distance > 0 ? 1.0 : -1.0;  // r shrinks where x_p moves toward
  switch (stencil) {
    case kQuadratic:
      if (r < 0.5) return toward * 2 * r;
      return r < 1.5 ? toward * (1.5 - r) : 0.0;
    case kCubic:
      if (r < 1) return toward * (2 * r - 1.5 * r * r);
      return r < 2 ? toward * (2 - r) * (2 - r) / 2 : 0.0;
    default:
      return r <= 1 ? toward : 0.0;
  }
}

int base_node(std::size_t stencil, double position) {
  return static_cast<int>(std::floor(position - kStencilFigures[stencil].base_shift));
}

template <class Real>
void scatter(std::size_t stencil, std::size_t transfer, const ScatterInput<Real>& in, double* arena,
             double* before) {
  const double dx = in.lattice.spacing, m = in.mass, dt_v0 = in.impulse_volume;
  const bool moments = by_moments(stencil, transfer);
  for (std::size_t p = 0; p < in.particles.count; ++p) {
    const Matrix a = p2g_affine(kTransferFigures[transfer].affine, in, p);
    for_each_node(stencil, in.particles, p, in.lattice.flat_axis, dx, [&](const Neighbour& node) {
      arena[node.arena_place] += node.weight * m;
      if (before != nullptr) before[node.arena_place] += node.weight * m;
      for (int row = 0; row < 3; ++row) {
        double slope = 0, impulse = 0;
        for (int axis = 0; axis < 3; ++axis) {
          slope += a[row][axis] * node.distance[axis];
          const double along =
              moments ? inverse_d(stencil, dx, axis == in.lattice.flat_axis) * node.weight * node.distance[axis]
                      : node.gradient[axis];
          impulse -= dt_v0 * in.stress[kSymmetric[row][axis]][p] * along;
        }
        const std::size_t place = node.arena_place + 1 + static_cast<std::size_t>(row);
        arena[place] += node.weight * m * (in.particles.velocity[row][p] + slope) + impulse;
        if (before != nullptr) before[place] += node.weight * m * (in.own_velocity[row][p] + slope);
      }
    });
  }
}

namespace {

/// C - dt W W, W the skew part of C; across plane strain nothing turns.
Matrix turned(const Matrix& c, double dt, int flat_axis) {
  Matrix w{}, result = c;
  for (int row = 0; row < 3; ++row) {
    for (int axis = 0; axis < 3; ++axis) {
      if (row != flat_axis && axis != flat_axis) w[row][axis] = (c[row][axis] - c[axis][row]) / 2;
    }
  }
  for (int row = 0; row < 3; ++row) {
    for (int axis = 0; axis < 3; ++axis) {
      for (int k = 0; k < 3; ++k) result[row][axis] -= dt * w[row][k] * w[k][axis];
    }
  }
  return result;
}

}  // namespace

template <class Real>
void gather(std::size_t stencil, std::size_t transfer, const GatherInput<Real>& in, const Real* arena) {
  const double dx = in.lattice.spacing;
  const bool keeps_affine = kTransferFigures[transfer].affine != Affine::kNone;
  const bool keeps_velocity = kTransferFigures[transfer].keeps_velocity;
  for (std::size_t p = 0; p < in.particles.count; ++p) {
    double v[3] = {}, before[3] = {}, mass = 0;
    Matrix moment{}, gradient{};
    for_each_node(stencil, in.particles, p, in.lattice.flat_axis, dx, [&](const Neighbour& node) {
      mass += node.weight * arena[node.arena_place];
      for (int row = 0; row < 3; ++row) {
        const double nodal = arena[node.arena_place + 1 + row];
        v[row] += node.weight * nodal;
        if (in.before != nullptr) before[row] += node.weight * in.before[node.arena_place + 1 + row];
        for (int axis = 0; axis < 3; ++axis) {
          moment[row][axis] +=
              inverse_d(stencil, dx, axis == in.lattice.flat_axis) * node.weight * nodal * node.distance[axis];
          gradient[row][axis] += nodal * node.gradient[axis];
        }
      }
    });
    if (in.mass) in.mass[p] = static_cast<Real>(mass);
    const Matrix& slopes = stencil == kLinear ? gradient : moment;
    const Matrix c = keeps_velocity ? turned(slopes, double{in.dt}, in.lattice.flat_axis) : slopes;
    const Matrix& strains = by_moments(stencil, transfer) ? moment : gradient;
    for (int row = 0; row < 3; ++row) {
      if (in.moving[row]) in.moving[row][p] = static_cast<Real>(v[row]);
      if (!in.velocity[row]) continue;
      double kept = v[row];
      if (keeps_velocity) {
        double own = in.own[row][p];
        if (in.before != nullptr) own = double{in.particles.velocity[row][p]} - before[row];
        own *= in.kept_velocity;
        in.own[row][p] = static_cast<Real>(own);
        kept += own;
      }
      in.velocity[row][p] = static_cast<Real>(kept);
    }
    for (int k = 0; k < 9; ++k) {
      if (in.affine[k] && keeps_affine) in.affine[k][p] = static_cast<Real>(c[k / 3][k % 3]);
      if (in.gradient[k]) in.gradient[k][p] = static_cast<Real>(strains[k / 3][k % 3]);
    }
  }
}

#define REPOSE_FOR(Real)                                                                        \
  template void scatter(std::size_t, std::size_t, const ScatterInput<Real>&, double*, double*); \
  template void gather(std::size_t, std::size_t, const GatherInput<Real>&, const Real*);
REPOSE_FOR(float)
REPOSE_FOR(double)
#undef REPOSE_FOR

}  // namespace repose::reference
