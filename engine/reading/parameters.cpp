// Repose: parameters that rest on parameters. Each is taken after those that it names; one that waits for
// itself goes in circles.
#include "engine/reading/parameters.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include "engine/base/wording.h"
#include "engine/reading/json_text.h"

namespace repose {
namespace {

class Parameters {
 public:
  Parameters(Json::Value& object, Expressions& expressions, Complaints& complaints)
      : object_(object), expressions_(expressions), complaints_(complaints) {
    for (const std::string& name : object.getMemberNames()) {
      left_.insert(name);
      expressions_.await(name);
    }
  }

  void evaluate() {
    while (!left_.empty()) take_with_its_own(*left_.begin());
  }

 private:
  static std::string path(const std::string& name) { return "parameters." + name; }

  /// Takes a parameter, and before it those that it rests on: no recursion, for a chain may be long.
  void take_with_its_own(const std::string& first) {
    std::vector<std::string> chain{first};
    while (!chain.empty()) {
      const std::string awaited = take(chain.back());
      if (awaited.empty()) {
        chain.pop_back();
      } else if (std::find(chain.begin(), chain.end(), awaited) == chain.end()) {
        chain.push_back(awaited);
      } else {
        for (std::string name; name != awaited; chain.pop_back()) {
          name = chain.back();
          refuse(name, "is defined by itself, through other parameters");
        }
      }
    }
  }

  /// Takes a parameter from those that are left; or returns the name of another one that must come first.
  std::string take(const std::string& name) {
    Json::Value& value = object_[name];
    if (value.isString() && Expressions::is_expression(value.asString())) {
      const Evaluation evaluation = expressions_.evaluate(value.asString().substr(1));
      if (!evaluation.awaited.empty()) return evaluation.awaited;
      if (!evaluation.value) {
        refuse(name, evaluation.error);
        return "";
      }
      Json::Value number(*evaluation.value);
      number.setOffsetStart(value.getOffsetStart());
      value.swapPayload(number);
    }
    if (!value.isNumeric() || !std::isfinite(value.asDouble())) {
      refuse(name, "found " + found_text(value) + "; expected a number, or an expression such as \"= 2 * pi\"");
      return "";
    }
    const Result<void> defined = expressions_.define(name, value.asDouble());
    if (!defined) refuse(name, defined.error().message);
    left_.erase(name);
    return "";
  }

  void refuse(const std::string& name, const std::string& message) {
    if (!message.empty()) complaints_.add(object_[name].getOffsetStart(), path(name), message);
    expressions_.define_broken(name);
    left_.erase(name);
  }

  Json::Value& object_;
  Expressions& expressions_;
  Complaints& complaints_;
  std::set<std::string> left_;
};

}  // namespace

void evaluate_parameters(Json::Value& root, Expressions& expressions, Complaints& complaints) {
  if (!root.isMember("parameters")) return;
  Json::Value& object = root["parameters"];
  if (!object.isObject()) {
    complaints.add(
        object.getOffsetStart(), "parameters",
        "found " + found_text(object) + "; expected an object of numbers, such as {\"radius\": 0.1}");
    return;
  }
  Parameters(object, expressions, complaints).evaluate();
}

}  // namespace repose
