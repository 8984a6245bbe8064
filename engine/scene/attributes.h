// Repose: the attributes of points, and what they need of a scene.
#pragma once

#include <optional>
#include <string>

#include "engine/scene/scene.h"

namespace repose {

/// In the order of OutputAttribute.
inline constexpr Choice kOutputAttributes[] = {
    {"stress", "Cauchy stress, Pa, tension positive; 6 components xx yy zz xy yz xz"},
    {"pressure", "minus the mean of the stress's diagonal, Pa"},
    {"elastic_strain", "Hencky strain of the elastic part; 6 components as of stress"},
    {"density", "kg/m^3, as the elastic strain and the volume that volume_correction remembers leave it"},
    {"speed", "m/s"},
    {"channels", "every number per particle that an effect keeps, by its own name"},
    {"age", "s since a particle began, with the scene or from an emitter; asks for the scene's key \"age\""},
    {"shear_rate",
     "1/s, sqrt(2 D':D') of the deviatoric rate of strain; in simple shear the slope of velocity"},
    {"inertial_number", "shear_rate d / sqrt(p / rho_s); asks for the key \"grain_diameter\" of the materials"},
    {"plastic_strain", "equivalent plastic strain so far; asks for the scene's key \"plastic_strain\""},
    {"velocity_gradient",
     "1/s, the affine matrix C that particles keep; 9 components by rows, xx xy xz yx ..."}};

/// The grains of a material: those of its rate_friction where it has that, else by its keys grain_diameter and
/// grain_density; nothing where neither is given.
std::optional<Grains> grains_of(const Scene& scene, const MaterialDescription& material);

/// What a scene lacks that an attribute rests on, with the key that would give it, as a message about the key
/// output.attributes; empty where it lacks nothing.
std::string lacking(const Scene& scene, OutputAttribute attribute);

}  // namespace repose
