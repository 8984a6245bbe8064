// Repose: what other programs, and papers, call what a scene says by other names.
#pragma once

namespace repose {

/// What keys are called elsewhere, here, and in the whole scene where that is one place.
struct NameOfOthers {
  const char *theirs, *name, *whole;
};
inline constexpr NameOfOthers kNamesOfOthers[] = {
    {"fps", "frames_per_second", "time.frames_per_second"},
    {"frame_rate", "frames_per_second", "time.frames_per_second"},
    {"frames_per_second", "frames_per_second", "time.frames_per_second"},
    {"frames", "frames", "time.frames"},
    {"dt", "max_step", "time.max_step"},
    {"time_step", "max_step", "time.max_step"},
    {"timestep", "max_step", "time.max_step"},
    {"dx", "spacing", "grid.spacing"},
    {"spacing", "spacing", "grid.spacing"},
    {"voxel_size", "spacing", "grid.spacing"},
    {"resolution", "spacing", "grid.spacing"},
    {"E", "youngs_modulus", ""},
    {"young", "youngs_modulus", ""},
    {"young_modulus", "youngs_modulus", ""},
    {"nu", "poisson_ratio", ""},
    {"poissons_ratio", "poisson_ratio", ""},
    {"rho", "density", ""},
    {"phi", "friction_angle", ""},
    {"ppc", "particles_per_cell", ""},
    {"mu", "friction", ""},
};

}  // namespace repose
