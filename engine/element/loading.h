// Repose: paths along which an element is driven: the tests of a soil laboratory, and paths from files. Log
// strains are without a unit, stresses in Pa; z is the axis of the specimen, x the direction of shear.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/element/element.h"

namespace repose {

struct PathStep {
  Mat3 gradient = Mat3::Zero();  ///< dt L, but for what a servo finds
  double dt = 0.0;               ///< s
  std::string where{};           ///< for messages: "path.csv:7"
};

/// Holds one normal stress at what it was when the path began, by stretches that nobody prescribes.
struct Servo {
  std::array<bool, 3> stretched;  ///< which axes stretch, by the same factor in each step
  int axis;                       ///< whose normal stress is held
};

struct Path {
  double pressure = 0.0;  ///< Pa: all around, before the path begins; 0: from rest
  std::vector<PathStep> steps;
  std::optional<Servo> servo{};
};

/// How far, in how many steps and how fast.
struct PathLength {
  double strain;  ///< log strain of the axis, or the slope of shear; above 0
  int steps;
  double rate;  ///< of that strain, 1/s; what a material that knows no rate does not feel
};

/// The axis is compressed, or stretched, under a constant pressure from the sides.
Path triaxial_path(double pressure, const PathLength& length, bool extension);
/// The axis is compressed, the sides are held.
Path oedometric_path(double pressure, const PathLength& length);
/// Shear dv_x/dz under a constant stress across its planes, or at constant volume.
Path simple_shear_path(double pressure, const PathLength& length, bool constant_volume);

/// A path from a CSV file, a row for each step, without a servo. The first line names columns, each with its
/// unit:
///   "dt [s]" and any of "L_xx [1/s]" ... "L_zz [1/s]", gradients of velocity, F <- (I + dt L) F; or
///   any of "de_xx", "de_yy", "de_zz", "de_xy", "de_yz", "de_xz", increments of log strain (tensor components),
///   F <- exp(de) F, with "dt [s]", or else |de| / rate;
/// what is not named is 0. "repeat" has a row made so many times. Lines that begin with # are left out. Errors:
/// 66 there is no file; 65 by file, line and column.
Result<Path> read_path(const std::string& file, double pressure, double rate);

/// Drives an element along a path: the state at its begin, and after each step. Errors: 65 a step turns the
/// element inside out; 70 no stretch holds the stress that a servo is to hold.
Result<std::vector<ElementState>> drive(Element& element, const Path& path);

}  // namespace repose
