#include "bench/roofline.h"

#include <algorithm>
#include <cstdio>
#include <fstream>

#include "bench/sand.h"

namespace repose {
namespace {

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

template <class... Arguments>
std::string format(const char* text, Arguments... arguments) {
  char line[512];
  std::snprintf(line, sizeof line, text, arguments...);
  return line;
}

std::string processor() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
  }
  return "unknown processor";
}

/// "scatter/quadratic/mls_apic/float/avx512/cache": everything but the last three words, and those.
struct Name {
  std::string kernel, precision, target, storage;
};

Name split(std::string name) {
  std::string last[3];
  for (std::string& word : last) {
    const std::size_t slash = name.rfind('/');
    word = name.substr(slash + 1);
    name.resize(slash);
  }
  return {name, last[2], last[1], last[0]};
}

template <class Real>
std::string peaks_row(const char* precision, Target target, bool memory) {
  const CorePeaks& core = core_peaks<Real>(target);
  std::string row =
      format("| %s | %s | %.0f | %.0f | %.0f | %.0f | %.0f |", precision, target_name(target), core.flops / 1e9,
             core.l1_read / 1e9, core.l1_update / 1e9, core.l1_triad / 1e9, core.l2_update / 1e9);
  row += memory ? format(" %.1f |", memory_peaks<Real>(target).read / 1e9) : std::string(" |");
  for (std::size_t k = 0; k < std::size(MemoryPeaks::kStreams); ++k) {
    row += memory ? format(" %.1f |", memory_peaks<Real>(target).update[k] / 1e9) : std::string(" |");
  }
  return row + "\n";
}

/// The peaks that the rows were held against.
std::string peaks_table(const std::vector<Name>& names) {
  std::string table =
      "| Precision | Set | Gflop/s | L1 read | L1 update | L1 triad | L2 update | Memory read |";
  for (const int streams : MemoryPeaks::kStreams) table += format(" Memory update of %d |", streams);
  table += "\n| --- | --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |\n";
  for (const char* precision : {"float", "double"}) {
    for (const Target target : {Target::kBaseline, Target::kAvx2, Target::kAvx512}) {
      bool used = false, memory = false;
      for (const Name& name : names) {
        const bool same = name.precision == precision && name.target == target_name(target);
        used = used || same;
        memory = memory || (same && name.storage == "memory");
      }
      if (!used) continue;
      table += *precision == 'f' ? peaks_row<float>(precision, target, memory)
                                 : peaks_row<double>(precision, target, memory);
    }
  }
  return table;
}

}  // namespace

template <class Real>
Roofline roofline(const Work& work, Target target, Storage storage) {
  const CorePeaks& core = core_peaks<Real>(target);
  Roofline roof{work.flops / core.flops, "flops", work.near_numbers() * sizeof(Real), work.flops};
  if (const double seconds = roof.bytes / core.l1(); seconds > roof.seconds) {
    roof.seconds = seconds;
    roof.bound = "L1";
  }
  if (storage == Storage::kCache) return roof;
  roof.bytes = work.far_numbers() * sizeof(Real);
  const MemoryPeaks& memory = memory_peaks<Real>(target);
  const double read = work.far_read() * sizeof(Real) / memory.read;
  if (const double seconds = std::max(read, roof.bytes / memory.best_update()); seconds > roof.seconds) {
    roof.seconds = seconds;
    roof.bound = "memory";
  }
  return roof;
}
template Roofline roofline<float>(const Work&, Target, Storage);
template Roofline roofline<double>(const Work&, Target, Storage);

void Measurements::add(const std::string& name, double seconds, std::int64_t repetitions) {
  repetitions_ = std::max(repetitions_, repetitions);
  auto row = std::ranges::find(rows_, name, &Row::name);
  if (row == rows_.end()) row = rows_.insert(rows_.end(), {name, {}});
  row->seconds.push_back(seconds);
}

std::string Measurements::table() const {
  std::vector<Name> names;
  for (const Row& row : rows_) names.push_back(split(row.name));
  std::string text = format("%s, one core; medians of %lld repetitions; GB/s unless said otherwise.\n\n",
                            processor().c_str(), static_cast<long long>(repetitions_));
  text += peaks_table(names);
  text +=
      "\n| Kernel | Precision | Set | Data in | ns | Bytes | GB/s | Flops | Gflop/s | Bound by | Share |\n"
      "| --- | --- | --- | --- | ---: | ---: | ---: | ---: | ---: | --- | ---: |\n";
  for (std::size_t k = 0; k < rows_.size(); ++k) {
    const Roofline roof = rooflines_.at(rows_[k].name)();
    const double seconds = median(rows_[k].seconds);
    text += format("| %s | %s | %s | %s | %.2f | %.0f | %.1f | %.0f | %.1f | %s | %.0f %% |\n",
                   names[k].kernel.c_str(), names[k].precision.c_str(), names[k].target.c_str(),
                   names[k].storage.c_str(), 1e9 * seconds, roof.bytes, 1e-9 * roof.bytes / seconds, roof.flops,
                   1e-9 * roof.flops / seconds, roof.bound, 100 * roof.seconds / seconds);
  }
  return text;
}

}  // namespace repose
