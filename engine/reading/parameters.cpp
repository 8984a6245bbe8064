// Repose: parameters that rest on parameters. Rounds over what is left, each taking those whose names are all
// known by then; a round that takes none ends it, and what is left goes in circles.
#include "engine/reading/parameters.h"

#include <cmath>
#include <set>

#include "engine/base/wording.h"
#include "engine/reading/json_text.h"

namespace repose {
namespace {

class Parameters {
 public:
  Parameters(Json::Value& object, Expressions& expressions, Complaints& complaints)
      : object_(object), expressions_(expressions), complaints_(complaints) {
    for (const std::string& name : object.getMemberNames()) left_.insert(name);
  }

  void evaluate() {
    for (std::size_t before = left_.size() + 1; left_.size() < before;) {
      before = left_.size();
      const std::set<std::string> round = left_;
      for (const std::string& name : round) take(name);
    }
    for (const std::string& name : left_) {
      complaints_.add(object_[name].getOffsetStart(), path(name),
                      "is defined by itself, through other parameters");
      expressions_.define_broken(name);
    }
  }

 private:
  static std::string path(const std::string& name) { return "parameters." + name; }

  void take(const std::string& name) {
    Json::Value& value = object_[name];
    if (value.isString() && Expressions::is_expression(value.asString())) {
      const Evaluation evaluation = expressions_.evaluate(value.asString().substr(1));
      if (!evaluation.value && left_.contains(evaluation.unknown)) return;  // in a later round
      if (evaluation.value) {
        Json::Value number(*evaluation.value);
        number.setOffsetStart(value.getOffsetStart());
        value.swapPayload(number);
      } else {
        refuse(name, evaluation.error);
        return;
      }
    }
    if (!value.isNumeric() || !std::isfinite(value.asDouble())) {
      refuse(name, "found " + found_text(value) + "; expected a number, or an expression such as \"= 2 * pi\"");
      return;
    }
    const Result<void> defined = expressions_.define(name, value.asDouble());
    if (!defined) refuse(name, defined.error().message);
    left_.erase(name);
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
