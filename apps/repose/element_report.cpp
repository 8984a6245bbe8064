#include "apps/repose/element_report.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "apps/repose/study/page.h"
#include "engine/base/wording.h"
#include "engine/io/atomic_file.h"

namespace repose {
namespace {

constexpr int kDigits = 12;
constexpr std::size_t kPointsOfALine = 800;
/// Where xx yy zz xy yz xz of a file lie in a tensor of ours.
constexpr std::array<std::size_t, 6> kFileOrder{0, 3, 5, 1, 4, 2};
constexpr std::array<const char*, 6> kNames{"xx", "yy", "zz", "xy", "yz", "xz"};

using Number = std::function<double(const ElementState&)>;

Number component(Symmetric6 ElementState::*tensor, std::size_t k, double sign = 1.0) {
  return [=](const ElementState& state) { return sign * (state.*tensor)[k]; };
}

double ratio(double a, double b) {
  return b != 0.0 ? a / b : std::nan("");
}

/// asin((s1 - s3) / (s1 + s3)) of the principal stresses, compression positive, degrees; not a number where s3
/// is tension.
double mobilized_angle(const ElementState& state) {
  const Symmetric6& s = state.stress;
  Mat3 stress;
  stress << s[0], s[1], s[2], s[1], s[3], s[4], s[2], s[4], s[5];
  const Vec3 principal = -Eigen::SelfAdjointEigenSolver<Mat3>(stress, Eigen::EigenvaluesOnly).eigenvalues();
  const double most = principal.maxCoeff(), least = principal.minCoeff();
  if (!(least >= 0.0) || !(most > 0.0)) return std::nan("");
  return std::asin((most - least) / (most + least)) * 180.0 / std::numbers::pi;
}

/// A column of the table.
struct Column {
  std::string name;
  Number of;
};

std::vector<Column> columns_of(const std::vector<std::string>& channels) {
  std::vector<Column> columns{{"time [s]", [](const ElementState& s) { return s.time; }}};
  for (std::size_t k = 0; k < 6; ++k)
    columns.push_back(
        {std::string("strain_") + kNames[k] + " [-]", component(&ElementState::strain, kFileOrder[k])});
  columns.push_back({"volumetric_strain [-]", [](const ElementState& s) { return s.volumetric; }});
  columns.push_back({"deviatoric_strain [-]", [](const ElementState& s) { return s.deviatoric; }});
  for (std::size_t k = 0; k < 6; ++k)
    columns.push_back(
        {std::string("stress_") + kNames[k] + " [Pa]", component(&ElementState::stress, kFileOrder[k])});
  columns.push_back({"p [Pa]", [](const ElementState& s) { return s.p(); }});
  columns.push_back({"q [Pa]", [](const ElementState& s) { return s.q(); }});
  columns.push_back({"q/p [-]", [](const ElementState& s) { return ratio(s.q(), s.p()); }});
  columns.push_back({"mobilized_friction_angle [degrees]", mobilized_angle});
  for (std::size_t k = 0; k < 6; ++k)
    columns.push_back({std::string("elastic_strain_") + kNames[k] + " [-]",
                       component(&ElementState::elastic, kFileOrder[k])});
  columns.push_back({"work [J/m^3]", [](const ElementState& s) { return s.work; }});
  columns.push_back({"plastic_work [J/m^3]", [](const ElementState& s) { return s.plastic_work; }});
  columns.push_back({"elastic_energy [J/m^3]", [](const ElementState& s) { return s.elastic_energy; }});
  for (std::size_t k = 0; k < channels.size(); ++k)
    columns.push_back({channels[k], [k](const ElementState& s) { return s.channels[k]; }});
  return columns;
}

class Charts {
 public:
  explicit Charts(const ElementReport& report) : report_(report) {}

  std::vector<Plot> all() const {
    const auto axial = component(&ElementState::strain, 5, -1.0);
    const auto shear = [](const ElementState& s) { return 2.0 * s.strain[2]; };
    const auto q = [](const ElementState& s) { return s.q(); };
    const auto volume = [](const ElementState& s) { return s.volumetric; };
    const auto q_over_p = [](const ElementState& s) { return ratio(s.q(), s.p()); };
    switch (report_.plots) {
      case ElementPlots::kAxial:
        return {with_cone(plot("ratio", "Stress ratio", kAxialStrain, "q/p", axial, q_over_p)),
                plot("deviator", "Deviator", kAxialStrain, "q [Pa]", axial, q),
                plot("volume", "Volume", kAxialStrain, kVolume, axial, volume), stress_path()};
      case ElementPlots::kOedometric:
        return {plot("axial", "Axial stress", kAxialStrain, "-sigma_zz [Pa]", axial,
                     component(&ElementState::stress, 5, -1.0)),
                plot("lateral", "Lateral over axial stress", kAxialStrain, "sigma_xx/sigma_zz", axial,
                     [](const ElementState& s) { return ratio(s.stress[0], s.stress[5]); }),
                stress_path()};
      case ElementPlots::kShear:
        return {plot("ratio", "Shear over normal stress", kShearStrain, "sigma_xz/-sigma_zz", shear,
                     [](const ElementState& s) { return ratio(s.stress[2], -s.stress[5]); }),
                plot("shear", "Shear stress", kShearStrain, "sigma_xz [Pa]", shear,
                     component(&ElementState::stress, 2)),
                plot("volume", "Volume", kShearStrain, kVolume, shear, volume), stress_path()};
      case ElementPlots::kAny:
        break;
    }
    const auto along = [](const ElementState& s) { return s.deviatoric; };
    constexpr const char* kAlong = "deviatoric strain along the path";
    return {with_cone(plot("ratio", "Stress ratio", kAlong, "q/p", along, q_over_p)),
            plot("deviator", "Deviator", kAlong, "q [Pa]", along, q),
            plot("volume", "Volume", kAlong, kVolume, along, volume), stress_path()};
  }

 private:
  static constexpr const char* kAxialStrain = "-strain_zz, log";
  static constexpr const char* kShearStrain = "2 strain_xz, log";
  static constexpr const char* kVolume = "volumetric strain, ln det F";

  Plot plot(const char* name, const std::string& title, const char* x, const char* y, const Number& across,
            const Number& up) const {
    Plot plot{name, title, {x}, {y}};
    Line line;
    line.opacity = 1.0;
    const std::size_t count = report_.states.size();
    const std::size_t stride = std::max<std::size_t>(1, (count + kPointsOfALine - 1) / kPointsOfALine);
    for (std::size_t k = 0; k < count; ++k) {
      if (k % stride == 0 || k + 1 == count)
        line.points.emplace_back(across(report_.states[k]), up(report_.states[k]));
    }
    plot.lines.push_back(std::move(line));
    return plot;
  }

  Plot with_cone(Plot plot) const {
    if (report_.cone.ratio > 0.0 && report_.cone.apex == 0.0) {
      plot.title += ", its cone dashed";
      plot.level = report_.cone.ratio;
      plot.has_level = true;
    }
    return plot;
  }

  Plot stress_path() const {
    Plot path = plot(
        "path", "Stress path", "p [Pa]", "q [Pa]", [](const ElementState& s) { return s.p(); },
        [](const ElementState& s) { return s.q(); });
    if (!(report_.cone.ratio > 0.0)) return path;
    double most = 0.0;
    for (const auto& [p, q] : path.lines[0].points) most = std::max(most, p);
    Line cone;
    cone.reference = true;
    cone.points = {{0.0, report_.cone.apex}, {most, report_.cone.apex + report_.cone.ratio * most}};
    path.lines.push_back(std::move(cone));
    path.title += ", its cone dashed";
    return path;
  }

  const ElementReport& report_;
};

std::string element(const char* name, const std::string& text, const char* more = "") {
  return "<" + std::string(name) + (*more != 0 ? " " + std::string(more) : "") + ">" + escaped(text) + "</" +
         name + ">\n";
}

}  // namespace

std::string ElementReport::csv() const {
  const std::vector<Column> columns = columns_of(channels);
  std::string text = "step";
  for (const Column& column : columns) text += "," + column.name;
  text += "\n";
  for (std::size_t k = 0; k < states.size(); ++k) {
    text += std::to_string(k);
    for (const Column& column : columns) {
      const double value = column.of(states[k]);
      text += "," + (std::isfinite(value) ? short_number(value, kDigits) : std::string());
    }
    text += "\n";
  }
  return text;
}

std::vector<Plot> ElementReport::charts() const {
  return Charts(*this).all();
}

std::string ElementReport::page() const {
  std::string html = "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n" +
                     element("title", scene + ": " + material + ", " + path) + "<style>\n" + kPageStyle +
                     "</style>\n</head>\n<body>\n<main>\n<header>" + element("h1", material + ": " + path);
  html += element(
      "p", "One element of " + material + " (" + law + ") of the scene " + scene +
               ", by the return map and the stress of the engine. Tension and stretch are positive, p in "
               "compression.");
  if (!left_out.empty())
    html += element("p", "No part of an element, and left out: " + plain_list_text(left_out) + ".",
                    "class=\"faint\"");
  html += "</header>\n<div class=\"plots\">\n";
  for (const Plot& plot : charts()) html += "<figure>" + svg(plot) + "</figure>\n";
  html +=
      "</div>\n<div class=\"table\"><table><thead><tr><th class=\"word\">column of "
      "element.csv</th><th>begin</th>"
      "<th>least</th><th>most</th><th>end</th></tr></thead><tbody>\n";
  for (const Column& column : columns_of(channels)) {
    double least = INFINITY, most = -INFINITY;
    for (const ElementState& state : states) {
      const double value = column.of(state);
      if (!std::isfinite(value)) continue;
      least = std::min(least, value);
      most = std::max(most, value);
    }
    html += "<tr><td class=\"word\">" + escaped(column.name) + "</td>";
    for (const double value : {column.of(states.front()), least, most, column.of(states.back())})
      html += "<td>" + short_number(value, 6) + "</td>";
    html += "</tr>\n";
  }
  return html +
         "</tbody></table></div>\n<footer>Every step stands in element.csv beside this page.</footer>\n" +
         "</main>\n</body>\n</html>\n";
}

Result<void> write_report(const ElementReport& report, const std::string& folder) {
  if (auto written = write_text(folder + "/element.csv", report.csv()); !written) return written;
  for (const Plot& plot : report.charts()) {
    if (auto written = write_text(folder + "/" + plot.name + ".svg", svg(plot)); !written) return written;
  }
  return write_text(folder + "/index.html", report.page());
}

}  // namespace repose
