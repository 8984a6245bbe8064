// Repose: what a study writes: study.json, study.csv with every run, a page, and its plots as SVG.
#pragma once

#include <json/value.h>

#include <string>

#include "apps/repose/study/charts.h"

namespace repose {

struct StudyReport {
  StudyHead head;
  const StudyPlan& plan;
  const std::vector<StudyRun>& runs;
  const Summary& summary;
  std::string version, build, machine;
  std::string scene_hash;
  int parallel = 1;      ///< runs that shared the machine
  std::size_t left = 0;  ///< runs that are not yet made

  Json::Value json() const;
  std::string csv() const;
  std::string page() const;
};

/// All files, into a folder. Errors: 73, 74.
Result<void> write_report(const StudyReport& report, const std::string& folder);

}  // namespace repose
