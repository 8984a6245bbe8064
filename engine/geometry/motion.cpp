#include "engine/geometry/motion.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace repose {
namespace {

constexpr double kRadians = std::numbers::pi / 180.0;
constexpr double kSameLine = 1e-12;  // squared sine of the angle between two axes
constexpr double kSamePlace = 1e-9;  // m, and of the entries of a rotation

constexpr Choice kInterpolations[] = {
    {"linear", "constant speed from key to key"},
    {"smooth", "Catmull-Rom through the keys, at rest at both ends unless it repeats"},
};

bool same_line(const Vec3& a, const Vec3& b) {
  return a.normalized().cross(b.normalized()).squaredNorm() < kSameLine;
}

/// A key that does not turn has no axis to agree on.
bool share_axis(const MotionKey& a, const MotionKey& b) {
  return a.rotation_angle == 0.0 || b.rotation_angle == 0.0 || same_line(a.rotation_axis, b.rotation_axis);
}

struct Fault {
  const char* key = nullptr;  // null: there is none
  const char* message = "";
};

bool finite(const MotionKey& key) {
  const double length = key.rotation_axis.norm();
  return std::isfinite(key.time) && key.translation.allFinite() && std::isfinite(key.rotation_angle) &&
         std::isfinite(length) && length > 1e-12;
}

Fault find_fault(const MotionDescription& motion) {
  const auto& keys = motion.keys;
  if (keys.empty()) return {"keys", "needs at least one key, such as {\"time\": 0}"};
  if (!motion.pivot.allFinite()) return {"pivot", "must be finite"};
  for (std::size_t k = 0; k < keys.size(); ++k) {
    if (!finite(keys[k])) return {"keys", "must be finite numbers, and no rotation_axis zero"};
    if (keys[k].time < 0.0) return {"keys", "must not begin before time 0"};
    if (k > 0 && !(keys[k].time > keys[k - 1].time)) return {"keys", "must be in order of time, each later"};
  }
  if (!motion.repeat) return {};
  const MotionKey &first = keys.front(), &last = keys.back();
  if (!(last.time > 0.0)) return {"repeat", "needs a last key after time 0, which is the period"};
  const Mat3 turn = rotation_matrix(first.rotation_axis, first.rotation_angle) -
                    rotation_matrix(last.rotation_axis, last.rotation_angle);
  const double apart = (first.translation - last.translation).norm() + turn.norm();
  if (apart > kSamePlace)
    return {"repeat", "needs a last key that stands where the first does, or the solid would jump"};
  return {};
}

void describe_key(Fields& fields, MotionKey& key) {
  fields.number("time", key.time, {.unit = "s", .meaning = "when", .low = 0.0, .required = true});
  fields.vector("translation", key.translation,
                {.unit = "m", .meaning = "how far it is then from where its shape was placed"});
  fields.vector("rotation_axis", key.rotation_axis,
                {.meaning = "direction of the line through the pivot that it is turned about, of any length"});
  fields.number("rotation_angle", key.rotation_angle,
                {.unit = "degrees", .meaning = "turn, by the right hand; more than 360 are several turns"});
}

}  // namespace

void describe(Fields& fields, MotionDescription& motion) {
  fields.vector("pivot", motion.pivot,
                {.unit = "m", .meaning = "point that turns are about; the translation moves it along"});
  fields.choice("interpolation", motion.interpolation, kInterpolations, "how it goes from key to key");
  fields.flag("repeat", motion.repeat, "begin again whenever the time of the last key has passed");
  fields.list("keys", true, "where it stands at what times; it rests before the first and after the last",
              [&motion](Fields& f) {
                MotionKey key;
                describe_key(f, key);
                motion.keys.push_back(key);
              });
  const Fault fault = find_fault(motion);
  fields.check(fault.key == nullptr, fault.key == nullptr ? "keys" : fault.key, fault.message);
}

Result<std::shared_ptr<const RigidMotion>> RigidMotion::make(const MotionDescription& description) {
  const Fault fault = find_fault(description);
  if (fault.key != nullptr) return Error{ErrorKind::kBadScene, fault.message, fault.key};
  return std::shared_ptr<const RigidMotion>(new RigidMotion(description));
}

std::shared_ptr<RigidMotion> RigidMotion::led(const Vec3& pivot) {
  MotionDescription description;
  description.given = true;
  description.pivot = pivot;
  std::shared_ptr<RigidMotion> motion(new RigidMotion(description));
  motion->lead_.emplace();
  return motion;
}

void RigidMotion::lead(double time, double seconds, const Placement& to) {
  Lead next{time, time + seconds, pose(time), to};
  if (seconds > 0.0) {
    next.speed = (to.point(description_.pivot) - next.from.point(description_.pivot)).norm() / seconds;
    next.spin =
        Eigen::Quaterniond(next.from.rotation).angularDistance(Eigen::Quaterniond(to.rotation)) / seconds;
  } else {
    next.from = to;
  }
  lead_ = next;
}

Placement RigidMotion::between(const Lead& lead, double time) const {
  if (time <= lead.begin || time >= lead.end) return time >= lead.end ? lead.to : lead.from;
  const double u = (time - lead.begin) / (lead.end - lead.begin);
  const Vec3 from = lead.from.point(description_.pivot), to = lead.to.point(description_.pivot);
  const Mat3 rotation = lead.spin == 0.0 ? lead.to.rotation
                                         : Eigen::Quaterniond(lead.from.rotation)
                                               .slerp(u, Eigen::Quaterniond(lead.to.rotation))
                                               .toRotationMatrix();
  return {rotation, from + u * (to - from) - rotation * description_.pivot};
}

RigidMotion::RigidMotion(const MotionDescription& description) : description_(description) {
  const auto& keys = description_.keys;
  Vec3 axis = Vec3::Zero();
  bool one_axis = true;
  for (const MotionKey& key : keys) {
    if (axis.isZero(0) && key.rotation_angle != 0.0) axis = key.rotation_axis;
    one_axis = one_axis && (axis.isZero(0) || key.rotation_angle == 0.0 || same_line(axis, key.rotation_axis));
  }
  for (const MotionKey& key : keys) {
    const double sign = one_axis && key.rotation_axis.dot(axis) < 0.0 ? -1.0 : 1.0;
    values_.emplace_back(key.translation[0], key.translation[1], key.translation[2], sign * key.rotation_angle);
  }
  for (std::size_t k = 0; k + 1 < keys.size(); ++k) {
    Stretch next = stretch(k, one_axis);
    if (one_axis && !axis.isZero(0)) next.axis = axis;
    stretches_.push_back(next);
  }
}

/// Catmull-Rom's rate at a key: the slope between its neighbours. The ends of what does not repeat are at rest.
RigidMotion::Vec4 RigidMotion::rate(std::size_t k, bool one_axis) const {
  const auto& keys = description_.keys;
  const std::size_t last = keys.size() - 1;
  Vec4 rate = Vec4::Zero();
  if (k > 0 && k < last) {
    rate = (values_[k + 1] - values_[k - 1]) / (keys[k + 1].time - keys[k - 1].time);
  } else if (description_.repeat && keys.front().time == 0.0) {
    rate = (values_[1] - values_[0] + values_[last] - values_[last - 1]) /
           (keys[1].time - keys[0].time + keys[last].time - keys[last - 1].time);
  }
  if (!one_axis) rate[3] = 0.0;  // angles about several lines do not add up
  return rate;
}

RigidMotion::Stretch RigidMotion::stretch(std::size_t k, bool one_axis) const {
  const MotionKey &a = description_.keys[k], &b = description_.keys[k + 1];
  const double length = b.time - a.time;
  Stretch s{a.time, b.time, values_[k], values_[k + 1], Vec4(), Vec4(), a.rotation_axis, !share_axis(a, b),
            0,      0};
  if (a.rotation_angle == 0.0) s.axis = b.rotation_axis;
  if (!one_axis && !s.slerp && s.axis.dot(b.rotation_axis) < 0.0) s.to[3] = -s.to[3];
  const Vec4 mean = (s.to - s.from) / length;
  const bool smooth = description_.interpolation == MotionDescription::Interpolation::kSmooth;
  s.leaving = smooth ? rate(k, one_axis) : mean;
  s.arriving = smooth ? rate(k + 1, one_axis) : mean;
  if (!one_axis) s.leaving[3] = s.arriving[3] = mean[3];
  // The rate of a cubic is a parabola within the hull of these three (its Bezier points).
  for (const Vec4& hull : {s.leaving, s.arriving, Vec4(3.0 * mean - s.leaving - s.arriving)}) {
    s.speed = std::max(s.speed, hull.head<3>().norm());
    s.spin = std::max(s.spin, kRadians * std::abs(hull[3]));
  }
  if (s.slerp) {
    const Eigen::Quaterniond from(rotation_matrix(a.rotation_axis, a.rotation_angle)),
        to(rotation_matrix(b.rotation_axis, b.rotation_angle));
    s.spin = from.angularDistance(to) / length;
  }
  return s;
}

Placement RigidMotion::placed(const Mat3& rotation, const Vec3& translation) const {
  return {rotation, description_.pivot - rotation * description_.pivot + translation};
}

Placement RigidMotion::at(const Stretch& s, double time) const {
  const double length = s.end - s.begin, u = (time - s.begin) / length, rest = 1.0 - u;
  // Hermite's cubic as a straight line and what the rates at its ends depart from it.
  const Vec4 mean = (s.to - s.from) / length;
  const Vec4 value =
      s.from + u * (s.to - s.from) + u * rest * length * (rest * (s.leaving - mean) - u * (s.arriving - mean));
  const Vec3 translation = value.head<3>();
  if (s.slerp) {
    const auto turn = [&](const MotionKey& key) {
      return Eigen::Quaterniond(rotation_matrix(key.rotation_axis, key.rotation_angle));
    };
    const auto k = static_cast<std::size_t>(&s - stretches_.data());
    const Eigen::Quaterniond between = turn(description_.keys[k]).slerp(u, turn(description_.keys[k + 1]));
    return placed(between.toRotationMatrix(), translation);
  }
  // Without a turn nothing is rounded: a motion of zeros is rest, bit for bit.
  if (value[3] == 0.0) return {Mat3::Identity(), translation};
  return placed(rotation_matrix(s.axis, value[3]), translation);
}

Placement RigidMotion::pose(double time) const {
  if (lead_) return between(*lead_, time);
  const auto& keys = description_.keys;
  if (description_.repeat) time = std::fmod(time, keys.back().time);
  if (time <= keys.front().time || time >= keys.back().time) {
    const MotionKey& key = time <= keys.front().time ? keys.front() : keys.back();
    if (key.rotation_angle == 0.0) return {Mat3::Identity(), key.translation};
    return placed(rotation_matrix(key.rotation_axis, key.rotation_angle), key.translation);
  }
  const auto next = std::upper_bound(stretches_.begin(), stretches_.end(), time,
                                     [](double t, const Stretch& s) { return t < s.end; });
  return at(*next, time);
}

double RigidMotion::fastest_of_keys(double from, double to, double radius) const {
  double most = 0.0;
  for (const Stretch& s : stretches_) {
    if (s.begin < to && s.end > from) most = std::max(most, s.speed + s.spin * radius);
  }
  return most;
}

double RigidMotion::fastest(double from, double to, double radius) const {
  if (lead_) return lead_->begin < to && lead_->end > from ? lead_->speed + lead_->spin * radius : 0.0;
  if (!description_.repeat) return fastest_of_keys(from, to, radius);
  const double period = description_.keys.back().time;
  const double begin = std::fmod(from, period), end = begin + (to - from);
  return std::max(fastest_of_keys(begin, end, radius), fastest_of_keys(0.0, end - period, radius));
}

}  // namespace repose
