// Repose: the kernels over nodes: between an arena and the blocks it covers, and over the nodes of single
// blocks.
#include <algorithm>
#include <bit>

#include "bench/kernel_case.h"
#include "kernels/reference/nodes.h"

namespace repose {
namespace {

/// Blocks a call of a kernel that works on one block: they fit into the first cache level.
constexpr int kBlocks = 8;
constexpr double kLeastMass = 0.5;  // kg; empty nodes have none

/// Calls body(nodes of a block).
template <class Real, class Body>
void each_block(const Workpiece<Real>& piece, Body body) {
  for (int block = 0; block < kBlocks; ++block) body(piece.nodes + block * kBlockValues);
}

/// Calls body(table of 27 blocks).
template <class Real, class Body>
void with_blocks(const Workpiece<Real>& piece, Body body) {
  Real* blocks[kNeighbours];
  for (int k = 0; k < kNeighbours; ++k) blocks[k] = piece.nodes + k * kBlockValues;
  body(blocks);
}

template <class Real, class Kernel>
void normalize_blocks(Workpiece<Real>& piece, Kernel normalize) {
  double* half = piece.result;
  each_block(piece, [&](Real* nodes) {
    const std::uint64_t active = normalize(nodes, static_cast<Real>(kLeastMass));
    *half++ = static_cast<double>(active >> 32);
    *half++ = static_cast<double>(active & 0xffffffffu);
  });
}

template <class Real, class Kernel>
void accelerate_blocks(Workpiece<Real>& piece, Kernel accelerate) {
  const Real change[3] = {Real(1e-3), Real(-2e-3), Real(3e-3)};
  each_block(piece, [&](Real* nodes) { accelerate(nodes, change); });
}

template <class Real, class Kernel>
void bound_blocks(Workpiece<Real>& piece, Kernel bound) {
  std::fill_n(piece.result, 8, 0.0);
  each_block(piece, [&](Real* nodes) {
    VelocityBounds<Real> bounds;
    bound(nodes, bounds);
    for (int axis = 0; axis < 3; ++axis) {
      piece.result[axis] += double{bounds.low[axis]};
      piece.result[3 + axis] += double{bounds.high[axis]};
    }
    piece.result[6] += bounds.empty;
    piece.result[7] += bounds.finite;
  });
}

/// Loading may leave anything in rows that were not asked for.
template <class Real>
void clear_other_rows(Real* arena, std::uint64_t rows) {
  for (int row = 0; row < kArenaSide * kArenaSide; ++row) {
    if ((rows >> row & 1) == 0) std::fill_n(arena + row * kArenaRow, kArenaRow, Real(0));
  }
}

template <class Real>
void add_arena_cases(const Kernels<Real>& table, std::size_t stencil, std::vector<KernelCase<Real>>& cases) {
  using Piece = Workpiece<Real>;
  const StencilKernels<Real> kernel = table.stencil[stencil];
  const std::string of = std::string("/") + kStencilFigures[stencil].name;
  const std::uint64_t rows = rows_of_block(stencil);
  const std::size_t items = static_cast<std::size_t>(std::popcount(rows)) * kArenaSide;
  const auto add = [rows](auto function) {
    return
        [=](Piece& piece) { with_blocks(piece, [&](Real** blocks) { function(piece.arena, rows, blocks); }); };
  };
  cases.push_back({"add_arena" + of, stencil, items, add_arena_work(), add(kernel.add_arena),
                   add([stencil](Real* arena, std::uint64_t of_block, Real** blocks) {
                     reference::add_arena<Real>(stencil, arena, of_block, blocks);
                   })});
  cases.push_back({"load_arena" + of, stencil, items, load_arena_work(), add(kernel.load_arena),
                   add([stencil](Real* arena, std::uint64_t of_block, Real** blocks) {
                     reference::load_arena<Real>(stencil, arena, of_block, blocks);
                   }),
                   [rows](Piece& piece) { clear_other_rows(piece.arena, rows); }});
}

}  // namespace

template <class Real>
void add_node_cases(const Kernels<Real>& table, std::vector<KernelCase<Real>>& cases) {
  using Piece = Workpiece<Real>;
  for (std::size_t stencil = 0; stencil < kStencilFigures.size(); ++stencil)
    add_arena_cases(table, stencil, cases);
  constexpr std::size_t kItems = kBlocks * kBlockNodes;
  cases.push_back({"normalize", 0, kItems, normalize_work(),
                   [&table](Piece& piece) { normalize_blocks(piece, table.node.normalize); },
                   [](Piece& piece) { normalize_blocks(piece, reference::normalize<Real>); }});
  cases.push_back({"accelerate", 0, kItems, accelerate_work(),
                   [&table](Piece& piece) { accelerate_blocks(piece, table.node.accelerate); },
                   [](Piece& piece) { accelerate_blocks(piece, reference::accelerate<Real>); }});
  cases.push_back({"bound", 0, kItems, bound_work(),
                   [&table](Piece& piece) { bound_blocks(piece, table.node.bound); },
                   [](Piece& piece) { bound_blocks(piece, reference::bound<Real>); }});
}
template void add_node_cases(const Kernels<float>&, std::vector<KernelCase<float>>&);
template void add_node_cases(const Kernels<double>&, std::vector<KernelCase<double>>&);

}  // namespace repose
