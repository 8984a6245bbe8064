#include "bench/implicit_study.h"

#include <cstdio>

namespace repose {

const std::vector<ImplicitStudy>& studies() {
  static const std::vector<ImplicitStudy> list{
      {"modes", "run-out of a column, by mode and step", study_modes},
      {"parting", "cohesion that is not there: two blocks that part", study_parting},
      {"slope", "cohesion that is not there: the steepest slope that stays", study_slope},
      {"stiffness", "seconds to the same run-out, against Young's modulus", study_stiffness},
      {"pile", "a plate that sinks slowly into a bed", study_pile},
      {"ablation", "what each key of the solver is worth", study_ablation},
      {"iteration", "what a linear iteration takes, beside an explicit step", study_iteration},
      {"tolerance", "run-out and seconds against implicit.tolerance", study_tolerance},
  };
  return list;
}

std::vector<std::string> implicit_steps(const std::string& mode, double step) {
  return {"time.integrator=implicit", "implicit.mode=" + mode, assign("time.max_step", step)};
}

std::string assign(const std::string& key, double value) {
  return key + "=" + with_digits(value, 17);
}

void add_row(Table& table, std::vector<std::string> row) {
  std::string line;
  for (std::size_t k = 0; k < row.size(); ++k) {
    if (row[k].empty()) continue;
    line += (line.empty() ? "" : ", ") + table.head[k] + " " + row[k];
  }
  std::fprintf(stderr, "%s\n", line.c_str());
  table.rows.push_back(std::move(row));
}

}  // namespace repose
