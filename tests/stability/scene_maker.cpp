#include "tests/stability/scene_maker.h"

#include <json/value.h>
#include <json/writer.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <random>
#include <sstream>
#include <vector>

namespace repose::stability {
namespace {

using Triple = std::array<double, 3>;

class Dice {
 public:
  Dice(std::uint64_t seed, std::uint64_t number) : engine_(seed * 1000003u + number) { engine_.discard(16); }

  double between(double low, double high) {
    return low + (high - low) * static_cast<double>(engine_() >> 11) * 0x1p-53;
  }
  /// Even in the logarithm.
  double scale(double low, double high) { return std::exp(between(std::log(low), std::log(high))); }
  bool chance(double share) { return between(0.0, 1.0) < share; }
  int below(int count) { return std::min(count - 1, static_cast<int>(between(0.0, count))); }
  int from(int low, int high) { return low + below(high - low + 1); }
  template <class T>
  T one_of(std::initializer_list<T> list) {
    return *(list.begin() + below(static_cast<int>(list.size())));
  }
  Triple direction() {
    for (;;) {
      const Triple v{between(-1, 1), between(-1, 1), between(-1, 1)};
      const double square = v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
      if (square > 0.01 && square < 1.0) return times(v, 1.0 / std::sqrt(square));
    }
  }
  static Triple times(Triple v, double factor) {
    for (double& x : v) x *= factor;
    return v;
  }

 private:
  std::mt19937_64 engine_;
};

Json::Value list_of(const Triple& v) {
  Json::Value list(Json::arrayValue);
  for (const double x : v) list.append(x);
  return list;
}

class Maker {
 public:
  Maker(std::uint64_t seed, std::uint64_t number, const SceneSize& size) : dice_(seed, number), size_(size) {}

  MadeScene make() {
    scene_["repose"] = 1;
    scene_["name"] = "random";
    cells_ = dice_.from(4, size_.most_cells);
    length_ = dice_.scale(1e-3, 1e4);
    dx_ = length_ / cells_;
    materials();
    grid();
    gravity();
    bodies();
    colliders();
    if (dice_.chance(0.3)) emitter();
    if (dice_.chance(0.3)) sink();
    time();
    scene_["probes"][0]["name"] = "energies";
    scene_["probes"][0]["type"] = "energy";
    const bool spoilt = dice_.chance(0.25);
    if (spoilt) spoil();
    Json::StreamWriterBuilder writer;
    writer["precision"] = 17;
    writer["indentation"] = " ";
    return {Json::writeString(writer, scene_), spoilt};
  }

 private:
  void materials() {
    const int count = dice_.from(1, 2);
    for (int k = 0; k < count; ++k) {
      Json::Value& material = scene_["materials"]["m" + std::to_string(k)];
      const std::string type = dice_.one_of<const char*>({"drucker_prager", "elastic", "neo_hookean"});
      const double density = dice_.scale(10, 2e4), stiffness = dice_.scale(1e1, 1e10),
                   ratio = dice_.chance(0.1) ? dice_.one_of({0.0, 0.49, 0.499}) : dice_.between(0.0, 0.45);
      material["type"] = type;
      material["density"] = density;
      material["youngs_modulus"] = stiffness;
      material["poisson_ratio"] = ratio;
      if (type == "drucker_prager")
        material["friction_angle"] = dice_.between(0.0, dice_.chance(0.1) ? 89.0 : 50.0);
      const double wave =
          std::sqrt(stiffness * (1.0 - ratio) / (density * (1.0 + ratio) * (1.0 - 2.0 * ratio)));
      fastest_wave_ = std::max(fastest_wave_, wave);
    }
  }

  void grid() {
    Json::Value& grid = scene_["grid"];
    grid["spacing"] = dx_;
    if (dice_.chance(0.5)) grid["precision"] = "double";
    grid["stencil"] =
        dice_.one_of<const char*>({"quadratic", "quadratic", "quadratic", "cubic", "cubic", "linear"});
    const std::string transfer =
        dice_.one_of<const char*>({"mls_apic", "mls_apic", "apic", "rpic", "pic", "flip", "aflip"});
    grid["transfer"] = transfer;
    const bool flips = transfer == "flip" || transfer == "aflip";
    if (flips && dice_.chance(0.5)) grid["velocity_loss"] = dice_.one_of({0.0, 1.0, 100.0});
    if (flips && dice_.chance(0.3)) grid["kept_velocity"] = dice_.between(0.0, 1.0);
    if (transfer == "rpic" && dice_.chance(0.5)) grid["kept_stretching"] = dice_.between(0.0, 1.0);
    if (dice_.chance(0.2)) grid["advection"] = "before_friction";
    if (dice_.chance(0.25)) {
      for (int axis = 0; axis < 3; ++axis) grid["origin_cells"].append(8 * dice_.from(-100000, 100000));
    }
    if (dice_.chance(0.25)) {
      flat_ = dice_.below(3);
      grid["plane_strain"] = kAxes[flat_];
    }
    if (dice_.chance(0.2)) {
      repeating_ = dice_.below(3);
      if (repeating_ == flat_) repeating_ = -1;
    }
    if (repeating_ < 0) return;
    const int blocks = (cells_ + 7) / 8;
    grid["periodic"][kAxes[repeating_]]["lower"] = 8 * dx_ * dice_.from(-1, 0);
    grid["periodic"][kAxes[repeating_]]["length"] = 8 * dx_ * blocks;
  }

  void gravity() {
    Triple g{0, -9.81, 0};
    if (dice_.chance(0.3)) g = Dice::times(dice_.direction(), dice_.scale(0.1, 1e3));
    if (flat_ >= 0) g[static_cast<std::size_t>(flat_)] = 0.0;
    if (repeating_ >= 0) g[static_cast<std::size_t>(repeating_)] = 0.0;
    if (dice_.chance(0.2)) g = {0, 0, 0};
    scene_["gravity"]["acceleration"] = list_of(g);
    pull_ = std::sqrt(g[0] * g[0] + g[1] * g[1] + g[2] * g[2]);
  }

  Triple point() {
    return {length_ * dice_.between(0, 1), length_ * dice_.between(0, 1), length_ * dice_.between(0, 1)};
  }

  Json::Value solid(double least, double most) {
    Json::Value shape;
    const double size = length_ * dice_.between(least, most);
    Triple middle = point();
    // In plane strain a section at 0 must have an exact area; a few scenes leave that to the reader.
    const bool section = flat_ >= 0 && !dice_.chance(0.05);
    const auto flat = static_cast<std::size_t>(std::max(0, flat_));
    if (section) middle[flat] = 0.0;
    const std::string type = dice_.one_of<const char*>({"box", "box", "sphere", "cylinder"});
    shape["type"] = type;
    if (type == "box") {
      Triple lower = middle, upper = middle;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double half = 0.5 * size * dice_.between(0.4, 1.0);
        lower[axis] -= half;
        upper[axis] += half;
      }
      shape["lower"] = list_of(lower);
      shape["upper"] = list_of(upper);
    } else {
      shape["center"] = list_of(middle);
      shape["radius"] = 0.5 * size;
    }
    if (type == "cylinder") {
      Triple axis = dice_.direction();
      if (section) axis = {flat == 0 ? 1.0 : 0.0, flat == 1 ? 1.0 : 0.0, flat == 2 ? 1.0 : 0.0};
      if (section) middle[flat] = -0.5 * size;
      shape["center"] = list_of(middle);
      shape["axis"] = list_of(axis);
      shape["height"] = size;
    }
    if (!section && dice_.chance(0.2)) {
      shape["rotation_axis"] = list_of(dice_.direction());
      shape["rotation_angle"] = dice_.between(-180, 180);
    }
    return shape;
  }

  double speed() {
    const double fall = std::sqrt(pull_ * length_), wave = fastest_wave_;
    return dice_.chance(0.5) ? 0.0 : dice_.between(0.0, 2.0) * (dice_.chance(0.5) ? fall : 0.1 * wave);
  }
  Triple in_plane(Triple v) const {
    if (flat_ >= 0) v[static_cast<std::size_t>(flat_)] = 0.0;
    return v;
  }
  std::string material() {
    return "m" + std::to_string(dice_.below(static_cast<int>(scene_["materials"].size())));
  }

  void bodies() {
    const int count = dice_.chance(0.1) ? 0 : dice_.from(1, 2);
    scene_["bodies"] = Json::Value(Json::arrayValue);
    for (int k = 0; k < count; ++k) {
      Json::Value body;
      body["name"] = "b" + std::to_string(k);
      body["material"] = material();
      body["shape"] = solid(0.3, 1.0);
      body["particles_per_cell"] = dice_.one_of({1, 2, 4, 4, 8});
      if (dice_.chance(0.2)) body["sampling"] = "poisson_disk";
      body["seed"] = dice_.from(0, 1000);
      body["velocity"] = list_of(in_plane(Dice::times(dice_.direction(), speed())));
      if (dice_.chance(0.2)) {
        Triple spin = Dice::times(dice_.direction(), 2.0 * speed() / length_);
        if (flat_ >= 0) {
          for (int axis = 0; axis < 3; ++axis)
            spin[static_cast<std::size_t>(axis)] *= axis == flat_ ? 1.0 : 0.0;
        }
        body["angular_velocity"] = list_of(spin);
      }
      scene_["bodies"].append(body);
    }
  }

  Json::Value contact_of(const std::string& name) {
    Json::Value collider;
    collider["name"] = name;
    collider["contact"] = dice_.one_of<const char*>({"sticky", "slip", "separating", "separating"});
    collider["friction"] = dice_.one_of({0.0, 0.3, 1.0, 100.0});
    return collider;
  }

  void colliders() {
    if (dice_.chance(0.7)) {
      Json::Value floor = contact_of("floor");
      floor["shape"]["type"] = "plane";
      floor["shape"]["point"] = list_of({0, -0.1 * length_ * dice_.between(0, 1), 0});
      scene_["colliders"].append(floor);
    }
    if (dice_.chance(0.3)) {
      Json::Value room = contact_of("room");
      room["hollow"] = true;
      room["shape"]["type"] = "box";
      const double margin = dx_ * dice_.between(-1.0, 3.0);
      room["shape"]["lower"] = list_of({-margin, -margin, -margin});
      room["shape"]["upper"] = list_of({length_ + margin, length_ + margin, length_ + margin});
      scene_["colliders"].append(room);
    }
    const int more = dice_.chance(0.5) ? dice_.from(1, 3) : 0;
    for (int k = 0; k < more; ++k) {
      Json::Value collider = contact_of("c" + std::to_string(k));
      collider["shape"] = solid(2.5 / cells_, 0.5);
      if (dice_.chance(0.5)) collider["motion"] = motion();
      scene_["colliders"].append(collider);
    }
  }

  double frame() const { return 0.5 * dx_ / fastest_wave_ * size_.steps_a_frame; }

  Json::Value motion() {
    Json::Value motion;
    const double way = std::min(speed() * frame(), 3.0 * dx_);
    Triple at{0, 0, 0};
    double angle = 0.0;
    for (int k = 0; k < 3; ++k) {
      Json::Value key;
      key["time"] = k * frame() * dice_.between(0.9, 1.0);
      key["translation"] = list_of(at);
      if (flat_ < 0) key["rotation_axis"] = list_of({0, 1, 0});
      if (flat_ < 0) key["rotation_angle"] = angle;
      const Triple step = in_plane(Dice::times(dice_.direction(), way));
      for (std::size_t axis = 0; axis < 3; ++axis) at[axis] += step[axis];
      angle += dice_.chance(0.5) ? dice_.between(-20, 20) : 0.0;
      motion["keys"].append(key);
    }
    if (dice_.chance(0.3)) motion["interpolation"] = "smooth";
    motion["pivot"] = list_of(point());
    return motion;
  }

  void emitter() {
    Json::Value emitter;
    emitter["name"] = "spout";
    emitter["material"] = material();
    const std::string type = dice_.one_of<const char*>({"disc", "rectangle", "volume"});
    emitter["type"] = type;
    const double pace = dice_.between(0.05, 0.5) * dx_ * size_.steps_a_frame / frame() * 0.5;
    if (type == "volume") {
      emitter["shape"] = solid(0.2, 0.4);
      emitter["rate"] = dice_.between(1.0, 20.0) * dx_ * dx_ * dx_ / frame();
      emitter["velocity"] = list_of(in_plane(Dice::times(dice_.direction(), pace)));
    } else {
      emitter["center"] = list_of(point());
      emitter["normal"] = list_of(in_plane(dice_.direction()));
      emitter["speed"] = pace;
    }
    if (type == "disc") emitter["radius"] = length_ * dice_.between(0.05, 0.2);
    if (type == "rectangle") {
      emitter["half_width"] = length_ * dice_.between(0.05, 0.2);
      emitter["half_depth"] = length_ * dice_.between(0.05, 0.2);
      if (flat_ >= 0)
        emitter["direction"] =
            list_of(Triple{flat_ == 0 ? 1.0 : 0, flat_ == 1 ? 1.0 : 0, flat_ == 2 ? 1.0 : 0});
    }
    emitter["particles_per_cell"] = dice_.one_of({1, 4, 8});
    if (dice_.chance(0.3)) emitter["spread"] = dice_.between(0.0, 0.3);
    if (dice_.chance(0.3)) emitter["start"] = frame() * dice_.between(0.0, 1.0);
    scene_["emitters"].append(emitter);
  }

  void sink() {
    Json::Value sink;
    sink["name"] = "drain";
    sink["shape"] = solid(0.3, 2.0);
    sink["outside"] = dice_.chance(0.5);
    scene_["sinks"].append(sink);
  }

  void time() {
    Json::Value& time = scene_["time"];
    time["frames"] = size_.frames;
    const double roll = dice_.between(0, 1);
    const bool implicit = roll < 0.3;
    const double stretch = implicit ? dice_.scale(1.0, 100.0) : 1.0;
    time["frames_per_second"] = 1.0 / (frame() * stretch);
    if (implicit) {
      time["integrator"] = "implicit";
      time["max_step"] = frame() * stretch / dice_.from(2, 8);
      scene_["implicit"]["mode"] =
          dice_.one_of<const char*>({"exact", "exact", "projected", "lagged", "unilateral"});
    } else if (roll < 0.35) {
      time["integrator"] = "auto";
    }
    if (dice_.chance(0.2)) time["energy_alarm"] = dice_.one_of<const char*>({"off", "stop"});
    if (!dice_.chance(0.5)) return;
    for (const char* key : {"cfl", "sound", "isolated", "strain"}) {
      if (dice_.chance(0.6)) time[key] = dice_.between(0.2, 1.0);
    }
  }

  /// Every value of the scene that is no list and no object: numbers alone, or all.
  static void leaves(Json::Value& value, bool numbers, std::vector<Json::Value*>& all) {
    if (value.isObject() || value.isArray()) {
      for (Json::Value& child : value) leaves(child, numbers, all);
    } else if (!numbers || value.isNumeric()) {
      all.push_back(&value);
    }
  }

  /// One value or key, or two, become what they should not be; numbers mostly, and often such that they pass.
  void spoil() {
    const int faults = dice_.from(1, 2);
    for (int k = 0; k < faults; ++k) {
      if (dice_.chance(0.15)) {
        const auto keys = scene_.getMemberNames();
        const std::string key = keys[static_cast<std::size_t>(dice_.below(static_cast<int>(keys.size())))];
        if (dice_.chance(0.5)) scene_[key + "x"] = scene_[key];
        scene_.removeMember(key);
        continue;
      }
      const bool number = dice_.chance(0.85);
      std::vector<Json::Value*> all;
      leaves(scene_, number, all);
      Json::Value& leaf = *all[static_cast<std::size_t>(dice_.below(static_cast<int>(all.size())))];
      if (number) {
        const double factor = dice_.one_of({-1.0, 1e6, 1e-6, 10.0, 0.1, 1e3, 0.0, 1e30, 1e-30, 1e300, 1e-300});
        const double value = leaf.asDouble();
        leaf = factor * (value == 0.0 && dice_.chance(0.5) ? length_ : value);
      } else {
        leaf = dice_.one_of<const char*>({"", "nobody", "linear", "elastic"});
      }
    }
  }

  static constexpr const char* kAxes[] = {"x", "y", "z"};

  Dice dice_;
  SceneSize size_;
  Json::Value scene_;
  int cells_ = 0, flat_ = -1, repeating_ = -1;
  double length_ = 0.0, dx_ = 0.0, fastest_wave_ = 0.0, pull_ = 0.0;
};

}  // namespace

MadeScene make_scene(std::uint64_t seed, std::uint64_t number, const SceneSize& size) {
  return Maker(seed, number, size).make();
}

}  // namespace repose::stability
