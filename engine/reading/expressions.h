// Repose: numbers written as expressions, "= 2 * radius", over the named parameters of a scene.
#pragma once

#include <muParser.h>

#include <optional>
#include <set>
#include <string>

#include "engine/base/result.h"

namespace repose {

/// What came of an expression: a value, or the words of what is wrong with it.
struct Evaluation {
  std::optional<double> value;
  std::string error;    ///< empty beside no value: it rests on a name that is awaited or broken
  std::string awaited;  ///< that name, where it is awaited
};

class Expressions {
 public:
  Expressions();

  /// Says that `name` will be defined.
  void await(const std::string& name);

  /// Makes `name` known; refuses what is no identifier and what already means something (pi, sin ...).
  Result<void> define(const std::string& name, double value);

  /// Makes `name` known to be broken: expressions that use it fail without a message of their own.
  void define_broken(const std::string& name);

  /// Evaluates what follows the "=".
  Evaluation evaluate(const std::string& expression);

  /// Whether a text is an expression.
  static bool is_expression(const std::string& text) { return text.starts_with('='); }

 private:
  Evaluation refusal(const mu::ParserError& error) const;

  mu::Parser parser_;
  std::set<std::string> awaited_, broken_;
};

}  // namespace repose
