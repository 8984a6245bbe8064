// Repose: what one run of a study came to. It is written by the process that made the run and read by the
// study, and again when a study goes on: a file per run.
#pragma once

#include <json/value.h>

#include <cstdint>
#include <map>
#include <string>

#include "engine/base/result.h"
#include "engine/study/figures.h"

namespace repose {

struct RunResult {
  int code = 0;          ///< 0, or the exit code of what ended it: 65, 66, 70, 78; -1: it left no word
  std::string words;     ///< why it ended before its end
  std::string inputs;    ///< fingerprint of the scene that was run, and of the files that it names
  std::string build;     ///< of the program
  std::string hash;      ///< of the last state
  double spacing = 0.0;  ///< dx, m
  double time = 0.0;     ///< s of the scene
  double seconds = 0.0;  ///< of steps alone
  double peak_bytes = 0.0;
  std::uint64_t particles = 0;
  std::int64_t steps = 0;
  int threads = 0;
  std::string target;
  std::map<std::string, FigureValue> figures;

  bool complete() const { return code == 0; }
};

Json::Value to_json(const RunResult& run);
/// Errors: 66 no such file, 74 it is not what a run writes.
Result<RunResult> read_run_result(const std::string& path);
Result<void> write_run_result(const RunResult& run, const std::string& path);

Json::Value to_json(const Curve& curve);
/// A number, or null where it is none.
Json::Value number_json(double value);

/// 16 hexadecimal digits of FNV-1a.
std::string fingerprint(const std::string& text);

}  // namespace repose
