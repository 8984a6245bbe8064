#include "engine/simulation/meaning.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "engine/base/wording.h"

namespace repose {
namespace {

constexpr std::size_t kSamples = 64;  // of a body that are followed down

bool acts(const Scene& scene) {
  return scene.effect<Gravity>().on();
}

/// Whether something lies below x: distances are never too large, so a point may go as far as they say.
bool is_caught(const Vec3& x, const Vec3& down, const std::vector<Solid>& solids, double spacing) {
  constexpr int kMostSteps = 400;
  Vec3 at = x;
  double nearest = std::numeric_limits<double>::infinity();
  for (int step = 0; step < kMostSteps; ++step) {
    double distance = std::numeric_limits<double>::infinity();
    for (const Solid& solid : solids) distance = std::min(distance, solid.distance(at));
    if (distance < spacing) return true;
    // Far below all of them they only move away.
    if (!std::isfinite(distance) || (step > 60 && distance > 1e3 * nearest)) return false;
    nearest = std::min(nearest, distance);
    at += distance * down;
  }
  return false;
}

/// Whether something else than a solid at rest may hold, end or lift what falls.
bool may_be_caught_otherwise(const Scene& scene, const std::vector<Solid>& solids) {
  const bool moves =
      std::any_of(solids.begin(), solids.end(), [](const Solid& solid) { return solid.moves(); });
  bool repeats = false;
  for (const PeriodicAxis& axis : scene.grid.periodic) repeats = repeats || axis.length > 0.0;
  return moves || repeats || scene.effect<Sinks>().on() || scene.effect<Pins>().on() ||
         scene.effect<ForceFields>().on();
}

std::string falls_text(const std::string& what) {
  return what +
         ": nothing lies below it, so it falls for ever, in ever shorter steps; put a collider there, or a "
         "sink";
}

/// How full a set has made each cell about the nodes of a block, as shares of a cell. A block's particles lie
/// about its nodes, and not in its cells.
template <class Real>
std::array<double, 64> filled_shares(const ParticleSet<Real>& set, std::size_t occupied, double spacing) {
  std::array<double, 64> shares{};
  const double one = set.particle_volume / (spacing * spacing * spacing);
  for (std::size_t p = set.begin[occupied]; p < set.begin[occupied + 1]; ++p) {
    std::size_t cell = 0;
    for (const auto& position : set.position) {
      const int along = std::clamp(static_cast<int>(std::floor(double(position[p]) - 0.5)), 0, 3);
      cell = 4 * cell + static_cast<std::size_t>(along);
    }
    shares[cell] += one;
  }
  return shares;
}

/// Points of an emitter's mouth: the middle, and about it.
std::vector<Vec3> mouth_points(const Emitter& emitter) {
  Vec3 along =
      emitter.direction - emitter.direction.dot(emitter.normal) * emitter.normal / emitter.normal.squaredNorm();
  if (emitter.type == Emitter::Type::kDisc || !(along.norm() > 0.0)) along = emitter.normal.unitOrthogonal();
  along.normalize();
  const Vec3 across = emitter.normal.normalized().cross(along);
  const bool disc = emitter.type == Emitter::Type::kDisc;
  const double wide = disc ? emitter.radius : emitter.half_width,
               deep = disc ? emitter.radius : emitter.half_depth;
  std::vector<Vec3> points{emitter.center};
  for (const double share : {-0.7, 0.7}) {
    points.push_back(emitter.center + share * wide * along);
    points.push_back(emitter.center + share * deep * across);
  }
  return points;
}

}  // namespace

std::vector<std::string> unit_warnings(const Scene& scene) {
  std::vector<std::string> warnings;
  for (const MaterialDescription& material : scene.materials) {
    const std::string start = "materials." + material.name + ": ";
    const double density = material.elasticity().density;
    if (density < 10.0)
      warnings.push_back(start + "density " + number_text(density) + " is that of foam, in kg/m^3; " +
                         short_number(1e3 * density) + " if it was in g/cm^3");
    if (density > 3e4)
      warnings.push_back(start + "density " + number_text(density) +
                         " is more than that of any metal; it is in kg/m^3");
    const FrictionalCone* const cone = cone_of(material.parameters);
    if (cone == nullptr || !(cone->friction_angle > 0.0) || cone->friction_angle >= 1.6) continue;
    warnings.push_back(start + "friction_angle " + number_text(cone->friction_angle) + " is in degrees; " +
                       short_number(cone->friction_angle * 180.0 / M_PI) + " if it was in radians");
  }
  for (const Collider& collider : scene.effect<Colliders>().list) {
    if (collider.friction < 5.0) continue;
    warnings.push_back("colliders." + collider.name + ": friction " + number_text(collider.friction) +
                       " is a coefficient, the tangent of an angle; " +
                       (collider.friction < 90.0
                            ? short_number(std::tan(collider.friction * M_PI / 180.0)) + " if it was in degrees"
                            : "1 is rough"));
  }
  if (scene.time.integrator == Integrator::kImplicit &&
      scene.time.max_step * scene.time.frames_per_second >= 1.0)
    warnings.push_back(
        "time.max_step: implicit steps are as long as frames where nothing else bounds them, and lose motion "
        "by their length (docs/implicit.md); a tenth of a frame is a good first choice");
  return warnings;
}

template <class Real>
std::vector<std::string> softness_warnings(const Scene& scene, const State<Real>& state) {
  constexpr double kMost = 0.25;
  std::vector<std::string> warnings;
  const Vec3 gravity = scene.effect<Gravity>().acceleration;
  if (!acts(scene)) return warnings;
  const Vec3 up = -gravity.normalized();
  for (const ParticleSet<Real>& set : state.sets) {
    if (set.count == 0) continue;
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (std::size_t b = 0; b < state.grid.occupied_blocks().size(); ++b) {
      if (set.begin[b] == set.begin[b + 1]) continue;
      const double at = state.world(state.grid.occupied_coordinates(b), set, set.begin[b]).dot(up);
      low = std::min(low, at);
      high = std::max(high, at);
    }
    const MaterialDescription& material = scene.materials[static_cast<std::size_t>(set.material)];
    const Elasticity& elasticity = material.elasticity();
    const double weight = elasticity.density * gravity.norm() * (high - low);
    if (!(weight > kMost * elasticity.youngs_modulus)) continue;
    warnings.push_back("materials." + material.name + ": with youngs_modulus " +
                       number_text(elasticity.youngs_modulus) + " Pa '" + set.name +
                       "' is pressed by its own weight, " + short_number(weight) + " Pa over " +
                       short_number(high - low) + " m, to a part of its height; " +
                       short_number(20.0 * weight) + " Pa would leave it 95 % of it");
  }
  return warnings;
}

template <class Real>
std::vector<std::string> overlap_warnings(const State<Real>& state) {
  constexpr double kFull = 1.4, kPart = 0.25;  // of a cell; bodies side by side fill theirs once, on average
  constexpr std::size_t kFewest = 4;           // cells
  struct Shared {
    std::size_t cells = 0;
    double filled = 0.0;
  };
  std::map<std::pair<std::size_t, std::size_t>, Shared> pairs;
  for (std::size_t b = 0; b < state.grid.occupied_blocks().size() && state.sets.size() > 1; ++b) {
    std::vector<std::pair<std::size_t, std::array<double, 64>>> here;
    for (std::size_t s = 0; s < state.sets.size(); ++s) {
      const ParticleSet<Real>& set = state.sets[s];
      if (set.count > 0 && set.begin[b + 1] > set.begin[b])
        here.emplace_back(s, filled_shares(set, b, state.spacing));
    }
    for (std::size_t i = 0; i < here.size(); ++i) {
      for (std::size_t j = i + 1; j < here.size(); ++j) {
        for (std::size_t cell = 0; cell < 64; ++cell) {
          const double one = here[i].second[cell], other = here[j].second[cell];
          if (std::min(one, other) < kPart) continue;
          Shared& shared = pairs[{here[i].first, here[j].first}];
          ++shared.cells;
          shared.filled += one + other;
        }
      }
    }
  }
  std::vector<std::string> warnings;
  for (const auto& [pair, shared] : pairs) {
    if (shared.cells < kFewest || shared.filled < kFull * static_cast<double>(shared.cells)) continue;
    warnings.push_back("bodies." + state.sets[pair.first].name + ": lies in bodies." +
                       state.sets[pair.second].name + " in " + std::to_string(shared.cells) +
                       " cells, which hold matter twice; move one of the two");
  }
  return warnings;
}

template <class Real>
std::vector<std::string> floor_warnings(const Scene& scene, const std::vector<Solid>& solids,
                                        const State<Real>& state) {
  std::vector<std::string> warnings;
  if (!acts(scene) || may_be_caught_otherwise(scene, solids)) return warnings;
  const Vec3 down = scene.effect<Gravity>().acceleration.normalized();
  for (const ParticleSet<Real>& set : state.sets) {
    if (set.count == 0) continue;
    const std::size_t every = std::max<std::size_t>(1, set.count / kSamples);
    bool caught = false;
    for (std::size_t b = 0; b < state.grid.occupied_blocks().size() && !caught; ++b) {
      const std::size_t first = (set.begin[b] + every - 1) / every * every;
      for (std::size_t p = first; p < set.begin[b + 1] && !caught; p += every)
        caught =
            is_caught(state.world(state.grid.occupied_coordinates(b), set, p), down, solids, state.spacing);
    }
    if (!caught) warnings.push_back(falls_text("bodies." + set.name));
  }
  for (const Emitter& emitter : scene.effect<Emitters>().list) {
    if (emitter.type != Emitter::Type::kDisc && emitter.type != Emitter::Type::kRectangle) continue;
    const std::vector<Vec3> points = mouth_points(emitter);
    const bool caught = std::any_of(points.begin(), points.end(), [&](const Vec3& x) {
      return is_caught(x + state.spacing * down, down, solids, state.spacing);
    });
    if (!caught) warnings.push_back(falls_text("emitters." + emitter.name));
  }
  return warnings;
}

std::vector<std::string> mouth_warnings(const Scene& scene, const std::vector<Solid>& solids) {
  std::vector<std::string> warnings;
  const double spacing = scene.grid.spacing;
  for (const Emitter& emitter : scene.effect<Emitters>().list) {
    if (emitter.type != Emitter::Type::kDisc && emitter.type != Emitter::Type::kRectangle) continue;
    const Solid* in = nullptr;
    bool at_once = false;
    for (const Vec3& mouth : mouth_points(emitter)) {
      for (const Solid& solid : solids) {
        const bool inside = solid.distance(mouth) < -0.5 * spacing;
        const bool before = solid.distance(mouth + spacing * emitter.normal.normalized()) < -0.5 * spacing;
        if (!inside && !before) continue;
        in = &solid;
        at_once = at_once || inside;
      }
    }
    if (in == nullptr) continue;
    warnings.push_back("emitters." + emitter.name + ": its mouth " +
                       (at_once ? "lies in" : "opens less than a cell before") + " colliders." + in->name +
                       ", which does not push out what begins there; move one of the two");
  }
  return warnings;
}

#define REPOSE_INSTANTIATE(Real)                                                         \
  template std::vector<std::string> softness_warnings(const Scene&, const State<Real>&); \
  template std::vector<std::string> overlap_warnings(const State<Real>&);                \
  template std::vector<std::string> floor_warnings(const Scene&, const std::vector<Solid>&, const State<Real>&);
REPOSE_INSTANTIATE(float)
REPOSE_INSTANTIATE(double)
#undef REPOSE_INSTANTIATE

}  // namespace repose
