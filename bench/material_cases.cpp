// Repose: trial strain, return map and stress of every material. What is measured against a reference has
// overloads below: where a material's elastic constants are, the work of its stress, and, if it yields, the
// references of its return maps and the work of them. A material without is timed by `scene_bench` alone.
#include <memory>

#include "bench/kernel_case.h"
#include "kernels/reference/material.h"
#include "kernels/reference/yield.h"

namespace repose {
namespace {

template <class Real>
void reference_return_map(const DruckerPragerConstants<Real>&, const MaterialInput<Real>& in) {
  reference::return_map_drucker_prager(in);
}
Work return_map_work(const DruckerPragerParameters&) {
  return return_map_drucker_prager_work();
}
template <class Real>
void reference_return_map_per_particle(const DruckerPragerConstants<Real>&, const MaterialInput<Real>& in,
                                       const YieldInput<Real>& surface) {
  reference::return_map_per_particle_drucker_prager(in, surface);
}
Work return_map_per_particle_work(const DruckerPragerParameters&) {
  return return_map_per_particle_drucker_prager_work();
}
template <class Real>
const HenckyConstants<Real>& elastic_part(const DruckerPragerConstants<Real>& constants) {
  return constants.elastic;
}
template <class Constants>
const Constants& elastic_part(const Constants& constants) {
  return constants;
}

template <class Real>
Work stress_work(const DruckerPragerParameters&) {
  return stress_hencky_work();
}
template <class Real>
Work stress_work(const HenckyParameters&) {
  return stress_hencky_work();
}
template <class Real>
Work stress_work(const NeoHookeanParameters&) {
  return stress_neo_hookean_work<Real>();
}

/// A call and the next one strain to and fro: a chunk that is worked on again and again stays near its strain.
template <class Real>
MaterialInput<Real> to_and_fro(Workpiece<Real>& piece) {
  const MaterialInput<Real> in = piece.material(nullptr);
  piece.dt = -piece.dt;
  return in;
}

template <class Parameters, class Real>
void add_material(const Parameters& parameters, const MaterialKernels<Real>& kernel,
                  std::vector<KernelCase<Real>>& cases) {
  using Constants = typename Parameters::template Constants<Real>;
  const auto constants = std::make_shared<const Constants>(parameters);
  const std::string of = std::string("/") + Parameters::kName;
  cases.push_back({"trial" + of, 0, kChunk, trial_work<Real>(),
                   [=](Workpiece<Real>& piece) { kernel.trial(to_and_fro(piece)); },
                   [=](Workpiece<Real>& piece) { reference::trial(to_and_fro(piece)); }});
  if constexpr (requires { return_map_work(parameters); }) {
    cases.push_back(
        {"return_map" + of, 0, kChunk, return_map_work(parameters),
         [=](Workpiece<Real>& piece) { kernel.return_map(piece.material(constants.get())); },
         [=](Workpiece<Real>& piece) { reference_return_map(*constants, piece.material(constants.get())); }});
    cases.push_back({"return_map_per_particle" + of, 0, kChunk, return_map_per_particle_work(parameters),
                     [=](Workpiece<Real>& piece) {
                       kernel.return_map_per_particle(piece.material(nullptr), piece.surface());
                     },
                     [=](Workpiece<Real>& piece) {
                       reference_return_map_per_particle(*constants, piece.material(nullptr), piece.surface());
                     }});
  }
  if constexpr (requires { stress_work<Real>(parameters); }) {
    cases.push_back({"stress" + of, 0, kChunk, stress_work<Real>(parameters),
                     [=](Workpiece<Real>& piece) { kernel.stress(piece.material(constants.get())); },
                     [=](Workpiece<Real>& piece) {
                       reference::stress(elastic_part(*constants), piece.material(nullptr));
                     }});
  }
}

}  // namespace

template <class Real>
void add_material_cases(const Kernels<Real>& table, std::vector<KernelCase<Real>>& cases) {
  [&]<std::size_t... k>(std::index_sequence<k...>) {
    (add_material(std::variant_alternative_t<k, MaterialParameters>(), table.material[k], cases), ...);
  }
  (std::make_index_sequence<std::variant_size_v<MaterialParameters>>());
}
template void add_material_cases(const Kernels<float>&, std::vector<KernelCase<float>>&);
template void add_material_cases(const Kernels<double>&, std::vector<KernelCase<double>>&);

}  // namespace repose
