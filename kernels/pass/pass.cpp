// Repose: the tables of the kernels that belong to no effect.
#include "kernels/pass/pass.h"

#include "kernels/pass/fill.h"

namespace repose {

template <class Real>
const Kernels<Real>& kernels(Target target) {
  static const FamilyTables<Kernels> tables({fill_scatter, fill_gather, fill_material, fill_particles,
                                             fill_node_stiffness, fill_stiffness, fill_nodes, fill_vectors});
  return tables.of<Real>(target);
}
template const Kernels<float>& kernels<float>(Target);
template const Kernels<double>& kernels<double>(Target);

}  // namespace repose
