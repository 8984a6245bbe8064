// Repose: what figures of merit are read from: where the particles of a run began and ended, and what was told
// of it at its start and after each frame. Plain numbers, so that a figure can be tried on an input worked out
// by hand.
#pragma once

#include <string>
#include <vector>

#include "engine/base/triple.h"
#include "engine/io/point_cloud.h"
#include "engine/plan/report.h"

namespace repose {

/// The state at one time, in sums.
struct RunMoment {
  double time = 0.0;                                                   ///< s
  double mass = 0.0;                                                   ///< kg
  Triple center_of_mass{}, momentum{};                                 ///< m; kg m/s
  double kinetic = 0.0, affine = 0.0, elastic = 0.0, potential = 0.0;  ///< J
  std::vector<Measurement> measured;  ///< by probes, over the frame that ends here
};

struct RunRecord {
  double spacing = 0.0;  ///< dx, m
  int up = 1;            ///< axis
  int flat = -1;         ///< axis of plane strain; -1: none
  Triple period{};       ///< m, after which an axis repeats; 0: never
  PointCloud start, end;
  std::vector<Triple> expected;    ///< where an exact motion has the particles of the end; empty: none is known
  std::vector<RunMoment> moments;  ///< the first is the start
};

/// V0 of a particle, m^3, as its radius tells it: half of the volume is a ball.
double particle_volume(const PointCloud& points, std::size_t p);

}  // namespace repose
