// Repose: expressions on muParser. Everything that muParser throws ends here.
#include "engine/reading/expressions.h"

#include <cmath>
#include <numbers>
#include <vector>

#include "engine/base/wording.h"

namespace repose {

Expressions::Expressions() {
  parser_.DefineConst("pi", std::numbers::pi);
  parser_.DefineConst("deg", std::numbers::pi / 180.0);
}

Result<void> Expressions::define(const std::string& name, double value) {
  if (parser_.GetConst().contains(name) || parser_.GetFunDef().contains(name)) {
    return Error{ErrorKind::kBadScene, "already means something in expressions; choose another name", ""};
  }
  try {
    parser_.DefineConst(name, value);
  } catch (const mu::ParserError&) {
    return Error{ErrorKind::kBadScene, "not a name for expressions; use letters, digits and _, a letter first",
                 ""};
  }
  awaited_.erase(name);
  return {};
}

void Expressions::await(const std::string& name) {
  awaited_.insert(name);
}

void Expressions::define_broken(const std::string& name) {
  awaited_.erase(name);
  broken_.insert(name);
}

Evaluation Expressions::evaluate(const std::string& expression) {
  double value = 0.0;
  try {
    parser_.SetExpr(expression);
    int count = 0;
    const double* values = parser_.Eval(count);
    if (count != 1) return {{}, "gives " + std::to_string(count) + " numbers; write one, without commas", ""};
    value = values[0];
  } catch (const mu::ParserError& error) {
    return refusal(error);
  }
  if (!std::isfinite(value)) return {{}, "gives " + number_text(value) + "; expected a finite number", ""};
  return {value, "", ""};
}

Evaluation Expressions::refusal(const mu::ParserError& error) const {
  if (error.GetCode() != mu::ecUNASSIGNABLE_TOKEN) {
    std::string message = error.GetMsg();
    while (message.ends_with('.')) message.pop_back();
    return {{}, "cannot be evaluated: " + message + "; expected for example \"= 2 * pi\"", ""};
  }
  const std::string name = error.GetToken();
  if (awaited_.contains(name)) return {{}, "", name};
  if (broken_.contains(name)) return {{}, "", ""};
  std::vector<std::string> known;
  for (const auto& [constant, of] : parser_.GetConst()) known.push_back(constant);
  for (const auto& [function, callback] : parser_.GetFunDef()) known.push_back(function);
  const std::string best = nearest(name, known);
  return {{}, "unknown name \"" + name + "\"; the nearest is \"" + best + "\"", ""};
}

}  // namespace repose
