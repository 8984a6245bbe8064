// Repose: scatter and gather of every stencil and transfer, called as the step calls them.
#include <algorithm>

#include "bench/kernel_case.h"
#include "kernels/reference/transfer.h"

namespace repose {
namespace {

/// The blocks of nodes, as memory.
template <class Real>
Real* second_arena(const Workpiece<Real>& piece) {
  return piece.nodes;
}

template <class Real>
ScatterInput<Real> scatter_input(const Workpiece<Real>& piece, std::size_t stencil) {
  ScatterInput<Real> in{};
  in.particles = piece.particles();
  std::copy_n(piece.stress(), kStrainComponents, in.stress);
  in.mass = static_cast<Real>(SandNumbers::kMass);
  in.impulse_volume = static_cast<Real>(SandNumbers::kImpulseVolume);
  in.kept_stretching = static_cast<Real>(SandNumbers::kKeptStretching);
  in.lattice = piece.lattice(stencil);
  std::copy_n(piece.velocity(), 3, in.own_velocity);
  in.before = second_arena(piece);
  return in;
}

/// As the gather pass of the engine asks: in place, and apart only what is another number than a particle
/// keeps.
template <class Real>
GatherInput<Real> gather_input(const Workpiece<Real>& piece, std::size_t stencil, std::size_t transfer,
                               bool measures) {
  const TransferFigures& figures = kTransferFigures[transfer];
  const bool affine = figures.affine != Affine::kNone;
  GatherInput<Real> in{};
  in.particles = piece.particles();
  in.lattice = piece.lattice(stencil);
  in.kept_velocity = static_cast<Real>(SandNumbers::kKeptVelocity);
  std::copy_n(piece.velocity(), 3, in.velocity);
  if (affine) std::copy_n(piece.affine(), kAffineComponents, in.affine);
  if (figures.keeps_velocity) {
    std::copy_n(piece.moving(), 3, in.moving);
    std::copy_n(piece.own(), 3, in.own);
    in.dt = piece.dt;
  }
  if (measures) in.before = second_arena(piece);
  if (!affine || figures.keeps_velocity ||
      (figures.force == Force::kGradients && kStencilFigures[stencil].constant_d)) {
    std::copy_n(piece.gradient(), kAffineComponents, in.gradient);
  }
  return in;
}

/// The reference adds up in double.
template <class Real>
void reference_scatter(Workpiece<Real>& piece, std::size_t stencil, std::size_t transfer, bool measures) {
  Real* const arenas[] = {piece.arena, second_arena(piece)};
  std::vector<double> sums[2];
  for (std::size_t k = 0; k < 2; ++k) sums[k].assign(arenas[k], arenas[k] + kArenaValues);
  reference::scatter(stencil, transfer, scatter_input(piece, stencil), sums[0].data(),
                     measures ? sums[1].data() : nullptr);
  for (std::size_t k = 0; k < 2; ++k) {
    std::ranges::transform(sums[k], arenas[k], [](double sum) { return static_cast<Real>(sum); });
  }
}

template <class Real>
void add_pair(const Kernels<Real>& table, std::size_t stencil, std::size_t transfer, bool measures,
              std::vector<KernelCase<Real>>& cases) {
  const std::string pair = std::string("/") + kStencilFigures[stencil].name + "/" +
                           kTransferChoices[transfer].name + (measures ? "/measuring" : "");
  const double segment = particles_per_segment(stencil);
  const TransferKernels<Real>& kernels = table.transfer[stencil][transfer];
  const auto scatter = measures ? kernels.scatter_measuring : kernels.scatter;
  const auto gather = measures ? kernels.gather_measuring : kernels.gather;
  cases.push_back({"scatter" + pair, stencil, kChunk, scatter_work(stencil, transfer, segment, measures),
                   [=](Workpiece<Real>& piece) {
                     std::uint64_t rows = 0;
                     scatter(scatter_input(piece, stencil), piece.arena, rows);
                   },
                   [=](Workpiece<Real>& piece) { reference_scatter(piece, stencil, transfer, measures); }});
  cases.push_back(
      {"gather" + pair, stencil, kChunk, gather_work(stencil, transfer, segment, measures),
       [=](Workpiece<Real>& piece) { gather(gather_input(piece, stencil, transfer, measures), piece.arena); },
       [=](Workpiece<Real>& piece) {
         reference::gather(stencil, transfer, gather_input(piece, stencil, transfer, measures), piece.arena);
       }});
}

}  // namespace

template <class Real>
void add_transfer_cases(const Kernels<Real>& table, std::vector<KernelCase<Real>>& cases) {
  for (std::size_t stencil = 0; stencil < kStencilFigures.size(); ++stencil) {
    for (std::size_t transfer = 0; transfer < kTransferFigures.size(); ++transfer) {
      add_pair(table, stencil, transfer, false, cases);
      if (kTransferFigures[transfer].keeps_velocity) add_pair(table, stencil, transfer, true, cases);
    }
  }
}
template void add_transfer_cases(const Kernels<float>&, std::vector<KernelCase<float>>&);
template void add_transfer_cases(const Kernels<double>&, std::vector<KernelCase<double>>&);

}  // namespace repose
