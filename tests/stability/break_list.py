"""Breaks of the engine, for breaks.py: mistakes that a person could make, each with the cases that must notice it.

`find` stands in `file` exactly once. A break that is `long` takes half an hour.
"""

import dataclasses


@dataclasses.dataclass(frozen=True)
class Break:
    name: str
    what: str
    file: str
    find: str
    replace: str
    cases: list
    long: bool = False


BREAKS = [
    Break("eigen_angle", "of the two angles of a Jacobi rotation always that of the plus sign, not the smaller",
          "kernels/base/eigen_sym3-inl.h",
          "const N denominator = d + copysign(root, d);",
          "const N denominator = d + root;",
          [1, 2, 3, 4]),
    Break("inside_out", "the check before a step lets pass what is turned inside out",
          "kernels/pass/particles.cpp",
          """    const auto& m = map.m;
    const P volume_ratio = determinant(map), trace = m[0][0] + m[1][1] + m[2][2];
    const auto minor = [&m](int a, int b) HWY_ATTR { return m[a][a] * m[b][b] - m[a][b] * m[b][a]; };
    const P minors = minor(0, 1) + minor(1, 2) + minor(2, 0);
    auto good = (volume_ratio > zero) & (volume_ratio <= P(std::numeric_limits<T>::max())) & (minors > zero) &
                (trace > zero);
""",
          """    const P volume_ratio = determinant(map);
    auto good = volume_ratio <= P(std::numeric_limits<T>::max());
""",
          [5, 9, 24]),
    Break("last_lane", "a bound off: the last particle of each pack is not moved",
          "kernels/pass/particles.cpp",
          "x.store_first(particles.position[axis] + first, lanes);",
          "x.store_first(particles.position[axis] + first, lanes - 1);",
          [16, 20, 26, 35]),
    Break("half_return", "the return map goes half of the way to the cone",
          "kernels/pass/material.cpp",
          "store_sym3(Law::return_map(constants, strain), in.strain, first, lanes);",
          """store_sym3(Pack<T>(T(0.5)) * (strain + Law::return_map(constants, strain)), in.strain, first,
                 lanes);""",
          [6, 7, 8, 10]),
    Break("transposed", "the gradient of velocity is read column by column",
          "kernels/pass/material.cpp",
          "step.m[k / 3][k % 3] = dt *",
          "step.m[k % 3][k / 3] = dt *",
          [11, 32]),
    Break("stress_times_volume", "the stress is multiplied by the change of volume once too often",
          "kernels/pass/material.cpp",
          "store_sym3(Law::stress(constants, strain), in.stress, first, lanes);",
          """store_sym3((Pack<T>(T(1)) + trace(strain)) * Law::stress(constants, strain), in.stress, first,
                 lanes);""",
          [12]),
    Break("gap_sign", "the volume that sand has gained is counted with the wrong sign",
          "kernels/effect/volume_correction.cpp",
          "(total - kept).store_first(gained + first, lanes);",
          "(kept - total).store_first(gained + first, lanes);",
          [13]),
    Break("mass_lane", "a lane off: the slopes of what a particle tells hold its mass",
          "kernels/pass/scatter.cpp",
          "store_interleaved(zero, slope[axis][0], slope[axis][1], slope[axis][2], out.slope[axis]);",
          "store_interleaved(zero + mass, slope[axis][0], slope[axis][1], slope[axis][2], out.slope[axis]);",
          [14, 22]),
    Break("block_above", "what a block tells the block above it is left out",
          "kernels/pass/nodes.cpp",
          "      if (T* to = along_z[2]) add_three_nodes(from + 5 * kNodeValues, to + row);\n",
          "",
          [37]),
    Break("finite", "velocities of nodes that are not finite are not told",
          "kernels/pass/nodes.cpp",
          "      finite = finite && !any(!(idle | (abs(v[axis]) <= most)));\n",
          "",
          [42]),
    Break("other_spline", "D is that of the cubic spline, whichever is used",
          "engine/plan/transfer_passes.cpp",
          "static_cast<Real>(transfer.nodes().inverse_d / state.spacing);",
          "static_cast<Real>(std::min(transfer.nodes().inverse_d, 3.0) / state.spacing);",
          [15, 18]),
    Break("gravity", "gravity is 5 % off",
          "engine/effect/gravity.cpp",
          "static_cast<Real>(dt * share * gravity.acceleration[axis]);",
          "static_cast<Real>(dt * share * 1.05 * gravity.acceleration[axis]);",
          [16, 31]),
    Break("spin_about_origin", "bodies turn about the origin of the lattice",
          "engine/compiler/initial_state.cpp",
          "x[static_cast<int>(axis)] = (cells[p][axis] + offset) * scene.grid.spacing;",
          """x[static_cast<int>(axis)] =
          (cells[p][axis] + static_cast<double>(scene.grid.origin_cells[axis]) + offset) * scene.grid.spacing;""",
          [17]),
    Break("cells_forgotten", "how far sound goes in a step is told in metres, not in cells",
          "engine/plan/time_step.cpp",
          """bound(limits.sound * spacing / set.sound_speed, Limit::kSound);
    if (feedback > 0.0) bound(limits.isolated * feedback * spacing / set""",
          """bound(limits.sound / set.sound_speed, Limit::kSound);
    if (feedback > 0.0) bound(limits.isolated * feedback / set""",
          [19, 27, 50]),
    Break("speed_limit", "speed does not limit the step",
          "engine/plan/time_step.cpp",
          "if (counters.max_speed > 0.0) bound(",
          "if (counters.max_speed < 0.0) bound(",
          [26]),
    Break("grid_untold", "what the blocks of nodes take is left out of the sum of memory",
          "engine/step/stepper.cpp",
          "  use.grid_bytes = state.grid_bytes();\n",
          "",
          [21]),
    Break("begin_forgotten", "implicit stress is that of the change of velocity alone",
          "engine/implicit/particle_response.cpp",
          "    for (std::size_t p = 0; p < count; ++p) trial.gradient[k][p] += begin[k][p];\n",
          "",
          [23, 25]),
    Break("first_guess_scale", "what implicit steps are solved to is a share of the impulses of the first guess",
          "engine/implicit/momentum_balance.cpp",
          "scale_ = std::min(scale_, std::sqrt(std::max(inner, outer)));",
          "if (std::isinf(scale_)) scale_ = std::sqrt(std::max(inner, outer));",
          [23]),
    Break("contacts", "solids act on nodes without mass, instead of on those with",
          "engine/effect/contact_tables.cpp",
          "if (!(at[0] > Real(0))) continue;",
          "if (at[0] > Real(0)) continue;",
          [28, 47, 48, 49]),
    Break("reach", "resting solids take the nodes within them alone, not those that are half a cell away",
          "engine/effect/contact_tables.cpp",
          "static_cast<Real>(distance - kNodeReach * state.spacing)",
          "static_cast<Real>(distance)",
          [28]),
    Break("friction", "nothing rubs against solids",
          "engine/effect/contact_tables.cpp",
          "Real friction(std::size_t k) const { return static_cast<Real>(its(k).friction); }",
          "Real friction(std::size_t) const { return Real(0); }",
          [29, 35]),
    Break("corner", "solids that meet at a node act one after the other",
          "engine/plan/collide.h",
          "if (acting > 1 || drives()) {",
          "if (acting > solids.size() && drives()) {",
          [38, 39]),
    Break("thin_solids", "solids thinner than two cells are left as they are",
          "engine/effect/thin_solid.cpp",
          "if (reaches(needed - 0.1 * spacing)) return 0.0;",
          "if (reaches(-needed)) return 0.0;",
          [48]),
    Break("untold", "of a solid that moves nobody is told that it is thin",
          "engine/simulation/warnings.cpp",
          """  for (const Solid& solid : solids) {
    const std::string thin =""",
          """  for (const Solid& solid : solids) {
    if (solid.moves()) continue;
    const std::string thin =""",
          [38]),
    Break("uncounted", "sinks remove particles without counting them",
          "engine/effect/sink.cpp",
          "        ++state.ledger.removed[(first_outlet_ + particle.sink) * state.sets.size() + k];\n",
          "",
          [36, 41]),
    Break("mass_range", "masses that no float holds are let pass",
          "engine/compiler/compiler.cpp",
          "if (set.particle_mass >= least && set.particle_mass <= most) continue;",
          "if (set.particle_mass >= least || set.particle_mass <= most) continue;",
          [40]),
    Break("account", "the account of energy begins anew in every step",
          "engine/step/energy_watch.cpp",
          "if (alarm_ == nullptr || watching_ || told_) return;",
          "if (alarm_ == nullptr || told_) return;",
          [24]),
    Break("colours", "blocks of all colours tell the nodes at once: sums in the order of arrival",
          "engine/sweep/active_blocks.cpp",
          "set_.scatter[colour].assign(occupied_blocks.begin(), occupied_blocks.end());",
          """if (colour == 0) set_.scatter[0].clear();
      set_.scatter[0].insert(set_.scatter[0].end(), occupied_blocks.begin(), occupied_blocks.end());""",
          [44]),
    Break("checkpoint", "checkpoints hold no C",
          "engine/io/checkpoint.cpp",
          "set.for_each_real([&](auto& array) { one(std::to_string(channel++), array); });",
          """set.for_each_real([&](auto& array) {
    if (++channel <= 6 || channel > 15) one(std::to_string(channel), array);
  });""",
          [45]),
    Break("radians", "the angle of friction is made radians twice",
          "engine/compiler/plan_compiler.cpp",
          """      [&runtime](const auto& parameters) {
        using""",
          """      [&runtime](auto parameters) {
        if constexpr (requires { parameters.friction_angle; }) parameters.friction_angle *= 3.14159 / 180;
        using""",
          [29, 30, 33, 34]),
    Break("least_mass", "which nodes count as empty is told in kilograms, not in masses of particles",
          "engine/compiler/plan_compiler.cpp",
          "static_cast<Real>(1e-12 * lightest);",
          "static_cast<Real>(std::min(lightest, 1e-9));",
          [50]),
    Break("leak", "each step leaves some memory behind",
          "engine/step/stepper.cpp",
          "counters.last_dt = dt;",
          "counters.last_dt = *new double(dt);",
          [43]),
    Break("always_on", "volume correction is on in every scene",
          "engine/effect/volume_correction.cpp",
          """                [](Fields&) {});
""",
          """                [](Fields&) {});
  enabled = true;
""",
          [46], long=True),
]
