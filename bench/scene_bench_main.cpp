// Repose: the words of scene_bench.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <optional>

#include "apps/repose/command.h"
#include "bench/scene_bench.h"
#include "engine/io/atomic_file.h"

namespace repose {
namespace {

/// A file that is made before the work, so that a wrong path does not cost it. Nothing for an empty path.
Result<void> create(const std::string& path, std::optional<AtomicFile>& file) {
  if (path.empty()) return {};
  auto created = AtomicFile::create(path);
  if (!created) return created.error();
  file.emplace(std::move(*created));
  return {};
}

Result<void> fill(std::optional<AtomicFile>& file, const std::string& text) {
  if (!file) return {};
  if (auto written = file->write(text.data(), text.size()); !written) return written;
  return file->commit();
}

int run(const SceneBenchArguments& arguments) {
  std::optional<AtomicFile> csv, json;
  if (auto made = create(arguments.csv, csv); !made) return fail(made.error());
  if (auto made = create(arguments.json, json); !made) return fail(made.error());
  const auto rows = bench_scenes(arguments);
  if (!rows) return fail(rows.error());
  if (auto written = fill(csv, to_csv(*rows)); !written) return fail(written.error());
  if (auto written = fill(json, rows->toStyledString()); !written) return fail(written.error());
  return 0;
}

int main(int count, char** words) {
  SceneBenchArguments arguments;
  CLI::App app{"Times the steps of whole scenes over sizes and threads", "scene_bench"};
  app.add_option("--scenes", arguments.scenes, "names in apps/scenes, or files (default: probe_column)")
      ->delimiter(',');
  app.add_option("--sizes", arguments.sizes, "particles, about; 0: as the scene has it (default: 1e5,1e6,1e7)")
      ->delimiter(',')
      ->check(CLI::NonNegativeNumber);
  app.add_option("--threads", arguments.threads, "numbers of threads (default: 1,2,4 ... up to the machine)")
      ->delimiter(',')
      ->check(CLI::Range(1, 1024));
  app.add_option("--steps", arguments.steps, "steps (default 60)")->check(CLI::Range(1, 1000000000));
  app.add_option("--repeats", arguments.repeats, "measurements of each; times are medians (default 3)")
      ->check(CLI::Range(1, 1000));
  app.add_option("--csv", arguments.csv, "write a table to a file");
  app.add_option("--json", arguments.json, "write the figures to a file");
  try {
    app.parse(count, words);
  } catch (const CLI::ParseError& error) {
    const int status = app.exit(error);
    return status == 0 ? 0 : static_cast<int>(ErrorKind::kUsage);
  }
  return run(arguments);
}

}  // namespace
}  // namespace repose

int main(int count, char** words) {
  return repose::main(count, words);
}
