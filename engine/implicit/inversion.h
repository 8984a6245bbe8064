// Repose: how far a step may go before it turns a particle inside out.
#pragma once

#include "engine/base/vector.h"

namespace repose {

/// The least s in (0, 1] with det(a + s b) <= least, for det(a) > least; 1 where there is none. The determinant
/// is a cubic of s, so it is monotone between the roots of a quadratic.
double length_to_determinant(const Mat3& a, const Mat3& b, double least);

}  // namespace repose
