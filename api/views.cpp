// Repose: what the C API reads of sets, blocks and probes: views of where numbers lie, and figures.
#include <algorithm>

#include "api/objects.h"

namespace repose::api {

const std::vector<SetView>& EngineObject::views() {
  const std::uint64_t now = generation.load();
  if (sets_of != now) {
    sets = simulation->sets();
    sets_of = now;
  }
  return sets;
}

namespace {

void fill(const ChannelView& channel, const SetView& set, std::uint64_t generation, repose_view& view) {
  view.name = channel.name.c_str();
  view.data = channel.data;
  view.count = set.count;
  view.generation = generation;
  view.type = channel.type == ChannelView::Type::kFloat    ? REPOSE_FLOAT
              : channel.type == ChannelView::Type::kDouble ? REPOSE_DOUBLE
                                                           : REPOSE_UINT32;
  view.reserved = 0;
}

/// Runs body(set) on a set of an engine.
template <class Body>
repose_status with_set(repose_engine handle, size_t index, const Body& body) noexcept {
  return with_engine(handle, false, [&](EngineObject& engine) -> repose_status {
    const auto& sets = engine.views();
    if (index >= sets.size()) return fail(REPOSE_ERROR_ARGUMENT, "there is no such set", "set");
    return body(sets[index], engine.sets_of);
  });
}

}  // namespace
}  // namespace repose::api

using namespace repose;
using namespace repose::api;

repose_status repose_set_count(repose_engine handle, size_t* count) {
  return with_engine(handle, false, [&](EngineObject& engine) -> repose_status {
    if (count == nullptr) return null_argument("count");
    *count = engine.views().size();
    return REPOSE_OK;
  });
}

repose_status repose_set_info(repose_engine handle, size_t index, repose_set* info) {
  return with_set(handle, index, [&](const SetView& set, std::uint64_t generation) -> repose_status {
    if (const repose_status known = check(info, "set"); known != REPOSE_OK) return known;
    info->name = set.name.c_str();
    info->material = set.material.c_str();
    info->particle_mass = set.particle_mass;
    info->particle_volume = set.particle_volume;
    info->count = set.count;
    info->channels = set.channels.size();
    info->begin = set.begin;
    info->blocks = set.blocks;
    info->generation = generation;
    return REPOSE_OK;
  });
}

repose_status repose_channel(repose_engine handle, size_t set, size_t index, repose_view* view) {
  return with_set(handle, set, [&](const SetView& of, std::uint64_t generation) -> repose_status {
    if (const repose_status known = check(view, "view"); known != REPOSE_OK) return known;
    if (index >= of.channels.size()) return fail(REPOSE_ERROR_ARGUMENT, "there is no such channel", "index");
    fill(of.channels[index], of, generation, *view);
    return REPOSE_OK;
  });
}

repose_status repose_channel_named(repose_engine handle, size_t set, const char* name, repose_view* view) {
  return with_set(handle, set, [&](const SetView& of, std::uint64_t generation) -> repose_status {
    if (name == nullptr) return null_argument("name");
    if (const repose_status known = check(view, "view"); known != REPOSE_OK) return known;
    std::string names;
    for (const ChannelView& channel : of.channels) {
      if (channel.name == name) {
        fill(channel, of, generation, *view);
        return REPOSE_OK;
      }
      names += (names.empty() ? "" : ", ") + channel.name;
    }
    return fail({ErrorKind::kUsage, "no such channel; this set has " + names, name});
  });
}

repose_status repose_view_check(repose_engine handle, uint64_t generation) {
  return guarded([&]() -> repose_status {
    const std::shared_ptr<EngineObject> engine = engines().find(handle.value);
    if (engine == nullptr) return no_handle("engine");
    if (engine->generation.load() == generation) return REPOSE_OK;
    return fail(REPOSE_ERROR_STALE, "the engine has gone on since the view was made; make it anew",
                "generation");
  });
}

repose_status repose_block_corners(repose_engine handle, double* corners, size_t capacity, size_t* count) {
  return with_engine(handle, false, [&](const EngineObject& engine) -> repose_status {
    if (count == nullptr && corners == nullptr) return null_argument("count");
    const std::vector<Triple> all = engine.simulation->block_corners();
    if (count != nullptr) *count = all.size();
    if (corners == nullptr) return REPOSE_OK;
    if (capacity < 3 * all.size()) return too_small(3 * all.size());
    for (std::size_t b = 0; b < all.size(); ++b) std::copy(all[b].begin(), all[b].end(), corners + 3 * b);
    return REPOSE_OK;
  });
}

repose_status repose_measurement_count(repose_engine handle, size_t* count) {
  return with_engine(handle, false, [&](EngineObject& engine) -> repose_status {
    if (count == nullptr) return null_argument("count");
    engine.measurements = engine.simulation->measurements();
    *count = engine.measurements.size();
    return REPOSE_OK;
  });
}

repose_status repose_measurement(repose_engine handle, size_t index, repose_measurement_info* measurement) {
  return with_engine(handle, false, [&](EngineObject& engine) -> repose_status {
    if (const repose_status known = check(measurement, "measurement"); known != REPOSE_OK) return known;
    engine.measurements = engine.simulation->measurements();
    if (index >= engine.measurements.size())
      return fail(REPOSE_ERROR_ARGUMENT, "there is no such measurement", "index");
    const Measurement& of = engine.measurements[index];
    measurement->probe = of.probe.c_str();
    measurement->quantity = of.quantity.c_str();
    measurement->unit = of.unit.c_str();
    measurement->value = of.value;
    return REPOSE_OK;
  });
}
