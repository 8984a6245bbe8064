// Repose: the kernels of effects: those that shape how sand yields, and the volume that it has gained.
#include "bench/kernel_case.h"
#include "kernels/effect/cohesion.h"
#include "kernels/effect/hardening.h"
#include "kernels/effect/rate_friction.h"
#include "kernels/effect/volume_correction.h"
#include "kernels/reference/particles.h"
#include "kernels/reference/yield.h"

namespace repose {
namespace {

/// Some of the sand's strain pulls harder than this, Pa.
constexpr double kTension = 100.0;
/// The channel that stands for the plastic shear holds 1e-5, so the law forgets within that.
template <class Real>
constexpr HardeningConstants<Real> kHardening = {Real(0.6), Real(1.5e4), Real(2e5), Real(0.17), {}, Real(3.25)};
template <class Real>
constexpr RateConstants<Real> kRate = {Real(0.7), Real(0.279), Real(1e-4)};

template <class Real, class Kernel>
void strengthen(Workpiece<Real>& piece, Kernel kernel) {
  kernel(piece.strain(), piece.cohesion(), kRate<Real>, Real(SandNumbers::kDt), piece.yield_slope(), kChunk);
}

template <class Real, class Kernel>
void cut_tension(Workpiece<Real>& piece, Kernel kernel) {
  kernel(piece.strain(), HenckyConstants<Real>(Elasticity()), Real(kTension), piece.trace(), kChunk);
}

template <class Real>
void add_yield_cases(Target target, std::vector<KernelCase<Real>>& cases) {
  using Piece = Workpiece<Real>;
  cases.push_back(
      {"harden", 0, kChunk, harden_work<Real>(),
       [kernel = hardening_kernels<Real>(target).harden](Piece& piece) {
         kernel(piece.gained(), kHardening<Real>, piece.yield_slope(), kChunk);
       },
       [](Piece& piece) { reference::harden(piece.gained(), kHardening<Real>, piece.yield_slope(), kChunk); }});
  cases.push_back(
      {"strengthen", 0, kChunk, strengthen_work(),
       [kernel = rate_friction_kernels<Real>(target).strengthen](Piece& piece) { strengthen(piece, kernel); },
       [](Piece& piece) { strengthen(piece, reference::strengthen<Real>); }});
  cases.push_back(
      {"cut_tension", 0, kChunk, cut_tension_work<Real>(),
       [kernel = cohesion_kernels<Real>(target).cut_tension](Piece& piece) { cut_tension(piece, kernel); },
       [](Piece& piece) { cut_tension(piece, reference::cut_tension<Real>); }});
}

}  // namespace

template <class Real>
void add_effect_cases(Target target, std::vector<KernelCase<Real>>& cases) {
  using Piece = Workpiece<Real>;
  const auto& volume = volume_correction_kernels<Real>(target);
  cases.push_back(
      {"open_volume", 0, kChunk, open_volume_work(),
       [&volume](Piece& piece) { volume.open_volume(piece.strain(), piece.gained(), piece.trace(), kChunk); },
       [](Piece& piece) {
         reference::open_volume<Real>(piece.strain(), piece.gained(), piece.trace(), kChunk);
       }});
  cases.push_back(
      {"close_volume", 0, kChunk, close_volume_work(),
       [&volume](Piece& piece) { volume.close_volume(piece.strain(), piece.gained(), piece.trace(), kChunk); },
       [](Piece& piece) {
         reference::close_volume<Real>(piece.strain(), piece.gained(), piece.trace(), kChunk);
       }});
  add_yield_cases(target, cases);
}
template void add_effect_cases(Target, std::vector<KernelCase<float>>&);
template void add_effect_cases(Target, std::vector<KernelCase<double>>&);

}  // namespace repose
