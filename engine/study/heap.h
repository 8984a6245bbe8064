// Repose: a heap as heights over the ground: volumes by rings about an axis, or by strips across a direction,
// over their area. They are volumes (V0), never extreme particles: a single stray grain must not move a front.
#pragma once

#include <vector>

#include "engine/base/params.h"
#include "engine/study/curve.h"
#include "engine/study/record.h"

namespace repose {

struct Heap {
  enum class Form { kRound, kPlane };
  Form form = Form::kRound;
  Vec3 origin{0, 0, 0};     ///< m; heights along up do not matter
  Vec3 direction{1, 0, 0};  ///< plane: which way x is counted, level
  double width = 0.0;       ///< m, of a ring or strip; 0: dx
  double depth = 0.0;       ///< m, plane: of the strips across; 0: dx in plane strain, else the period across

  double width_in(const RunRecord& record) const { return width > 0.0 ? width : record.spacing; }
};

void describe(Fields& fields, Heap& heap);

/// Mean height (volume over area) of each ring or strip over where its middle is. Empty where the depth of a
/// plane heap is not known.
Curve heights(const Heap& heap, const PointCloud& points, const RunRecord& record);

/// Area of ring k, m^2.
double ring_area(std::size_t k, double width);

/// Where the outermost heights cease to be `cover` (m) on the mean of three, between the middles of two rings;
/// 0 where there are none.
double front(const Curve& heights, bool round, double cover);

}  // namespace repose
