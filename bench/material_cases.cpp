// Repose: trial strain, return map and stress of every material. A new one needs the overloads below: where its
// elastic constants are, the work of its stress, and, if it yields, the references of its return maps and the
// work of them.
#include <memory>

#include "bench/kernel_case.h"
#include "kernels/reference/material.h"
#include "kernels/reference/yield.h"

namespace repose {
namespace {

template <class Real>
void reference_project(const DruckerPragerConstants<Real>&, const MaterialInput<Real>& in) {
  reference::project_drucker_prager(in);
}
Work project_work(const DruckerPragerParameters&) {
  return project_drucker_prager_work();
}
template <class Real>
void reference_project_shaped(const DruckerPragerConstants<Real>&, const MaterialInput<Real>& in,
                              const YieldInput<Real>& surface) {
  reference::project_shaped_drucker_prager(in, surface);
}
Work project_shaped_work(const DruckerPragerParameters&) {
  return project_shaped_drucker_prager_work();
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
  if constexpr (Parameters::kYields) {
    cases.push_back(
        {"project" + of, 0, kChunk, project_work(parameters),
         [=](Workpiece<Real>& piece) { kernel.project(piece.material(constants.get())); },
         [=](Workpiece<Real>& piece) { reference_project(*constants, piece.material(constants.get())); }});
    cases.push_back(
        {"project_shaped" + of, 0, kChunk, project_shaped_work(parameters),
         [=](Workpiece<Real>& piece) { kernel.project_shaped(piece.material(nullptr), piece.surface()); },
         [=](Workpiece<Real>& piece) {
           reference_project_shaped(*constants, piece.material(nullptr), piece.surface());
         }});
  }
  cases.push_back(
      {"stress" + of, 0, kChunk, stress_work<Real>(parameters),
       [=](Workpiece<Real>& piece) { kernel.stress(piece.material(constants.get())); },
       [=](Workpiece<Real>& piece) { reference::stress(elastic_part(*constants), piece.material(nullptr)); }});
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
