#include "engine/study/figures.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace repose {
namespace {

template <std::size_t... k>
void describe_kind(Fields& fields, FigureKind& kind, std::index_sequence<k...>) {
  const auto describe_as = [&]<std::size_t chosen>(std::integral_constant<std::size_t, chosen>, Fields& f) {
    if (kind.index() != chosen) kind.emplace<chosen>();
    std::get<chosen>(kind).describe(f);
  };
  const Alternative kinds[] = {
      {std::variant_alternative_t<k, FigureKind>::kName, std::variant_alternative_t<k, FigureKind>::kMeaning,
       [&](Fields& f) { describe_as(std::integral_constant<std::size_t, k>(), f); }}...};
  int chosen = static_cast<int>(kind.index());
  fields.alternatives(chosen, kinds, "what is measured");
}

/// Names become names of files, and of columns.
bool is_plain(const std::string& name) {
  const auto allowed = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  };
  return std::all_of(name.begin(), name.end(), allowed);
}

/// In shares of what the reference is, unless that is nothing.
double in_shares(double error, double reference) {
  return reference != 0.0 ? error / std::abs(reference) : error;
}

}  // namespace

void describe(Fields& fields, Figure& figure) {
  fields.text("name", figure.name, "what tables and plots call it; no two figures share a name", true);
  fields.check(is_plain(figure.name), "name",
               "must do as the name of a file: letters, digits, \"_\" and \"-\"");
  describe_kind(fields, figure.kind, std::make_index_sequence<std::variant_size_v<FigureKind>>());
}

const char* Figure::type() const {
  return std::visit([](const auto& figure) { return std::decay_t<decltype(figure)>::kName; }, kind);
}
std::string Figure::unit() const {
  return std::visit([](const auto& figure) { return figure.unit(); }, kind);
}
CurveAxes Figure::axes() const {
  return std::visit([](const auto& figure) { return figure.axes(); }, kind);
}
Compares Figure::compares() const {
  return std::visit([](const auto& figure) { return std::decay_t<decltype(figure)>::kCompares; }, kind);
}
std::vector<std::string> Figure::series() const {
  return std::visit([](const auto& figure) { return figure.series(); }, kind);
}
FigureValue Figure::measure(const RunRecord& record) const {
  return std::visit([&](const auto& figure) { return figure.measure(record); }, kind);
}

FigureError error_of(Compares compares, const FigureValue& run, const FigureValue& reference) {
  if (!run.there()) return {NAN, NAN};
  if (compares == Compares::kItself) return {std::abs(run.value), NAN};
  if (!reference.there()) return {NAN, NAN};
  if (compares == Compares::kCurve && !reference.curve.empty()) {
    const Apart distance = apart(run.curve, reference.curve);
    return {distance.mean, distance.largest};
  }
  if (compares == Compares::kQuantiles && !reference.curve.empty())
    return {in_shares(area_between(run.curve, reference.curve), reference.value), NAN};
  return {in_shares(std::abs(run.value - reference.value), reference.value), NAN};
}

}  // namespace repose
