#include "apps/repose/step_rows.h"

#include <algorithm>

namespace repose {
namespace {

void add_solve(const ImplicitReport& solve, bool residuals, Json::Value& row) {
  const NewtonReport& newton = solve.newton;
  row["newton_iterations"] = newton.iterations;
  row["linear_iterations"] = newton.linear_iterations;
  row["halvings"] = newton.shortened;
  row["contact_changes"] = newton.contact_changes;
  row["unknowns"] = Json::Int64(solve.unknowns);
  row["residual"]["first"] = newton.first;
  row["residual"]["last"] = newton.last;
  row["residual"]["tolerance"] = solve.newton.tolerance;
  if (!residuals) return;
  Json::Value& list = row["residuals"] = Json::Value(Json::arrayValue);
  const auto count = std::min<std::size_t>(newton.history.size(), kMostResiduals);
  for (std::size_t k = 0; k < count; ++k) list.append(newton.history[k]);
}

}  // namespace

Json::Value energy_json(const Diagnostics& diagnostics) {
  Json::Value json;
  json["kinetic"] = diagnostics.kinetic_energy;
  json["affine"] = diagnostics.affine_energy;
  json["elastic"] = diagnostics.elastic_energy;
  json["potential"] = diagnostics.potential_energy;
  return json;
}

Json::Value StepRows::row(const StepReport& report, Simulation& simulation, std::int64_t frame) {
  const Counters& counters = simulation.counters();
  Json::Value row;
  row["step"] = Json::Int64(counters.step);
  row["frame"] = Json::Int64(frame);
  row["time"] = counters.time;
  row["dt"] = report.dt;
  row["bound_by"] = limit_name(report.limit);
  row["redone"] = report.redone;
  if (report.redone > 0) row["redone_because"] = report.first_refusal;
  if (report.implicit) add_solve(*report.implicit, residuals_, row);
  row["energy"]["before"] = std::move(before_);
  begin(simulation);
  row["energy"]["after"] = before_;
  return row;
}

}  // namespace repose
