// Repose: how the programs of bench/ write: tables of Markdown, and text between marks of a page.
#pragma once

#include <string>
#include <vector>

#include "engine/base/result.h"

namespace repose {

/// The lines that a file holds what was measured between, each with its line end.
struct Marks {
  std::string begin, end;
};

/// Puts text between the marks of a file. Errors: 66 no such file, 65 it has no such lines, 73, 74 when it
/// cannot be written; the file is then as it was.
Result<void> put_into(const std::string& path, const Marks& marks, const std::string& text);

/// Rows under a head; every row has as many cells as the head.
struct Table {
  std::vector<std::string> head;
  std::vector<std::vector<std::string>> rows;

  std::string markdown() const;
};

/// A number with so many digits after the point, and one with so many digits in all, as 0.003 or 3.54e+07.
std::string with_decimals(double value, int decimals);
std::string with_digits(double value, int digits);

}  // namespace repose
