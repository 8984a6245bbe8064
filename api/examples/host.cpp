// A host that moves a wall, pours sand before it, and reads what the sand does to it.
#include <cmath>
#include <cstdio>
#include <repose/repose.hpp>

constexpr const char* kScene = R"({
  "repose": 1, "name": "host",
  "grid": {"spacing": 0.03125},
  "time": {"frames_per_second": 24},
  "materials": {"sand": {"type": "drucker_prager", "density": 2200, "youngs_modulus": 3.5e5, "poisson_ratio": 0.3,
                         "friction_angle": 35}},
  "bodies": [],
  "emitters": [{"name": "hand", "type": "host", "material": "sand", "particles_per_cell": 8}],
  "colliders": [
    {"name": "floor", "shape": {"type": "plane"}, "friction": 0.5},
    {"name": "wall", "shape": {"type": "box", "lower": [-0.1, 0, -0.3], "upper": [0, 0.4, 0.3]}}]
})";

/// A layer of particles, two to a cell along each axis.
std::vector<double> layer(double height) {
  std::vector<double> positions;
  for (int i = 0; i < 16; ++i) {
    for (int k = 0; k < 16; ++k) positions.insert(positions.end(), {0.05 + i / 64.0, height, (k - 7.5) / 64.0});
  }
  return positions;
}

/// Columns follow one another: a translation along x.
std::array<double, 16> moved_to(double x) {
  return {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, x, 0, 0, 1};
}

int main() {
  try {
    repose::Scene scene = repose::Scene::from_text(kScene);
    scene.lead_pose("wall").set("gravity.acceleration", "[0, -9.81, 0]");
    repose_engine_options options = repose_engine_options_init();
    options.log_contacts = 1;
    repose::Engine engine(scene, options,
                          [](int, const char* warning) { std::printf("warning: %s\n", warning); });

    for (int frame = 0; frame < 12; ++frame) {
      if (frame < 6) engine.add_particles("hand", layer(0.05 + 0.03 * frame));
      engine.move_collider("wall", moved_to(0.01 * (frame + 1)), 1.0 / 24.0);
      engine.advance_frame();
    }

    // Where the numbers lie, without a copy; good until the next call that advances, adds or removes.
    const repose_set sand = engine.set(0);
    const repose::Span<const float> velocity = engine.view<float>(0, "velocity.x");
    double momentum = 0.0;
    for (const float v : velocity) momentum += sand.particle_mass * v;
    const repose_contact_info contact = engine.contact("wall");
    std::printf("%zu particles, momentum %.3f N s along x, the wall feels %.2f N\n", velocity.size(), momentum,
                contact.force[0]);
    return velocity.size() == 6 * 256 && momentum > 0.0 && contact.force[0] < 0.0 ? 0 : 1;
  } catch (const repose::Error& error) {
    std::printf("%s\n", error.what());
    return error.status();
  }
}
