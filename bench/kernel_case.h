// Repose: a kernel as kernel_bench sees it: called on a workpiece, beside the reference that does the same to
// another one. What a kernel has done is whatever differs in the arrays and results of its workpiece.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "bench/sand.h"
#include "bench/work.h"
#include "kernels/pass/pass.h"

namespace repose {

template <class Real>
struct KernelCase {
  std::string name;            ///< such as "scatter/quadratic/mls_apic"
  std::size_t stencil = 0;     ///< for which the particles are in order
  std::size_t items = kChunk;  ///< particles or nodes a call
  Work work;                   ///< of one of them
  std::function<void(Workpiece<Real>&)> kernel;
  std::function<void(Workpiece<Real>&)> reference;
  std::function<void(Workpiece<Real>&)> forget = {};  ///< if any: clears what the kernel may leave as it likes
};

/// The cases of one table of kernels, appended; they keep a reference to the table.
template <class Real>
void add_transfer_cases(const Kernels<Real>& table, std::vector<KernelCase<Real>>& cases);
template <class Real>
void add_material_cases(const Kernels<Real>& table, std::vector<KernelCase<Real>>& cases);
template <class Real>
void add_particle_cases(const Kernels<Real>& table, std::vector<KernelCase<Real>>& cases);
template <class Real>
void add_effect_cases(Target target, std::vector<KernelCase<Real>>& cases);
template <class Real>
void add_node_cases(const Kernels<Real>& table, std::vector<KernelCase<Real>>& cases);

template <class Real>
std::vector<KernelCase<Real>> all_cases(Target target) {
  std::vector<KernelCase<Real>> cases;
  const Kernels<Real>& table = kernels<Real>(target);
  add_transfer_cases(table, cases);
  add_material_cases(table, cases);
  add_particle_cases(table, cases);
  add_effect_cases(target, cases);
  add_node_cases(table, cases);
  return cases;
}

}  // namespace repose
