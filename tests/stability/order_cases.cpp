#include "tests/stability/order_cases.h"

#include "tests/physics/manufactured_rig.h"

namespace repose::battery {
namespace {

constexpr double kOrder = 1.8;

template <class Run>
void expect_order(Case& result, const std::string& name, const std::vector<int>& cells, const Missed* missed,
                  Run run) {
  double last = 0.0;
  for (const int number : cells) {
    const double error = run(number).rms;
    report(name + "_rms_" + std::to_string(number) + "_cells", error, "m");
    if (last > 0.0) {
      const std::string between =
          name + ": order, " + std::to_string(number / 2) + " to " + std::to_string(number) + " cells";
      const double order = std::log2(last / error);
      if (missed != nullptr && order < kOrder) {
        result.at_least(between, order, kOrder, "", *missed);
      } else {
        result.at_least(between, order, kOrder);
      }
    }
    last = error;
  }
}

}  // namespace

void expect_order_of_the_vortex(Case& result, const std::vector<int>& cells, const Missed* missed) {
  expect_order(result, "vortex", cells, missed,
               [](int number) { return manufactured::vortex<double>({manufactured::cells(number)}); });
}

void expect_order_of_the_box(Case& result, const std::vector<int>& cells, const Missed* missed) {
  expect_order(result, "box", cells, missed,
               [](int number) { return manufactured::box<double>({manufactured::cells(number)}, 4); });
}

}  // namespace repose::battery
