// Repose: the list of transfers. A new one is a header and a line here. The order is that of TransferKind.
#pragma once

#include <tuple>

#include "kernels/transfer/apic.h"

namespace repose {

using Transfers = std::tuple<ApicTransfer>;

}  // namespace repose
