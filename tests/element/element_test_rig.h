// Repose tests: elements of scenes from text, and what their cones are by formula.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

#include "engine/element/loading.h"
#include "engine/reading/reader.h"

namespace repose {

inline constexpr double kDegrees = 180.0 / std::numbers::pi;

/// A scene with a material "sand", of Young's modulus 1e7 Pa, nu = 0.3 and phi (degrees). `material`:
/// further keys of it; `more`: of the scene.
inline Scene sand_scene(const std::string& material = "", const std::string& more = "", double phi = 30.0) {
  auto scene = read_scene_text(R"json({"repose": 1, "name": "element", "grid": {"spacing": 0.1},
    "bodies": [{"name": "box", "material": "sand", "shape": {"type": "box", "lower": [0, 0, 0], "upper": [1, 1, 1]}}],
    "materials": {"sand": {"type": "drucker_prager", "youngs_modulus": 1e7, "poisson_ratio": 0.3, "friction_angle": )json" +
                                   std::to_string(phi) + material + "}}" + more + "}",
                               "element.json", ".");
  if (!scene) throw std::runtime_error(scene.error().text());
  return *scene;
}

inline Element element_of(const Scene& scene) {
  std::vector<std::string> left_out;
  auto only = element_scene(scene, "", left_out);
  if (!only) throw std::runtime_error(only.error().text());
  auto element = Element::create(*only);
  if (!element) throw std::runtime_error(element.error().text());
  return std::move(*element);
}

inline std::vector<ElementState> driven(Element& element, const Path& path) {
  auto states = drive(element, path);
  if (!states) throw std::runtime_error(states.error().text());
  return std::move(*states);
}
inline std::vector<ElementState> driven(const Scene& scene, const Path& path) {
  Element element = element_of(scene);
  return driven(element, path);
}

/// Compression positive, Pa.
inline double axial(const ElementState& state) {
  return -state.stress[5];
}
inline double lateral(const ElementState& state) {
  return -state.stress[0];
}

/// alpha of each matching, written once more.
inline double slope_of(const std::string& matching, double degrees) {
  const double phi = degrees / kDegrees, sine = std::sin(phi), tangent = std::tan(phi);
  if (matching == "triaxial_compression") return std::sqrt(2.0 / 3.0) * 2.0 * sine / (3.0 - sine);
  if (matching == "plane_strain") return std::sqrt(2.0) / 3.0 * sine;
  if (matching == "plane_strain_associated")
    return std::sqrt(2.0) * tangent / std::sqrt(9.0 + 12.0 * tangent * tangent);
  return sine / std::sqrt(2.0);
}
/// q/p on the cone alpha tr(tau) + |dev tau| = 0.
inline double ratio_of(double slope) {
  return 3.0 * std::sqrt(1.5) * slope;
}
inline const char* const kMatchings[] = {"triaxial_compression", "plane_strain", "plane_strain_associated",
                                         "two_dimensional"};

inline std::string matched(const std::string& matching) {
  return ", \"cone_matching\": \"" + matching + "\"";
}

}  // namespace repose
