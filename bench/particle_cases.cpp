// Repose: the kernels over particles that belong to no material, no transfer and no effect.
#include "bench/kernel_case.h"
#include "kernels/reference/particles.h"

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
void look(Workpiece<Real>& piece, Kernel first_failed) {
  piece.result[0] = static_cast<double>(first_failed(piece.moving(), piece.gradient(), kChunk, piece.dt,
                                                     static_cast<Real>(SandNumbers::kSpacing)));
}

}  // namespace

template <class Real>
void add_particle_cases(const Kernels<Real>& table, std::vector<KernelCase<Real>>& cases) {
  using Piece = Workpiece<Real>;
  cases.push_back(
      {"advance", 0, kChunk, advance_work(),
       [&table](Piece& piece) {
         move(piece, [&](Real scale, Motion<Real>& motion) {
           table.particle.advance(piece.particles(), piece.moving(), piece.gradient(), scale, motion);
         });
       },
       [](Piece& piece) {
         move(piece, [&](Real scale, Motion<Real>& motion) {
           reference::advance<Real>(piece.particles(), piece.moving(), piece.gradient(), scale, motion);
         });
       }});
  cases.push_back({"first_failed", 0, kChunk, first_failed_work(),
                   [&table](Piece& piece) { look(piece, table.particle.first_failed); },
                   [](Piece& piece) { look(piece, reference::first_failed<Real>); }});
}
template void add_particle_cases(const Kernels<float>&, std::vector<KernelCase<float>>&);
template void add_particle_cases(const Kernels<double>&, std::vector<KernelCase<double>>&);

}  // namespace repose
