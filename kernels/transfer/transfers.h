// Repose: the list of transfers. A new one is a header and its name here.
#pragma once

#include <array>
#include <tuple>

#include "kernels/base/quantity.h"
#include "kernels/transfer/aflip.h"
#include "kernels/transfer/apic.h"
#include "kernels/transfer/flip.h"
#include "kernels/transfer/mls_apic.h"
#include "kernels/transfer/pic.h"
#include "kernels/transfer/rpic.h"

namespace repose {

/// The first is what scenes get that name none.
using Transfers =
    std::tuple<MlsApicTransfer, ApicTransfer, RpicTransfer, PicTransfer, FlipTransfer, AflipTransfer>;

template <class... Transfer>
constexpr auto choices_of(const std::tuple<Transfer...>&) {
  return std::array{Choice{Transfer::kName, Transfer::kMeaning}...};
}
inline constexpr auto kTransferChoices = choices_of(Transfers{});

/// What the engine needs of a transfer outside the kernels.
struct TransferFigures {
  Affine affine;
  Force force;
  bool keeps_velocity;
};

template <class... Transfer>
constexpr auto transfer_figures_of(const std::tuple<Transfer...>&) {
  return std::array{TransferFigures{Transfer::kAffine, Transfer::kForce, Transfer::kKeepsVelocity}...};
}
inline constexpr auto kTransferFigures = transfer_figures_of(Transfers{});

}  // namespace repose
