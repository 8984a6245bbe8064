// Repose tests: damaged VDB files as inputs of this process: none crashes, hangs or fills it, and what carries
// our checksum changes nothing in silence.
//   vdb_mutants --count N --seed S
#include <sys/resource.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <optional>
#include <random>

#include "engine/geometry/vdb_grid.h"
#include "engine/io/point_cloud.h"
#include "engine/io/surface.h"
#include "engine/reading/reader.h"
#include "engine/simulation/simulation.h"
#include "tests/engine/geometry/grid_writer.h"
#include "tests/engine/vdb/reader_rig.h"
#include "tests/file_bytes.h"

namespace repose {
namespace {

using Random = std::mt19937_64;
using Numbers = std::vector<double>;

PointCloud particles() {
  PointCloud points;
  points.spacing = 0.1;
  for (std::uint32_t p = 0; p < 500; ++p) {
    points.position.push_back({0.05 * (p % 10), 0.05 * (p / 10 % 10), 0.05 * (p / 100)});
    points.velocity.push_back({0.01f * static_cast<float>(p % 7), -0.5f, 0.25f});
    points.id.push_back(p);
    points.radius.push_back(0.03f);
    points.mass.push_back(0.2f);
  }
  return points;
}

void flip_bits(std::string& bytes, Random& random) {
  // Half of them where the sizes stand.
  const std::size_t within = random() % 2 == 0 ? std::min<std::size_t>(bytes.size(), 600) : bytes.size();
  for (auto flips = 1 + random() % 8; flips > 0; --flips)
    bytes[random() % within] ^= static_cast<char>(1 << random() % 8);
}

std::string mutant_of(std::string bytes, Random& random) {
  const std::size_t at = random() % bytes.size(), length = 1 + random() % 64;
  switch (random() % 8) {
    case 0:
      bytes.resize(random() % 2 == 0 ? random() % 600 : at);
      break;
    case 1:
      bytes.erase(at, length);
      break;
    case 2:
      bytes.insert(at, bytes.substr(random() % bytes.size(), length));
      break;
    case 3: {
      const std::string piece = bytes.substr(random() % bytes.size(), length);
      bytes.replace(at, std::min(piece.size(), bytes.size() - at), piece, 0,
                    std::min(piece.size(), bytes.size() - at));
      break;
    }
    case 4:
      for (std::size_t k = at; k < std::min(bytes.size(), at + length % 9); ++k)
        bytes[k] = random() % 2 == 0 ? '\xff' : '\0';
      break;
    default:
      flip_bits(bytes, random);
  }
  return bytes;
}

/// An input, and what is made of it: numbers that a run would see.
struct Input {
  const char* name;
  bool sealed;  ///< carries our checksum
  std::function<Result<Numbers>(const TemporaryFolder&)> read;
  std::string good = {};
  Numbers numbers = {};
};

template <class Grid>
Result<Numbers> sample(const TemporaryFolder& folder, const char* grid) {
  const auto made = Grid::read({true, "m.vdb", grid}, {folder.path().string()});
  if (!made) return made.error();
  Numbers numbers;
  Random random(1);
  std::uniform_real_distribution<double> near(-0.3, 1.3);
  for (int k = 0; k < 3000; ++k) {
    const Vec3 x(near(random), near(random), near(random));
    if constexpr (std::is_same_v<Grid, ScalarGrid>) {
      numbers.push_back((*made)->at(x));
    } else {
      const Vec3 value = (*made)->at(x);
      numbers.insert(numbers.end(), value.data(), value.data() + 3);
    }
  }
  return numbers;
}

/// Two steps of sand in the wind of the file.
Result<Numbers> run(const TemporaryFolder& folder, const char* grid) {
  const auto scene = read_scene_text(R"json({"repose": 1, "name": "mutant", "grid": {"spacing": 0.1},
    "materials": {"sand": {"type": "drucker_prager"}},
    "bodies": [{"name": "box", "material": "sand",
                "shape": {"type": "box", "lower": [0.2, 0, 0.2], "upper": [0.6, 0.3, 0.6]}}],
    "force_fields": [{"name": "wind", "type": "wind_grid", "drag": 3, "file": "m.vdb", "grid": ")json" +
                                         std::string(grid) + "\"}]}",
                                     "s.json", folder.path().string(), {});
  if (!scene) return scene.error();
  SimulationOptions options;
  options.threads = 1;
  const auto simulation = Simulation::create(*scene, options);
  if (!simulation) return simulation.error();
  for (int step = 0; step < 2; ++step) {
    if (const auto done = (*simulation)->step(); !done) return done.error();
  }
  const std::uint64_t hash = (*simulation)->hash();
  return Numbers{static_cast<double>(hash >> 32), static_cast<double>(hash & 0xffffffff)};
}

Result<Numbers> points(const TemporaryFolder& folder) {
  const auto cloud = read_vdb_points(folder.path("m.vdb"));
  if (!cloud) return cloud.error();
  Numbers numbers;
  for (const auto& x : cloud->position) numbers.insert(numbers.end(), x.begin(), x.end());
  return numbers;
}

Result<Numbers> figures(const TemporaryFolder& folder) {
  const auto grids = read_grid_figures(folder.path("m.vdb"));
  if (!grids) return grids.error();
  Numbers numbers;
  for (const GridFigures& grid : *grids)
    numbers.insert(numbers.end(), {static_cast<double>(grid.active), grid.least, grid.most});
  return numbers;
}

bool write_inputs(const TemporaryFolder& folder, std::vector<Input>& inputs) {
  const std::string foreign = folder.path("foreign.vdb"), fog = folder.path("fog.vdb"),
                    cloud = folder.path("cloud.vdb");
  const auto wave = [](const Vec3& x) { return Vec3(std::sin(5 * x[0]) + 1, std::cos(4 * x[1]), x[2]); };
  write_grids(foreign, {{"a", TestGrid::Kind::kFloat, wave}, {"v", TestGrid::Kind::kVector, wave}});
  if (!write_fog(particles(), {.voxel = 0.1, .flat_axis = {}}, fog) || !write_vdb_points(particles(), cloud))
    return false;
  const auto floats = [](const char* grid) {
    return [grid](const TemporaryFolder& f) { return sample<ScalarGrid>(f, grid); };
  };
  const auto vectors = [](const char* grid) {
    return [grid](const TemporaryFolder& f) { return sample<VectorGrid>(f, grid); };
  };
  const auto wind = [](const char* grid) { return [grid](const TemporaryFolder& f) { return run(f, grid); }; };
  inputs = {{"foreign floats", false, floats("a"), bytes_of(foreign)},
            {"our density", true, floats("density"), bytes_of(fog)},
            {"foreign vectors", false, vectors("v"), bytes_of(foreign)},
            {"our velocity", true, vectors("v"), bytes_of(fog)},
            {"run in foreign wind", false, wind("v"), bytes_of(foreign)},
            {"run in our wind", true, wind("v"), bytes_of(fog)},
            {"our points", true, points, bytes_of(cloud)},
            {"our figures", true, figures, bytes_of(fog)}};
  for (Input& input : inputs) {
    folder.write("m.vdb", input.good);
    const auto numbers = input.read(folder);
    if (!numbers) {
      std::printf("%s: %s\n", input.name, numbers.error().text().c_str());
      return false;
    }
    input.numbers = *numbers;
  }
  return true;
}

bool same(const Numbers& a, const Numbers& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0);
}

/// The words of a refusal without what is the file's own.
std::string kind_of(const Error& error) {
  for (const char* part : {"its checksum does not fit", "is not a VDB file that Repose wrote",
                           "the reader crashed", "the reader ran past", "the reader ended", "the reader told",
                           "there is no grid", "not finite", "must be of type"}) {
    const auto at = error.message.find(part);
    if (at == std::string::npos) continue;
    const bool whole = std::strncmp(part, "the reader", 10) == 0;
    return whole ? error.message.substr(at, 48) : part;
  }
  return error.kind == ErrorKind::kNoInput   ? "what OpenVDB refuses"
         : error.kind == ErrorKind::kPhysics ? "a step that is refused"
                                             : error.message.substr(0, 48);
}

int battery(int count, std::uint64_t seed) {
  const TemporaryFolder folder;
  std::vector<Input> inputs;
  if (!write_inputs(folder, inputs)) return 1;
  const double memory = own_memory("VmHWM");
  Random random(seed);
  int refused = 0, equal = 0, differ = 0, silent = 0;
  double longest = 0.0;
  std::map<std::string, int> why;
  for (int k = 0; k < count; ++k) {
    const Input& input = inputs[static_cast<std::size_t>(k) % inputs.size()];
    std::string bytes = mutant_of(input.good, random);
    if (bytes == input.good) bytes[bytes.size() / 2] ^= 1;
    folder.write("m.vdb", bytes);
    const auto begin = std::chrono::steady_clock::now();
    const auto numbers = input.read(folder);
    longest =
        std::max(longest, std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
    if (!numbers) {
      ++refused;
      ++why[kind_of(numbers.error())];
    } else if (same(*numbers, input.numbers)) {
      ++equal;
    } else {
      ++differ;
      if (!input.sealed) continue;
      ++silent;
      std::printf("mutant %d of %s changes the result in silence\n", k, input.name);
    }
  }
  const double grown = own_memory("VmHWM") - memory;
  rusage children{};
  ::getrusage(RUSAGE_CHILDREN, &children);
  std::printf(
      "%d mutants, seed %llu: %d refused, %d accepted with the same result, %d with another where no checksum "
      "is, %d with another in spite of one\n",
      count, static_cast<unsigned long long>(seed), refused, equal, differ - silent, silent);
  for (const auto& [words, times] : why) std::printf("  %4d  %s\n", times, words.c_str());
  std::printf("the longest took %.2f s; this process has grown by %.1f MB, a reader had at most %.0f MB\n",
              longest, 1e-6 * grown, 1e-3 * static_cast<double>(children.ru_maxrss));
  const bool good = silent == 0 && longest < 60.0 && grown < 100e6;
  if (!good) std::printf("a result that changed in silence, more than a minute, or more than 100 MB\n");
  return good ? 0 : 1;
}

}  // namespace
}  // namespace repose

int main(int argc, char** argv) {
  int count = 40;
  std::uint64_t seed = 1;
  for (int k = 1; k + 1 < argc; k += 2) {
    if (std::strcmp(argv[k], "--count") == 0) count = std::atoi(argv[k + 1]);
    if (std::strcmp(argv[k], "--seed") == 0) seed = std::strtoull(argv[k + 1], nullptr, 10);
  }
  return repose::battery(count, seed);
}
