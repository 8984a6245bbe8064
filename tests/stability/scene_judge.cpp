#include "tests/stability/scene_judge.h"

#include <json/reader.h>
#include <json/value.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <memory>
#include <set>

#include "engine/reading/reader.h"
#include "tests/stability/energy_account.h"

namespace repose::stability {
namespace {

using End = Judgement::End;

void keys_below(const Json::Value& schema, std::set<std::string>& keys) {
  if (!schema.isObject() && !schema.isArray()) return;
  if (schema.isObject() && schema["properties"].isObject()) {
    for (const std::string& key : schema["properties"].getMemberNames()) keys.insert(key);
  }
  for (const Json::Value& child : schema) keys_below(child, keys);
}

const std::set<std::string>& scene_keys() {
  static const std::set<std::string> keys = [] {
    std::set<std::string> found;
    Json::Value schema;
    const std::string text = scene_schema();
    const std::unique_ptr<Json::CharReader> reader(Json::CharReaderBuilder().newCharReader());
    reader->parse(text.data(), text.data() + text.size(), &schema, nullptr);
    keys_below(schema, found);
    return found;
  }();
  return keys;
}

/// Whether a refusal points at something: a key as one writes it, in quotes or as a part of a path, or a place
/// in the text.
bool names_a_key(const std::string& text) {
  const auto of_word = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; };
  for (std::size_t begin = 0; begin < text.size();) {
    if (!of_word(text[begin])) {
      ++begin;
      continue;
    }
    std::size_t end = begin;
    while (end < text.size() && of_word(text[end])) ++end;
    const char before = begin > 0 ? text[begin - 1] : ' ', after = end < text.size() ? text[end] : ' ';
    const bool marked = std::string(".\"'").find(before) != std::string::npos ||
                        (std::string(".\"':").find(after) != std::string::npos && end < text.size());
    if (marked && scene_keys().count(text.substr(begin, end - begin)) > 0) return true;
    begin = end;
  }
  const std::size_t place = text.find("random:");
  return place != std::string::npos && std::isdigit(static_cast<unsigned char>(text[place + 7])) != 0;
}

Judgement fault(std::string why) {
  return {End::kFault, std::move(why)};
}

/// A refusal is well as long as it says what is wrong, and is none of those that no scene may bring about.
Judgement refused(const Error& error, End end) {
  Judgement result{end, error.text()};
  std::replace(result.why.begin(), result.why.end(), '\n', ' ');
  if (error.kind == ErrorKind::kInternal) return fault("an internal error: " + result.why);
  if (!names_a_key(error.text())) return fault("a refusal that names no key: " + result.why);
  return result;
}

/// What is wrong with the ledger or with what a frame would show; empty if nothing.
std::string wrong_with(Simulation& simulation) {
  const LedgerReport ledger = simulation.ledger();
  if (ledger.initial + ledger.emitted.particles - ledger.removed.particles != ledger.held.particles)
    return "the ledger does not add up";
  if (ledger.held.particles != simulation.particles()) return "the ledger holds other particles than there are";
  const PointCloud points = simulation.points({{OutputAttribute::kElasticStrain}, true});
  if (points.size() != simulation.particles()) return "a frame would show other particles than there are";
  double mass = 0.0;
  for (std::size_t p = 0; p < points.size(); ++p) {
    mass += points.mass[p];
    if (p > 0 && points.id[p] <= points.id[p - 1]) return "an id is there twice";
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (!std::isfinite(points.position[p][axis]) || !std::isfinite(points.velocity[p][axis]))
        return "particle " + std::to_string(points.id[p]) + " has a place or velocity that is not finite";
    }
  }
  for (const float strain : points.attributes[0].values) {
    if (!std::isfinite(strain)) return "a strain is not finite";
  }
  if (!(std::abs(mass - ledger.held.mass) <= 1e-6 * ledger.held.mass)) return "the ledger's mass is not there";
  const Diagnostics figures = simulation.diagnose();
  const double all = figures.kinetic_energy + figures.affine_energy + figures.elastic_energy + figures.volume +
                     figures.max_speed;
  if (!std::isfinite(all)) return "an energy, the volume or the largest speed is not finite";
  return "";
}

bool told_of_energy(const Simulation& simulation) {
  const auto tells = [](const std::string& text) {
    return text.find("energy comes from nowhere") != std::string::npos;
  };
  return std::any_of(simulation.warnings().begin(), simulation.warnings().end(), tells);
}

}  // namespace

const char* end_name(End end) {
  constexpr const char* kNames[] = {"complete", "cut short", "gave out", "refused", "gained and told", "FAULT"};
  return kNames[static_cast<std::size_t>(end)];
}

Judgement judge(const std::string& text, const JudgeOptions& options) {
  options.tell("reading");
  const Result<Scene> scene = read_scene_text(text, "random", ".");
  if (!scene) return refused(scene.error(), End::kRefused);
  options.tell("setting up");
  SimulationOptions host;
  host.threads = options.threads;
  host.memory_limit = options.memory_limit;
  const auto created = Simulation::create(*scene, host);
  if (!created) return refused(created.error(), End::kRefused);
  Simulation& simulation = **created;
  options.started(simulation);
  const std::shared_ptr<void> until_it_goes(nullptr, [&](void*) { options.ended(); });
  EnergyAccount energy(*scene, simulation);
  Judgement result;
  bool stopped = false;
  const auto after_step = [&](const StepReport& step, const Counters&) {
    ++result.steps;
    energy.after_step(step.dt);
    stopped = options.stop();
    return !stopped && energy.finite();
  };
  for (std::int64_t frame = 0; frame < scene->time.frames && !stopped && energy.finite(); ++frame) {
    options.tell("frame " + std::to_string(frame + 1));
    const auto made = simulation.advance_frame(after_step);
    if (!made) {
      const Judgement end = refused(made.error(), End::kGaveOut);
      result.end = end.end;
      result.why = end.why;
      break;
    }
    stopped = stopped || options.stop();  // interrupted within a step, of which nobody is told
    if (!stopped) energy.after_frame();
  }
  if (result.end == End::kComplete && stopped) result.end = End::kCutShort;
  result.energy_excess = energy.judged() ? energy.worst() / energy.allowed() : -1.0;
  if (!simulation.sound()) return result;
  if (const std::string wrong = wrong_with(simulation); !wrong.empty()) {
    result.end = End::kFault;
    result.why = wrong;
  } else if (!energy.finite()) {
    result.end = End::kFault;
    result.why = "an energy is not finite; " + energy.text();
  } else if (energy.judged() && energy.worst() > energy.allowed()) {
    const bool told = result.end == End::kGaveOut || told_of_energy(simulation);
    result.end = told ? End::kTold : End::kFault;
    result.why = "energy from nowhere: " + energy.text();
  }
  return result;
}

}  // namespace repose::stability
