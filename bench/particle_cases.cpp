// Repose: the kernels over particles that belong to no material and no transfer.
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
void look(Workpiece<Real>& piece, Kernel inspect) {
  piece.result[0] = static_cast<double>(
      inspect(piece.moving(), piece.gradient(), kChunk, piece.dt, static_cast<Real>(SandNumbers::kSpacing)));
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
}
template void add_particle_cases(const Kernels<float>&, std::vector<KernelCase<float>>&);
template void add_particle_cases(const Kernels<double>&, std::vector<KernelCase<double>>&);

}  // namespace repose
