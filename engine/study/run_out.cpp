#include "engine/study/run_out.h"

namespace repose {

void RunOut::describe(Fields& fields) {
  repose::describe(fields, heap);
  fields.number("start", start,
                {.unit = "m",
                 .meaning = "first length L; then the figure is front / L - 1; 0: the front itself",
                 .low = 0.0});
  fields.number("cover", cover,
                {.unit = "m",
                 .meaning = "mean height at which the heap ends; 0: half of the grid's spacing",
                 .low = 0.0});
}

FigureValue RunOut::measure(const RunRecord& record) const {
  const Curve height = heights(heap, record.end, record);
  const bool round = heap.form == Heap::Form::kRound;
  if (height.empty())
    return FigureValue::none(round ? "nothing lies there" : "how deep the heap is: give \"depth\"");
  const double reached = front(height, round, cover > 0.0 ? cover : 0.5 * record.spacing);
  if (!(reached > 0.0)) return FigureValue::none("nowhere is the heap half a cell high");
  return {start > 0.0 ? reached / start - 1.0 : reached, "", {}};
}

}  // namespace repose
