#include "bench/page.h"

#include <cstdio>
#include <fstream>
#include <iterator>

#include "engine/io/atomic_file.h"

namespace repose {
namespace {

std::string markdown_row(const std::vector<std::string>& cells) {
  std::string row = "|";
  for (const std::string& cell : cells) row += " " + cell + (cell.empty() ? "|" : " |");
  return row + "\n";
}

std::string format(const char* pattern, int digits, double value) {
  char text[64];
  std::snprintf(text, sizeof text, pattern, digits, value);
  return text;
}

}  // namespace

Result<void> put_into(const std::string& path, const Marks& marks, const std::string& text) {
  std::ifstream file(path, std::ios::binary);
  if (!file) return Error{ErrorKind::kNoInput, "cannot be read", path};
  std::string page{std::istreambuf_iterator<char>(file), {}};
  const std::size_t begin = page.find(marks.begin), end = page.find(marks.end);
  if (begin == std::string::npos || end == std::string::npos || end < begin) {
    return Error{ErrorKind::kBadScene,
                 "has no lines " + marks.begin + "and " + marks.end + "to put figures between", path};
  }
  page.replace(begin, end - begin, marks.begin + text);
  auto out = AtomicFile::create(path);
  if (!out) return out.error();
  if (auto written = out->write(page.data(), page.size()); !written) return written;
  return out->commit();
}

std::string Table::markdown() const {
  std::string text = markdown_row(head) + markdown_row(std::vector<std::string>(head.size(), "---"));
  for (const auto& row : rows) text += markdown_row(row);
  return text;
}

std::string with_decimals(double value, int decimals) {
  return format("%.*f", decimals, value);
}

std::string with_digits(double value, int digits) {
  return format("%.*g", digits, value);
}

}  // namespace repose
