// Repose: the roofline of a kernel: no faster than its arithmetic at the peak of one core, nor than its numbers
// through the level of memory that they lie in. And the table of what was measured.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "bench/peaks.h"
#include "bench/work.h"

namespace repose {

/// Where the particles' channels lie: one chunk, again and again, or a set that no cache holds, block by block.
enum class Storage { kCache, kMemory };

/// The least time of one particle or node, and what takes it.
struct Roofline {
  double seconds = 0.0;
  const char* bound = "";  ///< "flops", "L1" or "memory"
  double bytes = 0.0;      ///< moved, of the level that `storage` names
  double flops = 0.0;
};
template <class Real>
Roofline roofline(const Work& work, Target target, Storage storage);

/// What was measured, in the order of running; the rows of the table.
class Measurements {
 public:
  /// How to tell the roofline of the benchmark of this full name, once all peaks are known.
  void expect(const std::string& name, std::function<Roofline()> roofline) {
    rooflines_[name] = std::move(roofline);
  }
  /// Seconds an item, of one repetition or the median of several.
  void add(const std::string& name, double seconds, std::int64_t repetitions);

  /// Markdown: the machine, its peaks, and a row per benchmark with the median of its repetitions.
  std::string table() const;

 private:
  struct Row {
    std::string name;
    std::vector<double> seconds;
  };
  std::map<std::string, std::function<Roofline()>> rooflines_;
  std::vector<Row> rows_;
  std::int64_t repetitions_ = 1;
};

}  // namespace repose
