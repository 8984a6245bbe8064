#include "engine/effect/host_channels.h"

#include <algorithm>
#include <set>

#include "engine/effect/effect.h"

namespace repose {
namespace {

constexpr const char* kLanes = "xyzw";

/// What files, and views of the engine, call other numbers of particles.
constexpr std::string_view kTaken[] = {"P",
                                       "v",
                                       "id",
                                       "pscale",
                                       "radius",
                                       "mass",
                                       "material",
                                       "position",
                                       "velocity",
                                       "affine",
                                       "strain",
                                       "x",
                                       "y",
                                       "z",
                                       "vx",
                                       "vy",
                                       "vz",
                                       "float",
                                       "int",
                                       "property",
                                       "own_velocity_x",
                                       "own_velocity_y",
                                       "own_velocity_z",
                                       "pressure",
                                       "age",
                                       "stress",
                                       "elastic_strain",
                                       "density",
                                       "speed",
                                       "channels"};

bool is_name(const std::string& name) {
  const auto letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  return !name.empty() && name.size() <= 60 && letter(name[0]) &&
         std::all_of(name.begin(), name.end(),
                     [&](char c) { return letter(c) || (c >= '0' && c <= '9') || c == '_'; });
}

/// The names that a channel takes in files, whose formats write several numbers as one or each by itself.
std::set<std::string> names_in_files(const HostChannel& channel) {
  std::set<std::string> names{channel.name};
  for (std::int64_t k = 0; channel.components > 1 && k < channel.components; ++k)
    names.insert(channel.name + "_" + kLanes[k]);
  return names;
}

}  // namespace

std::string HostChannel::component(std::size_t k) const {
  return components == 1 ? name : name + "." + kLanes[k];
}

std::vector<Example> HostChannels::examples() {
  return {{"channels", {}, {R"(channels=[{"name": "Cd", "components": 3, "initial": 0.5}])"}}};
}

void HostChannels::declare(Fields& fields, const SceneOutline&) {
  fields.list(
      "channels", false, "numbers that a program which embeds the engine keeps with particles", [&](Fields& f) {
        HostChannel channel;
        f.text("name", channel.name, "what the program, and files, call it: letters, digits and _", true);
        f.integer("components", channel.components,
                  {.meaning = "numbers per particle", .low = 1.0, .high = 4.0});
        f.number("initial", channel.initial, {.meaning = "each of them where the program says nothing"});
        f.check(is_name(channel.name), "name",
                "must be letters, digits and _, at most 60, and start with a letter, for example \"Cd\"");
        bool taken = std::find(std::begin(kTaken), std::end(kTaken), channel.name) != std::end(kTaken);
        const std::set<std::string> names = names_in_files(channel);
        for (const HostChannel& other : list) {
          for (const std::string& name : names_in_files(other)) taken = taken || names.count(name) > 0;
        }
        f.check(!taken, "name",
                "\"" + channel.name + "\" is taken by another number of particles; choose another");
        list.push_back(channel);
      });
}

std::vector<Channel> HostChannels::channels(const SetDescription&) const {
  std::vector<Channel> all;
  for (const HostChannel& channel : list) {
    for (std::int64_t k = 0; k < channel.components; ++k)
      all.emplace_back(channel.component(static_cast<std::size_t>(k)), channel.initial);
  }
  return all;
}

namespace {

/// They are there, and nothing is done with them.
template <class Real>
class KeptNumbers : public Effect<Real> {
 public:
  explicit KeptNumbers(const HostChannels&) {}
};

}  // namespace

REPOSE_EFFECT(HostChannels, KeptNumbers)

}  // namespace repose
