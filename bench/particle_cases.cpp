// Repose: the kernels over particles that belong to no material and no transfer, and those that shape how sand
// yields.
#include "bench/kernel_case.h"
#include "kernels/reference/particles.h"
#include "kernels/reference/yield.h"

namespace repose {
namespace {

/// Calls body(cells per velocity, motion); a call and the next one move to and fro, so that particles stay.
template <class Real, class Body>
void move(Workpiece<Real>& piece, Body body) {
  Motion<Real> motion;
  body(piece.dt / static_cast<Real>(SandNumbers::kSpacing), motion);
  piece.dt = -piece.dt;
  const Real found[] = {motion.speed_squared, motion.gradient_squared, motion.lowest, motion.highest};
  std::copy_n(found, 4, piece.result);
}

/// No particle breaks a limit, so all are looked at.
template <class Real, class Kernel>
void look(Workpiece<Real>& piece, Kernel inspect) {
  piece.result[0] = static_cast<double>(
      inspect(piece.moving(), piece.gradient(), kChunk, piece.dt, static_cast<Real>(SandNumbers::kSpacing)));
}

/// Some of the sand's strain pulls harder than this, Pa.
constexpr double kTension = 100.0;
/// The channel that stands for the plastic shear holds 1e-5, so the law forgets within that.
template <class Real>
constexpr HardeningConstants<Real> kHardening = {Real(0.6), Real(1.5e4), Real(2e5), Real(0.17), {}, Real(3.25)};
template <class Real>
constexpr RateConstants<Real> kRate = {Real(0.7), Real(0.279), Real(1e-4)};

template <class Real, class Kernel>
void quicken(Workpiece<Real>& piece, Kernel kernel) {
  kernel(piece.strain(), piece.cohesion(), kRate<Real>, Real(SandNumbers::kDt), piece.cone(), kChunk);
}

template <class Real, class Kernel>
void cut_tension(Workpiece<Real>& piece, Kernel kernel) {
  kernel(piece.strain(), HenckyConstants<Real>(Elasticity()), Real(kTension), piece.trace(), kChunk);
}

template <class Real>
void add_yield_cases(const Kernels<Real>& table, std::vector<KernelCase<Real>>& cases) {
  using Piece = Workpiece<Real>;
  cases.push_back(
      {"harden", 0, kChunk, harden_work<Real>(),
       [&table](Piece& piece) { table.harden(piece.gained(), kHardening<Real>, piece.cone(), kChunk); },
       [](Piece& piece) { reference::harden(piece.gained(), kHardening<Real>, piece.cone(), kChunk); }});
  cases.push_back({"quicken", 0, kChunk, quicken_work(),
                   [&table](Piece& piece) { quicken(piece, table.quicken); },
                   [](Piece& piece) { quicken(piece, reference::quicken<Real>); }});
  cases.push_back({"cut_tension", 0, kChunk, cut_tension_work<Real>(),
                   [&table](Piece& piece) { cut_tension(piece, table.cut_tension); },
                   [](Piece& piece) { cut_tension(piece, reference::cut_tension<Real>); }});
}

}  // namespace

template <class Real>
void add_particle_cases(const Kernels<Real>& table, std::vector<KernelCase<Real>>& cases) {
  using Piece = Workpiece<Real>;
  cases.push_back({"advance", 0, kChunk, advance_work(),
                   [&table](Piece& piece) {
                     move(piece, [&](Real scale, Motion<Real>& motion) {
                       table.advance(piece.particles(), piece.moving(), piece.gradient(), scale, motion);
                     });
                   },
                   [](Piece& piece) {
                     move(piece, [&](Real scale, Motion<Real>& motion) {
                       reference::advance<Real>(piece.particles(), piece.moving(), piece.gradient(), scale,
                                                motion);
                     });
                   }});
  cases.push_back({"inspect", 0, kChunk, inspect_work(), [&table](Piece& piece) { look(piece, table.inspect); },
                   [](Piece& piece) { look(piece, reference::inspect<Real>); }});
  cases.push_back(
      {"open_volume", 0, kChunk, open_volume_work(),
       [&table](Piece& piece) { table.open_volume(piece.strain(), piece.gained(), piece.trace(), kChunk); },
       [](Piece& piece) {
         reference::open_volume<Real>(piece.strain(), piece.gained(), piece.trace(), kChunk);
       }});
  cases.push_back(
      {"close_volume", 0, kChunk, close_volume_work(),
       [&table](Piece& piece) { table.close_volume(piece.strain(), piece.gained(), piece.trace(), kChunk); },
       [](Piece& piece) {
         reference::close_volume<Real>(piece.strain(), piece.gained(), piece.trace(), kChunk);
       }});
  add_yield_cases(table, cases);
}
template void add_particle_cases(const Kernels<float>&, std::vector<KernelCase<float>>&);
template void add_particle_cases(const Kernels<double>&, std::vector<KernelCase<double>>&);

}  // namespace repose
