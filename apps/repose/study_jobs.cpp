#include "apps/repose/study_jobs.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <optional>

#include "apps/repose/study/plot.h"
#include "engine/base/input_file.h"
#include "engine/base/wording.h"
#include "engine/compiler/figures.h"
#include "engine/reading/study_reader.h"

namespace repose {
namespace {

Figure figure(const std::string& name, FigureKind kind) {
  return {name, std::move(kind)};
}

/// Fingerprint of what a file holds now; of none where it cannot be read, which the run then tells.
std::string contents(const std::filesystem::path& path) {
  std::ifstream file = open_input(path);
  return fingerprint(std::string(std::istreambuf_iterator<char>(file), {}));
}

/// The files that a name stands for: where it has a row of "#", those with anything in its place.
std::vector<std::filesystem::path> files_of(const std::filesystem::path& named) {
  const std::string name = named.filename().string();
  const std::size_t begin = name.find('#');
  if (begin == std::string::npos) return {named};
  const std::string before = name.substr(0, begin),
                    after = name.substr(std::min(name.find_first_not_of('#', begin), name.size()));
  std::vector<std::filesystem::path> files;
  std::error_code none;
  for (const auto& entry : std::filesystem::directory_iterator(named.parent_path(), none)) {
    const std::string own = entry.path().filename().string();
    if (own.size() > before.size() + after.size() && own.starts_with(before) && own.ends_with(after))
      files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

/// Of all files that a scene names, with their names: a mesh that was changed makes other runs of it. Each is
/// read once, however many points have it.
std::string contents_of_files(const Scene& scene) {
  static std::map<std::string, std::string> known;
  std::string all;
  for (const std::string& file : scene.files) {
    const auto [entry, is_new] = known.try_emplace((std::filesystem::path(scene.folder) / file).string());
    if (is_new) {
      for (const auto& path : files_of(entry->first))
        entry->second += "|" + path.filename().string() + " " + contents(path);
    }
    all += entry->second;
  }
  return all;
}

/// What a run depends on, beside its build and its threads.
std::string run_text(const Scene& scene) {
  return scene.identity + contents_of_files(scene) + "|" + std::to_string(scene.time.frames) + "|" +
         std::to_string(static_cast<int>(scene.time.energy_alarm)) + "|" + value_at(scene, "study.figures");
}

/// About how much work a scene is: particles times steps. Only ratios within a study count.
double cost_of(const Scene& scene) {
  double particles = 0.0;
  for (const BodyDescription& body : scene.bodies) particles += static_cast<double>(body.particles_per_cell);
  const double dimensions = scene.grid.plane_strain ? 2.0 : 3.0;
  const double precision = scene.grid.precision == Precision::kDouble ? 1.8 : 1.0;
  return std::max(1.0, particles) * precision * last_frame_time(scene) /
         std::pow(scene.grid.spacing, dimensions + 1.0);
}

/// Overrides by which all that is placed at random is placed otherwise.
std::vector<std::string> seed_overrides(const Scene& scene, int seed) {
  std::vector<std::string> words;
  if (seed == 0) return words;
  for (std::size_t k = 0; k < scene.bodies.size(); ++k)
    words.push_back("bodies[" + std::to_string(k) + "].seed=" + std::to_string(scene.bodies[k].seed + seed));
  for (int k = 0;; ++k) {
    const std::string emitter = "emitters[" + std::to_string(k) + "]";
    if (value_at(scene, emitter + ".name").empty()) return words;
    const std::string own = value_at(scene, emitter + ".seed");
    words.push_back(emitter + ".seed=" + std::to_string((own.empty() ? 1 : std::atoll(own.c_str())) + seed));
  }
}

class SetUp {
 public:
  SetUp(const StudyArguments& arguments, const Scene& scene) : arguments_(arguments), scene_(scene) {}

  Result<StudySetup> make() {
    StudyDescription& study = setup_.plan.study = study_of(scene_);
    study.figures = figures_of(study, scene_);
    if (arguments_.one_by_one) study.design = Design::kOneByOne;
    if (arguments_.seeds > 0) study.seeds = arguments_.seeds;
    if (arguments_.repeat > 0) study.repeat = arguments_.repeat;
    if (auto taken = take_vary(); !taken) return taken.error();
    if (auto taken = take_references(); !taken) return taken.error();
    for (const Point& point : points_of(setup_.vary, study.design)) add(point);
    if (auto possible = check_points(); !possible) return possible.error();
    if (auto chosen = choose_finest(); !chosen) return chosen.error();
    list_jobs();
    return std::move(setup_);
  }

 private:
  Result<void> take_vary();
  Result<void> take_references();
  Result<void> take_known(const std::string& words);
  Result<Scene> read(const Point& point, const std::vector<std::string>& more = {}) const;
  bool add(const Point& point);
  Result<void> check_points() const;
  Result<void> choose_finest();
  void list_jobs();

  const StudyArguments& arguments_;
  const Scene& scene_;
  StudySetup setup_;
  std::vector<std::optional<Scene>> scenes_;  // of the points
};

Result<void> SetUp::take_vary() {
  const auto take = [&](Result<Vary> vary) -> Result<void> {
    if (!vary) return vary.error();
    for (const Vary& other : setup_.vary) {
      if (other.key == vary->key)
        return Error{ErrorKind::kUsage, vary->key + " is varied twice; give all its values at once", "--vary"};
    }
    // --set would make it, and every point would be the same.
    if (vary->key.starts_with("parameters.") && value_at(scene_, vary->key).empty())
      return Error{ErrorKind::kBadScene, "the scene has no " + vary->key + " to vary", "--vary"};
    setup_.vary.push_back(std::move(*vary));
    return {};
  };
  for (const std::string& words : arguments_.vary) {
    if (auto taken = take(parse_vary(words)); !taken) return taken;
  }
  if (!arguments_.vary.empty()) return {};
  for (const VariedKey& varied : setup_.plan.study.vary) {
    if (auto taken = take(vary_of(varied)); !taken) return taken;
  }
  return {};
}

Result<void> SetUp::take_known(const std::string& words) {
  StudyDescription& study = setup_.plan.study;
  const std::size_t equals = words.find('=');
  std::vector<std::string> names;
  for (const Figure& each : study.figures) names.push_back(each.name);
  const std::string name = words.substr(0, equals);
  char* end = nullptr;
  const std::string number = equals == std::string::npos ? "" : words.substr(equals + 1);
  const double value = std::strtod(number.c_str(), &end);
  if (number.empty() || *end != 0 || !std::isfinite(value))
    return Error{
        ErrorKind::kUsage,
        "'" + words + "' is no reference; expected finest, finest:key=value;key=value, or FIGURE=VALUE",
        "--reference"};
  if (std::find(names.begin(), names.end(), name) == names.end())
    return Error{ErrorKind::kUsage, "no figure \"" + name + "\"; " + did_you_mean(name, names), "--reference"};
  std::erase_if(study.known, [&](const KnownFigure& known) { return known.figure == name; });
  study.known.push_back({name, value, {}, "given on the command line"});
  return {};
}

bool all_known(const StudyDescription& study) {
  return std::all_of(study.figures.begin(), study.figures.end(), [&](const Figure& figure) {
    return figure.compares() == Compares::kItself ||
           std::any_of(study.known.begin(), study.known.end(),
                       [&](const KnownFigure& known) { return known.figure == figure.name; });
  });
}

Result<void> SetUp::take_references() {
  FinestRun& finest = setup_.plan.study.finest;
  if (arguments_.reference_seeds > 0) finest.seeds = arguments_.reference_seeds;
  for (const std::string& words : arguments_.reference) {
    if (words == "finest" || words.starts_with("finest:")) {
      finest.given = true;
      finest.set = words == "finest" ? "" : words.substr(7);
    } else if (auto taken = take_known(words); !taken) {
      return taken;
    }
  }
  // Runs of the finest point that no figure is compared with are not made.
  if (all_known(setup_.plan.study)) finest.given = false;
  return {};
}

Result<Scene> SetUp::read(const Point& point, const std::vector<std::string>& more) const {
  SceneArguments arguments = arguments_.scene;
  for (const std::string& word : point.overrides()) arguments.set.push_back(word);
  for (const std::string& word : more) arguments.set.push_back(word);
  return read_scene(arguments);
}

/// Whether the scene of the point can be read. One that is the same as another's is not there twice.
bool SetUp::add(const Point& point) {
  auto scene = read(point);
  if (scene) {
    for (const auto& other : scenes_) {
      if (other && run_text(*other) == run_text(*scene)) return true;
    }
  }
  setup_.plan.points.push_back(point);
  setup_.plan.refused.push_back(scene ? "" : scene.error().text());
  scenes_.emplace_back();
  if (scene) scenes_.back() = std::move(*scene);
  return scenes_.back().has_value();
}

/// Some points may be refused; a key none of whose values the scene takes is a mistake.
Result<void> SetUp::check_points() const {
  const StudyPlan& plan = setup_.plan;
  for (const Vary& vary : setup_.vary) {
    std::string words;
    bool taken = false;
    for (std::size_t k = 0; k < plan.points.size(); ++k) {
      const auto& settings = plan.points[k].settings;
      const bool has =
          std::any_of(settings.begin(), settings.end(), [&](const Setting& s) { return s.key == vary.key; });
      if (has && words.empty()) words = plan.refused[k];
      taken = taken || (has && scenes_[k]);
    }
    if (!taken && !words.empty())
      return Error{ErrorKind::kBadScene,
                   "every point is refused that sets " + vary.key + ", the first because of " + words, "study"};
  }
  return {};
}

Result<void> SetUp::choose_finest() {
  StudyPlan& plan = setup_.plan;
  if (!plan.study.finest.given) return {};
  if (plan.study.finest.set.empty()) {
    for (std::size_t k = 0; k < scenes_.size(); ++k) {
      if (!scenes_[k]) continue;
      if (plan.finest == StudyPlan::npos || scenes_[k]->grid.spacing < scenes_[plan.finest]->grid.spacing ||
          (scenes_[k]->grid.spacing == scenes_[plan.finest]->grid.spacing &&
           cost_of(*scenes_[k]) > cost_of(*scenes_[plan.finest])))
        plan.finest = k;
    }
    return {};
  }
  const auto point = parse_settings(plan.study.finest.set);
  if (!point) return point.error();
  const auto scene = read(*point);
  if (!scene)
    return Error{ErrorKind::kBadScene, "the reference is refused: " + scene.error().text(), "study.finest"};
  for (std::size_t k = 0; k < scenes_.size(); ++k) {
    if (scenes_[k] && run_text(*scenes_[k]) == run_text(*scene)) plan.finest = k;
  }
  if (plan.finest != StudyPlan::npos) return {};
  plan.finest = plan.points.size();
  add(*point);
  return {};
}

/// Repetitions of all points after one another, so that a slow hour of the machine falls on all alike.
void SetUp::list_jobs() {
  const StudyPlan& plan = setup_.plan;
  const int seeds = static_cast<int>(plan.study.seeds), repeat = static_cast<int>(plan.study.repeat);
  const std::string common = "|" + arguments_.scene.target + "|" + std::to_string(arguments_.scene.threads) +
                             "|" + short_number(arguments_.most_seconds, 12);
  for (int r = 0; r < repeat; ++r) {
    for (std::size_t k = 0; k < plan.points.size(); ++k) {
      if (!scenes_[k]) continue;
      const bool finest = k == plan.finest;
      const int most = finest && r == 0 ? std::max(seeds, static_cast<int>(plan.study.finest.seeds)) : seeds;
      for (int s = 0; s < most; ++s) {
        Job job{k, s, r, "", "", plan.points[k].overrides(), cost_of(*scenes_[k]), plan.points[k].text()};
        const std::vector<std::string> seeded = seed_overrides(*scenes_[k], s);
        job.overrides.insert(job.overrides.end(), seeded.begin(), seeded.end());
        const auto scene = read(plan.points[k], seeded);
        if (!scene) continue;  // as it was a moment ago it could be read
        job.inputs = inputs_of(*scene);
        job.key = fingerprint(run_text(*scene) + common) + "." + std::to_string(r);
        if (most > 1) job.text += ", seed " + std::to_string(s + 1);
        if (repeat > 1) job.text += ", time " + std::to_string(r + 1);
        setup_.jobs.push_back(std::move(job));
      }
    }
  }
}

}  // namespace

std::string inputs_of(const Scene& scene) {
  return fingerprint(scene.identity + contents_of_files(scene));
}

std::vector<Figure> figures_of(const StudyDescription& study, const Scene& scene) {
  if (!study.figures.empty()) return study.figures;
  const int up = scene.up == UpAxis::kZ ? 2 : 1;
  CenterOfMass height;
  height.axis = up;
  Marginal spread;
  spread.along = up;
  return {figure("center_of_mass", height), figure("marginal", spread),
          figure("energy_residual", EnergyResidual())};
}

const std::string& program_build() {
  static const std::string build = [] {
    std::ifstream program = open_input("/proc/self/exe", std::ios::ate);
    std::string bytes(static_cast<std::size_t>(std::max<std::streamoff>(0, program.tellg())), '\0');
    program.seekg(0);
    program.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    return fingerprint(bytes);
  }();
  return build;
}

Result<StudySetup> set_up(const StudyArguments& arguments, const Scene& scene) {
  return SetUp(arguments, scene).make();
}

}  // namespace repose
