// Repose: what a study came to: of each point its time and its figures, and how far they are from the
// reference.
//
// A point's figure is the mean over its seeds; its error is that mean's distance from the reference. The noise
// floor is the standard error of that distance as the scatter of runs alone would make it: s sqrt(1/n + 1/m),
// with s the scatter (standard deviation) of single runs, n the seeds of a point, and m those of the reference.
// An error below twice of it cannot be told from none.
#pragma once

#include <string>
#include <vector>

#include "apps/repose/study/run_result.h"
#include "apps/repose/study/sweep.h"
#include "engine/study/study.h"

namespace repose {

struct Quartiles {
  double low = 0.0, median = 0.0, high = 0.0;
};
/// Between two values a straight line; of none, not a number.
Quartiles quartiles(std::vector<double> values);

/// One run: a seed of a point, timed once or more often.
struct StudyRun {
  std::size_t point = 0;
  int seed = 0, repeat = 0;
  RunResult result;
};

/// A figure over the seeds of a point.
struct Averaged {
  FigureValue mean;
  double scatter =
      0.0;  ///< standard deviation of what is compared, as errors are told; not a number below two runs
  std::size_t count = 0;
};
Averaged average(Compares compares, const std::vector<FigureValue>& values);

struct PointFigure {
  Averaged figure;
  FigureError error;         ///< not a number without a reference
  bool below_floor = false;  ///< under twice the noise floor
  bool front = false;        ///< no other point is both faster and nearer
};

struct PointSummary {
  Point point;
  std::string refused;  ///< why no run was made
  std::size_t runs = 0, gave_out = 0;
  std::string words;  ///< of the first run that gave out
  int code = 0;
  Quartiles seconds;  ///< of complete runs; of those that gave out, if none is complete
  double peak_bytes = 0.0, spacing = 0.0, time = 0.0;
  std::uint64_t particles = 0;
  std::int64_t steps = 0;
  std::vector<PointFigure> figures;  ///< in the order of the study's

  bool whole() const { return runs > gave_out; }
  /// Or it waits for a study that was interrupted to go on.
  bool made() const { return runs > 0 || !refused.empty(); }
  /// In a word or two.
  const char* state() const {
    if (!refused.empty()) return "refused";
    if (!made()) return "not made yet";
    return gave_out == 0 ? "complete" : whole() ? "gave out in part" : "gave out";
  }
};

/// What a figure is compared with.
struct Reference {
  bool there = false;
  FigureValue value;
  std::string source;     ///< in words
  double scatter = 0.0;   ///< of single runs, as errors are told; not a number where it is not known
  std::size_t count = 0;  ///< runs that it is the mean of; 0: known from elsewhere
  double floor = 0.0;     ///< the noise floor of a point; not a number where it is not known
};

struct Summary {
  std::vector<PointSummary> points;
  std::vector<Reference> references;  ///< one for each figure
};

/// `points` in the order of the runs' numbers; `finest` is the one that stands in for the truth, or npos. It
/// may be one of the sweep, and then has seeds of its own beside those that all have.
struct StudyPlan {
  StudyDescription study;
  std::vector<Point> points;
  std::vector<std::string> refused;  ///< per point; empty: it runs
  std::size_t finest = npos;
  static constexpr std::size_t npos = static_cast<std::size_t>(-1);
};
Summary summarize(const StudyPlan& plan, const std::vector<StudyRun>& runs);

}  // namespace repose
