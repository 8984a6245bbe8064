// Repose: how a rigid solid moves: keyframes of a turn about a pivot and a translation. The pose is a pure
// function of time, so a state needs to remember nothing of it and a run goes on from any moment. Or a host
// leads it, pose by pose: then the host remembers.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "engine/base/params.h"
#include "engine/base/result.h"
#include "engine/geometry/placement.h"

namespace repose {

struct MotionKey {
  double time = 0.0;            ///< s
  Vec3 translation{0, 0, 0};    ///< m, from where the shape was placed
  Vec3 rotation_axis{0, 1, 0};  ///< of any length but zero
  double rotation_angle = 0.0;  ///< degrees, by the right hand; several turns count as such
};

/// What a scene says of a motion (data only).
struct MotionDescription {
  enum class Interpolation {
    kLinear,  ///< constant speed from key to key
    kSmooth,  ///< Catmull-Rom
  };
  bool given = false;
  Vec3 pivot{0, 0, 0};  ///< m; turns are about lines through it, and it is moved by the translation
  std::vector<MotionKey> keys;
  Interpolation interpolation = Interpolation::kLinear;
  bool repeat = false;  ///< the time of the last key is a period
};

/// Declares the scene keys of a motion.
void describe(Fields& fields, MotionDescription& motion);

/// A velocity of every point x: velocity + spin x (x - center).
struct Drive {
  Vec3 velocity{0, 0, 0};  ///< m/s, at the centre
  Vec3 spin{0, 0, 0};      ///< rad/s
  Vec3 center{0, 0, 0};    ///< m

  Vec3 at(const Vec3& x) const { return velocity + spin.cross(x - center); }
};

/// Interpolates keys; rests before the first and after the last. Immutable, so it may be asked from many
/// threads. Where all keys turn about one line, angles are interpolated as the translation is and may exceed a
/// full turn; a stretch between two lines is a slerp, the short way.
class RigidMotion {
 public:
  /// Errors: 65, keys that are not finite, not in order of time, or that would let a period jump.
  static Result<std::shared_ptr<const RigidMotion>> make(const MotionDescription& description);

  /// One that a host leads, turned about `pivot`: where its shape was placed, until lead() is called.
  static std::shared_ptr<RigidMotion> led(const Vec3& pivot);
  /// Of one that is led, while nothing else asks: it goes straight from where it stands at `time` (s) to a
  /// pose, the pivot along a line and at constant rates, within `seconds`; with none it stands there at once.
  void lead(double time, double seconds, const Placement& to);
  bool is_led() const { return lead_.has_value(); }
  /// Of one that is led, likewise: its surface moves so, whatever its poses come to; without one by its poses.
  void drive(const std::optional<Drive>& drive) { drive_ = drive; }
  const std::optional<Drive>& driven() const { return drive_; }

  /// Where the solid stands at a time (s): x -> rotation (x - pivot) + pivot + translation.
  Placement pose(double time) const;

  /// No point of the solid within `radius` (m) of the pivot is faster, in m/s, between two times (s).
  double fastest(double from, double to, double radius) const;

  const Vec3& pivot() const { return description_.pivot; }

 private:
  using Vec4 = Eigen::Vector4d;  // translation in m, angle in degrees

  /// From one key to the next.
  struct Stretch {
    double begin, end;       // s
    Vec4 from, to;           // the ends
    Vec4 leaving, arriving;  // rates there, per second
    Vec3 axis;               // where `slerp` is not set
    bool slerp;
    double speed, spin;  // bounds of the rates: m/s, rad/s
  };

  /// From one pose of a host to the next.
  struct Lead {
    double begin = 0.0, end = 0.0;  // s
    Placement from, to;
    double speed = 0.0, spin = 0.0;  // of the pivot, m/s, and about it, rad/s
  };

  explicit RigidMotion(const MotionDescription& description);
  Placement between(const Lead& lead, double time) const;
  Stretch stretch(std::size_t k, bool one_axis) const;
  Vec4 rate(std::size_t k, bool one_axis) const;
  Placement at(const Stretch& stretch, double time) const;
  Placement placed(const Mat3& rotation, const Vec3& translation) const;
  double fastest_of_keys(double from, double to, double radius) const;

  MotionDescription description_;
  std::vector<Vec4> values_;  // per key, with angles about one direction of the line where there is one
  std::vector<Stretch> stretches_;
  std::optional<Lead> lead_;
  std::optional<Drive> drive_;
};

}  // namespace repose
