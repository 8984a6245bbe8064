// Repose: what hosts read between calls that advance: views of channels where they lie, and the material as
// volumes.
#include <algorithm>

#include "engine/simulation/simulation_of.h"
#include "engine/simulation/volumes.h"

namespace repose {
namespace {

template <class Real>
constexpr ChannelView::Type kType = sizeof(Real) == sizeof(float) ? ChannelView::Type::kFloat
                                                                  : ChannelView::Type::kDouble;

template <class Real>
std::vector<ChannelView> channels_of(const ParticleSet<Real>& set) {
  static constexpr const char* kAxes[] = {"x", "y", "z"};
  static constexpr const char* kSymmetric[] = {"xx", "xy", "xz", "yy", "yz", "zz"};
  static constexpr const char* kFull[] = {"xx", "xy", "xz", "yx", "yy", "yz", "zx", "zy", "zz"};
  std::vector<ChannelView> list;
  const auto add = [&](const std::string& name, const AlignedArray<Real>& values) {
    list.push_back({name, kType<Real>, values.data()});
  };
  list.push_back({"id", ChannelView::Type::kUint32, set.id.data()});
  for (std::size_t k = 0; k < 3; ++k) add(std::string("position.") + kAxes[k], set.position[k]);
  for (std::size_t k = 0; k < 3; ++k) add(std::string("velocity.") + kAxes[k], set.velocity[k]);
  for (std::size_t k = 0; set.keeps_affine && k < kAffineComponents; ++k)
    add(std::string("affine.") + kFull[k], set.affine[k]);
  for (std::size_t k = 0; k < kStrainComponents; ++k)
    add(std::string("strain.") + kSymmetric[k], set.strain[k]);
  for (const auto& channel : set.extra) add(channel.name, channel.values);
  return list;
}

}  // namespace

template <class Real>
std::vector<SetView> SimulationOf<Real>::sets() const {
  std::vector<SetView> list;
  for (const ParticleSet<Real>& set : state_.sets) {
    const std::string& material = scene_.materials[static_cast<std::size_t>(set.material)].name;
    list.push_back({set.name, material, set.particle_mass, set.particle_volume, set.count, channels_of(set),
                    set.begin.data(), state_.grid.occupied_blocks().size()});
  }
  return list;
}

template <class Real>
std::vector<Triple> SimulationOf<Real>::block_corners() const {
  std::vector<Triple> corners(state_.grid.occupied_blocks().size());
  for (std::size_t b = 0; b < corners.size(); ++b)
    corners[b] = to_triple(state_.world(state_.grid.occupied_coordinates(b), {0, 0, 0}));
  return corners;
}

/// Bytes that the memory limit leaves.
template <class Real>
double SimulationOf<Real>::room_left() const {
  return std::max(0.0, stepper_->plan().memory.limit - static_cast<double>(memory().total()));
}

template <class Real>
Result<DenseVolume> SimulationOf<Real>::surface(double voxel, double radius, int smoothing) const {
  SurfaceOptions options = surface_options(scene_, threads());
  if (voxel > 0.0) options.voxel = voxel;
  if (radius > 0.0) options.radius = radius;
  if (smoothing >= 0) options.smoothing = smoothing;
  return dense_surface(points({}), options, room_left());
}

template <class Real>
Result<DenseVolume> SimulationOf<Real>::fog(double voxel) const {
  FogOptions options = fog_options(scene_);
  if (voxel > 0.0) options.voxel = voxel;
  return dense_fog(points({{}, true}), options, room_left());
}

#define REPOSE_INSTANTIATE(Real)                                                       \
  template std::vector<SetView> SimulationOf<Real>::sets() const;                      \
  template std::vector<Triple> SimulationOf<Real>::block_corners() const;              \
  template double SimulationOf<Real>::room_left() const;                               \
  template Result<DenseVolume> SimulationOf<Real>::surface(double, double, int) const; \
  template Result<DenseVolume> SimulationOf<Real>::fog(double) const;
REPOSE_INSTANTIATE(float)
REPOSE_INSTANTIATE(double)
#undef REPOSE_INSTANTIATE

}  // namespace repose
