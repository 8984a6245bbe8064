// Repose: scatter, gather and interpolate of every stencil and transfer, called as the step calls them.
#include <algorithm>

#include "bench/kernel_case.h"
#include "kernels/reference/transfer.h"

namespace repose {
namespace {

template <class Real>
ScatterInput<Real> scatter_input(const Workpiece<Real>& piece, std::size_t stencil) {
  ScatterInput<Real> in{};
  in.particles = piece.particles();
  std::copy_n(piece.stress(), kStrainComponents, in.stress);
  in.mass = static_cast<Real>(SandNumbers::kMass);
  in.impulse_volume = static_cast<Real>(SandNumbers::kImpulseVolume);
  in.kept_stretching = static_cast<Real>(SandNumbers::kKeptStretching);
  in.lattice = piece.lattice(stencil);
  return in;
}

/// As the gather pass of the engine asks: in place, and apart only what is another number than a particle
/// keeps.
template <class Real>
GatherInput<Real> gather_input(const Workpiece<Real>& piece, std::size_t stencil, std::size_t transfer) {
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
    std::copy_n(piece.before(), 3, in.before);
  }
  if (!affine || (figures.force == Force::kGradients && kStencilFigures[stencil].constant_d)) {
    std::copy_n(piece.gradient(), kAffineComponents, in.gradient);
  }
  return in;
}

/// The reference adds up in double.
template <class Real>
void reference_scatter(Workpiece<Real>& piece, std::size_t stencil, std::size_t transfer) {
  std::vector<double> sums(piece.arena, piece.arena + kArenaValues);
  reference::scatter(stencil, transfer, scatter_input(piece, stencil), sums.data());
  std::ranges::transform(sums, piece.arena, [](double sum) { return static_cast<Real>(sum); });
}

template <class Real>
void add_pair(const Kernels<Real>& table, std::size_t stencil, std::size_t transfer,
              std::vector<KernelCase<Real>>& cases) {
  const std::string pair =
      std::string("/") + kStencilFigures[stencil].name + "/" + kTransferChoices[transfer].name;
  const double run = particles_per_run(stencil);
  const TransferKernels<Real> kernel = table.transfer[stencil][transfer];
  cases.push_back({"scatter" + pair, stencil, kChunk, scatter_work(stencil, transfer, run),
                   [=](Workpiece<Real>& piece) {
                     std::uint64_t rows = 0;
                     kernel.scatter(scatter_input(piece, stencil), piece.arena, rows);
                   },
                   [=](Workpiece<Real>& piece) { reference_scatter(piece, stencil, transfer); }});
  cases.push_back(
      {"gather" + pair, stencil, kChunk, gather_work(stencil, transfer, run),
       [=](Workpiece<Real>& piece) { kernel.gather(gather_input(piece, stencil, transfer), piece.arena); },
       [=](Workpiece<Real>& piece) {
         reference::gather(stencil, transfer, gather_input(piece, stencil, transfer), piece.arena);
       }});
}

}  // namespace

template <class Real>
void add_transfer_cases(const Kernels<Real>& table, std::vector<KernelCase<Real>>& cases) {
  for (std::size_t stencil = 0; stencil < kStencilFigures.size(); ++stencil) {
    for (std::size_t transfer = 0; transfer < kTransferFigures.size(); ++transfer) {
      add_pair(table, stencil, transfer, cases);
    }
    const auto interpolate = table.stencil[stencil].interpolate;
    cases.push_back(
        {std::string("interpolate/") + kStencilFigures[stencil].name, stencil, kChunk,
         interpolate_work(stencil, particles_per_run(stencil)),
         [=](Workpiece<Real>& piece) { interpolate(piece.particles(), -1, piece.arena, piece.before()); },
         [=](Workpiece<Real>& piece) {
           reference::interpolate(stencil, piece.particles(), -1, piece.arena, piece.before());
         }});
  }
}
template void add_transfer_cases(const Kernels<float>&, std::vector<KernelCase<float>>&);
template void add_transfer_cases(const Kernels<double>&, std::vector<KernelCase<double>>&);

}  // namespace repose
