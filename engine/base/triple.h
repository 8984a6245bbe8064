// Repose: three numbers along x, y and z, for hosts: no library's vector stands in what they include.
#pragma once

#include <array>

namespace repose {

using Triple = std::array<double, 3>;

}  // namespace repose
