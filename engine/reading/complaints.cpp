// Repose: complaints about a scene, put in order and into words.
#include "engine/reading/complaints.h"

#include <algorithm>

namespace repose {
namespace {

constexpr std::size_t kMostShown = 20;

/// A complaint is one line, whatever the file holds.
std::string one_line(std::string text) {
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < ' ') c = ' ';
  }
  return text;
}

}  // namespace

void Complaints::add(std::ptrdiff_t offset, std::string path, std::string message) {
  complaints_.push_back({offset, one_line(std::move(path)), one_line(std::move(message))});
}

Error Complaints::error(const SourceText& source) const {
  std::vector<Complaint> sorted = complaints_;
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const Complaint& a, const Complaint& b) { return a.offset < b.offset; });
  const auto where = [&](const Complaint& complaint) {
    return source.place(complaint.offset) + (complaint.path.empty() ? "" : ": " + complaint.path);
  };
  if (sorted.size() == 1) return {ErrorKind::kBadScene, sorted[0].message, where(sorted[0])};

  std::string lines;
  const std::size_t shown = std::min(sorted.size(), kMostShown);
  for (std::size_t i = 0; i < shown; ++i) {
    lines += (i == 0 ? "" : "\n") + where(sorted[i]) + ": " + sorted[i].message;
  }
  if (sorted.size() > shown) {
    lines += "\n" + source.place(sorted[shown].offset) + ": and " + std::to_string(sorted.size() - shown) +
             " more, from here on";
  }
  return {ErrorKind::kBadScene, lines, ""};
}

}  // namespace repose
