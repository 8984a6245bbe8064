// Repose: paths of strain from CSV files.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <map>

#include "engine/base/wording.h"
#include "engine/element/loading.h"

namespace repose {
namespace {

constexpr double kMostSteps = 1e7;

struct Column {
  enum class Kind { kTime, kGradient, kStrain, kRepeat };
  Kind kind;
  const char* unit;
  int row = 0, column = 0;
};

std::map<std::string, Column> known_columns() {
  std::map<std::string, Column> known{{"dt", {Column::Kind::kTime, "s"}},
                                      {"repeat", {Column::Kind::kRepeat, ""}}};
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const std::string axes{static_cast<char>('x' + i), static_cast<char>('x' + j)};
      known["L_" + axes] = {Column::Kind::kGradient, "1/s", i, j};
      if (j >= i) known["de_" + axes] = {Column::Kind::kStrain, "", i, j};
    }
  }
  return known;
}

/// Beside blanks, the quotation marks of spreadsheets.
std::string bare(const std::string& cell) {
  return trimmed(cell, " \t\r\"");
}

std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells;
  for (std::size_t begin = 0; begin <= line.size();) {
    const std::size_t end = std::min(line.find(',', begin), line.size());
    cells.push_back(bare(line.substr(begin, end - begin)));
    begin = end + 1;
  }
  return cells;
}

/// exp(A) - I, by its series: A is small, or the element is turned by it into next to nothing.
Mat3 exp_minus_one(const Mat3& a) {
  Mat3 term = a, sum = a;
  for (int k = 2; k < 60 && term.norm() > 1e-18 * sum.norm(); ++k) {
    term = term * a / k;
    sum += term;
  }
  return sum;
}

class PathReader {
 public:
  PathReader(std::string file, double rate) : file_(std::move(file)), rate_(rate) {}

  Result<std::vector<PathStep>> read() {
    std::ifstream in(file_);
    if (!in) return Error{ErrorKind::kNoInput, "cannot be read", file_};
    for (std::string line; std::getline(in, line);) {
      ++line_;
      if (bare(line).empty() || line[0] == '#') continue;
      const std::vector<std::string> cells = cells_of(line);
      if (auto taken = columns_.empty() ? take_head(cells) : take_row(cells); !taken) return taken.error();
    }
    if (in.bad()) return Error{ErrorKind::kIo, "reading failed", file_};
    if (steps_.empty()) return refuse("holds no step: a line of column names, then a row for each step");
    return std::move(steps_);
  }

 private:
  Error refuse(const std::string& what) const {
    return {ErrorKind::kBadScene, what, file_ + ":" + std::to_string(std::max(line_, 1))};
  }

  bool has(Column::Kind kind) const {
    for (const Column& column : columns_) {
      if (column.kind == kind) return true;
    }
    return false;
  }

  Result<void> take_head(const std::vector<std::string>& cells) {
    const auto known = known_columns();
    std::vector<std::string> all;
    for (const auto& [name, column] : known) all.push_back(name);
    for (const std::string& cell : cells) {
      const std::size_t bracket = cell.find('[');
      const std::string name = bare(cell.substr(0, bracket));
      const auto found = known.find(name);
      if (found == known.end()) return refuse("column \"" + name + "\" is unknown; " + did_you_mean(name, all));
      std::string unit = bracket == std::string::npos ? found->second.unit : cell.substr(bracket + 1);
      if (!unit.empty() && unit.back() == ']') unit.pop_back();
      if (*found->second.unit == 0 && bare(unit) == "-") unit.clear();
      if (bare(unit) != found->second.unit)
        return refuse("column \"" + name + "\" is in " +
                      (*found->second.unit == 0 ? std::string("no unit") : found->second.unit) + ", not in \"" +
                      bare(unit) + "\"");
      for (const std::string& before : names_) {
        if (before == name) return refuse("column \"" + name + "\" is there twice");
      }
      names_.push_back(name);
      columns_.push_back(found->second);
    }
    const bool gradients = has(Column::Kind::kGradient), strains = has(Column::Kind::kStrain);
    if (gradients && strains) return refuse("has columns of L and of de; a path is told by one of them");
    if (!gradients && !strains) return refuse("has no column of L_xx ... L_zz, nor of de_xx ... de_xz");
    if (gradients && !has(Column::Kind::kTime))
      return refuse("has gradients L, and so needs a column \"dt [s]\"");
    return {};
  }

  Result<void> take_row(const std::vector<std::string>& cells) {
    if (cells.size() != columns_.size())
      return refuse("has " + std::to_string(cells.size()) + " values for " + std::to_string(columns_.size()) +
                    " columns");
    Mat3 gradient = Mat3::Zero(), strain = Mat3::Zero();
    double dt = -1.0, repeat = 1.0;
    for (std::size_t k = 0; k < cells.size(); ++k) {
      double value = 0.0;
      const char* const end = cells[k].data() + cells[k].size();
      const auto parsed = std::from_chars(cells[k].data(), end, value);
      if (parsed.ec != std::errc() || parsed.ptr != end || !std::isfinite(value))
        return refuse(names_[k] + ": found \"" + cells[k] + "\"; expected a number");
      const Column& column = columns_[k];
      if (column.kind == Column::Kind::kTime) dt = value;
      if (column.kind == Column::Kind::kRepeat) repeat = value;
      if (column.kind == Column::Kind::kGradient) gradient(column.row, column.column) = value;
      if (column.kind == Column::Kind::kStrain)
        strain(column.row, column.column) = strain(column.column, column.row) = value;
    }
    if (has(Column::Kind::kTime) && !(dt > 0.0))
      return refuse("dt: " + number_text(dt) + " must be greater than 0 s");
    if (!(repeat >= 1.0) || repeat != std::floor(repeat))
      return refuse("repeat: " + number_text(repeat) + " must be a whole number, at least 1");
    if (static_cast<double>(steps_.size()) + repeat > kMostSteps)
      return refuse("repeat: leads to more than 1e7 steps");
    if (strain.norm() > 1.0)
      return refuse("de: a strain of " + number_text(strain.norm()) + " in one step; take steps of at most 1");
    if (dt < 0.0) dt = strain.norm() > 0.0 ? strain.norm() / rate_ : 1.0 / rate_;
    const Mat3 step = has(Column::Kind::kGradient) ? Mat3(dt * gradient) : exp_minus_one(strain);
    const PathStep made{step, dt, file_ + ":" + std::to_string(line_)};
    steps_.insert(steps_.end(), static_cast<std::size_t>(repeat), made);
    return {};
  }

  std::string file_;
  double rate_;
  int line_ = 0;
  std::vector<std::string> names_;
  std::vector<Column> columns_;
  std::vector<PathStep> steps_;
};

}  // namespace

Result<Path> read_path(const std::string& file, double pressure, double rate) {
  auto steps = PathReader(file, rate).read();
  if (!steps) return steps.error();
  Path path;
  path.pressure = pressure;
  path.steps = std::move(*steps);
  return path;
}

}  // namespace repose
