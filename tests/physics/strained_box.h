// Repose tests: a box of sand, driven by a velocity gradient through the passes that a scene compiles to: trial
// strain, what effects add around the return map, and the return map. No grid, so laws hold to rounding or to
// the size of a step. It has many particles at their places, since variation goes by them, and strains that are
// set at will, where an Element (engine/element) is one point that only a path leads anywhere.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "engine/compiler/compiler.h"
#include "tests/physics/physics_rig.h"

namespace repose {

class StrainedBox {
 public:
  /// `sand` are further keys of the material: "\"friction_angle\": 30"; `scene` further keys of the scene.
  explicit StrainedBox(const std::string& sand, const std::string& scene = "") {
    const std::string text = R"json({"repose": 1, "name": "element", "grid": {"spacing": 0.1},
      "bodies": [{"name": "box", "material": "sand", "particles_per_cell": 1,
                  "shape": {"type": "box", "lower": [0, 0, 0], "upper": [0.4, 0.4, 0.4]}}],
      "materials": {"sand": {"type": "drucker_prager")json" +
                             (sand.empty() ? "" : ", " + sand) + "}}" + (scene.empty() ? "" : ", " + scene) +
                             "}";
    scene_ = scene_of(text);
    auto compiled = compile_scene<double>(scene_, {});
    if (!compiled) throw std::runtime_error(compiled.error().text());
    state_ = std::move(compiled->state);
    scratch_.emplace(compiled->plan.scratch);
    for (auto& pass : compiled->plan.gather[0]) {
      const bool before = pass.description.name == "gather" || pass.description.name == "advance";
      if (!before) passes_.push_back(std::move(pass));
    }
    for (auto& entry : gradient_) entry.assign(state_.sets[0].count, 0.0);
  }

  const DruckerPragerParameters& sand() const {
    return std::get<DruckerPragerParameters>(scene_.materials[0].parameters);
  }

  /// Sets the strain of every particle, xx xy xz yy yz zz.
  void set_strain(const std::array<double, 6>& strain) {
    for (std::size_t k = 0; k < 6; ++k) {
      std::fill_n(state_.sets[0].strain[k].data(), state_.sets[0].count, strain[k]);
    }
  }
  void compress(double trace) { set_strain({-trace / 3, 0, 0, -trace / 3, 0, -trace / 3}); }

  /// A step of `dt` with the velocity gradient `gradient`, by rows, 1/s.
  void step(const std::array<double, 9>& gradient, double dt) {
    auto& set = state_.sets[0];
    for (std::size_t k = 0; k < 9; ++k) std::fill(gradient_[k].begin(), gradient_[k].end(), gradient[k]);
    for (std::size_t first = 0; first < set.count; first += kChunk) {
      Chunk<double> chunk{set,
                          first,
                          set.span(first, std::min(kChunk, set.count - first)),
                          *scratch_,
                          dt,
                          state_.spacing,
                          state_.counters.time,
                          state_.counters.step,
                          Vec3(0, 0, 0)};
      for (std::size_t k = 0; k < 9; ++k) chunk.moving_gradient[k] = gradient_[k].data();
      for (const auto& pass : passes_) pass.run(chunk);
    }
    state_.counters.time += dt;
  }
  void shear(double rate, double dt) { step({0, rate, 0, 0, 0, 0, 0, 0, 0}, dt); }

  double strain(std::size_t k, std::size_t p = 0) const { return state_.sets[0].strain[k][p]; }
  double trace(std::size_t p = 0) const { return strain(0, p) + strain(3, p) + strain(5, p); }
  /// Kirchhoff stress, Pa.
  double stress(std::size_t k, std::size_t p = 0) const {
    const bool diagonal = k == 0 || k == 3 || k == 5;
    const Elasticity& e = sand().elasticity;
    return 2.0 * e.mu() * strain(k, p) + (diagonal ? e.lambda() * trace(p) : 0.0);
  }
  double pressure(std::size_t p = 0) const { return -(stress(0, p) + stress(3, p) + stress(5, p)) / 3.0; }
  /// Norm of the deviator of stress, Pa.
  double deviator(std::size_t p = 0) const {
    double square = 0.0;
    for (const std::size_t k : {0, 3, 5}) square += std::pow(stress(k, p) + pressure(p), 2);
    for (const std::size_t k : {1, 2, 4}) square += 2.0 * std::pow(stress(k, p), 2);
    return std::sqrt(square);
  }
  double channel(const std::string& name, std::size_t p = 0) const {
    const auto& set = state_.sets[0];
    const std::size_t index = set.extra_index(name);
    EXPECT_LT(index, set.extra.size()) << "no channel " << name;
    return index < set.extra.size() ? set.extra[index].values[p] : std::nan("");
  }
  /// Where it began and is, m: elements are strained, not moved.
  Vec3 position(std::size_t p) const {
    const auto& set = state_.sets[0];
    std::size_t occupied = 0;
    while (set.begin[occupied + 1] <= p) ++occupied;
    const Index3 block = state_.grid.occupied_coordinates(occupied);
    return state_.world(block, {set.position[0][p], set.position[1][p], set.position[2][p]});
  }
  std::size_t count() const { return state_.sets[0].count; }
  std::size_t channels() const { return state_.sets[0].extra.size(); }

 private:
  Scene scene_;
  State<double> state_;
  std::vector<ParticlePass<double>> passes_;
  std::vector<double> gradient_[9];
  std::optional<Scratch<double>> scratch_;
};

}  // namespace repose
