// Repose tests: what the physics tests share: scenes from text, runs to a time, and how a heap of particles is
// measured. Measures work on volumes per ring or column, not on extreme particles: a single stray grain must
// not move a front, and a single hole must not break a surface.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "engine/base/vector.h"
#include "engine/reading/reader.h"
#include "engine/scene/scene.h"
#include "engine/simulation/simulation.h"

namespace repose {

/// Of a vector, in shares of what it was.
inline double change(const Triple& before, const Triple& after) {
  return (to_vec3(after) - to_vec3(before)).norm() / to_vec3(before).norm();
}

/// A scene from text, or from a file of apps/scenes; a scene that is wrong throws, which fails the test.
Scene scene_of(const std::string& text, const std::vector<std::string>& overrides = {});
Scene scene_file(const std::string& file, const std::vector<std::string>& overrides = {});

/// A simulation that must start.
std::unique_ptr<Simulation> simulate(const Scene& scene, int threads = 2, Target target = best_target());

/// `steps` steps, whole frames, or as many steps as lead to `time` (s); one that is refused fails the test.
/// False then.
bool run_steps(Simulation& simulation, int steps);
bool run_frames(Simulation& simulation, int frames);
bool run_until(Simulation& simulation, double time);

/// What a probe told of the last frame; not a number, and the test fails, where it tells no such quantity.
double measured(const Simulation& simulation, const std::string& probe, const std::string& quantity);

/// Prints a figure of merit and keeps it in the test's report.
void report(const std::string& name, double value, const std::string& unit = "");

/// Sums of particle volume (V0), by where the particles are.
struct Bins {
  std::vector<double> volume;  ///< m^3 per bin
  double width = 0.0;          ///< m
};
/// Per ring about the y axis.
Bins rings(const PointCloud& points, double particle_volume, double width);
/// Per slab across x, from x = 0.
Bins slabs(const PointCloud& points, double particle_volume, double width);

/// Radius of the front of a heap about the y axis: the far side of the outermost column of cells (dx wide) that
/// is still covered by a cell of material at half of the seeded density. Only columns that hang together with
/// the one at the axis count, so that strays do not.
double front_radius(const PointCloud& points, double particle_volume, double spacing);
/// The same by rings: the end of the outermost ring whose mean cover, with its neighbours', is half a cell.
/// Smaller, since a front is never a circle.
double front_ring(const PointCloud& points, double particle_volume, double spacing);
/// The same along x for a slab one cell thick.
double front_length(const PointCloud& points, double particle_volume, double spacing);

/// Slope in degrees of the surface of a heap about the y axis: a line by least squares through the heights
/// (volume over area, at seeded density) of the rings between the radii `from` and `to`.
double slope_degrees(const PointCloud& points, double particle_volume, double spacing, double from, double to);

/// V0 of the scene's first body, m^3; all particles are taken to be alike.
double particle_volume(const Scene& scene, Simulation& simulation);

}  // namespace repose
