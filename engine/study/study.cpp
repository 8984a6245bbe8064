#include "engine/study/study.h"

#include <algorithm>

#include "engine/base/wording.h"

namespace repose {
namespace {

std::vector<std::string> names_of(const std::vector<Figure>& figures) {
  std::vector<std::string> names;
  for (const Figure& figure : figures) names.push_back(figure.name);
  return names;
}

bool is_among(const std::string& name, const std::vector<std::string>& names) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

void describe_vary(Fields& fields, StudyDescription& study) {
  fields.list("vary", false, "keys of the scene and the values that they take", [&](Fields& f) {
    VariedKey varied;
    f.text("key", varied.key, "a key, as --set understands it, such as grid.spacing", true);
    f.text("values", varied.values,
           "separated by commas, such as \"0.02, 0.01\" or \"apic, aflip\"; \"absent\" leaves the key out",
           true);
    study.vary.push_back(varied);
  });
}

void describe_known(Fields& fields, StudyDescription& study) {
  fields.list("known", false, "what figures are known to be: formulas, experiments, other programs",
              [&](Fields& f) {
                KnownFigure known;
                const std::vector<std::string> names = names_of(study.figures);
                f.text("figure", known.figure, "name of one of \"figures\"", true);
                f.check(known.figure.empty() || is_among(known.figure, names), "figure",
                        "no figure \"" + known.figure + "\"; " + did_you_mean(known.figure, names));
                f.number("value", known.value, {.meaning = "its number, in its unit"});
                f.rows("curve", known.curve, 2, {.meaning = "its curve, x ascending"});
                f.check(std::is_sorted(known.curve.begin(), known.curve.end()), "curve", "must ascend in x");
                f.text("source", known.source, "where that is from, in words", true);
                study.known.push_back(known);
              });
}

}  // namespace

void describe(Fields& fields, StudyDescription& study) {
  fields.object(
      "study", study.given, false, "what repose study varies and measures (docs/accuracy.md)", [&](Fields& f) {
        f.list("figures", false, "figures of merit", [&](Fields& item) {
          Figure figure;
          describe(item, figure);
          item.check(!is_among(figure.name, names_of(study.figures)), "name",
                     "\"" + figure.name + "\" is taken by another figure; choose another");
          study.figures.push_back(figure);
        });
        describe_vary(f, study);
        f.choice("design", study.design, kDesigns, "how values of several keys are put together");
        f.integer(
            "seeds", study.seeds,
            {.meaning = "runs of each point, by other random places of particles", .low = 1.0, .high = 1000.0});
        f.integer("repeat", study.repeat,
                  {.meaning = "times that each run is timed", .low = 1.0, .high = 1000.0});
        f.object(
            "finest", study.finest.given, false, "a run that stands in for the truth", [&](Fields& finest) {
              finest.text(
                  "set", study.finest.set,
                  "its settings, \"key=value; key=value\"; empty: the point with the smallest grid.spacing");
              finest.integer(
                  "seeds", study.finest.seeds,
                  {.meaning = "its runs; their scatter is the noise floor", .low = 1.0, .high = 1000.0});
            });
        describe_known(f, study);
      });
}

}  // namespace repose
