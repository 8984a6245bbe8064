// Repose: the list of transfers. A new one is a header and its name here.
#pragma once

#include <array>
#include <tuple>

#include "kernels/base/quantity.h"
#include "kernels/transfer/apic.h"

namespace repose {

using Transfers = std::tuple<ApicTransfer>;

template <class... Transfer>
constexpr auto choices_of(const std::tuple<Transfer...>&) {
  return std::array{Choice{Transfer::kName, Transfer::kMeaning}...};
}
inline constexpr auto kTransferChoices = choices_of(Transfers{});

}  // namespace repose
