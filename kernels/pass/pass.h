// Repose: the kernels as the engine calls them: plain function pointers, one table per instruction set and
// precision. The unit is a span of particles of one block, or one block of nodes; data stay in cache from pass
// to pass, so materials, transfers and stencils multiply here as calls and not as templates. Nothing in
// kernels/ allocates, throws, logs or knows of threads. Kernels of effects have tables of their own
// (kernels/effect).
#pragma once

#include <tuple>
#include <variant>

#include "kernels/layout/stencil.h"
#include "kernels/material/materials.h"
#include "kernels/pass/material_kernels.h"
#include "kernels/pass/node_kernels.h"
#include "kernels/pass/particle_kernels.h"
#include "kernels/pass/tangent_kernels.h"
#include "kernels/pass/target.h"
#include "kernels/pass/transfer_kernels.h"
#include "kernels/pass/vector_kernels.h"
#include "kernels/transfer/transfers.h"

namespace repose {

/// The kernels of one instruction set and precision.
template <class Real>
struct Kernels {
  static constexpr int kStencils = std::tuple_size_v<Stencils>;
  static constexpr int kTransfers = std::tuple_size_v<Transfers>;
  static constexpr int kMaterials = std::variant_size_v<MaterialParameters>;
  StencilKernels<Real> stencil[kStencils];
  TransferKernels<Real> transfer[kStencils][kTransfers];
  MaterialKernels<Real> material[kMaterials];
  VectorKernels<Real> vector;
  ParticleKernels<Real> particle;
  NodeKernels<Real> node;
  TangentKernels<Real> tangent;
};

/// The table of an instruction set that the machine supports. Real is float or double.
template <class Real>
const Kernels<Real>& kernels(Target target);

}  // namespace repose
