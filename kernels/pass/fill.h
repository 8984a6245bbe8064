// Repose: what fills the tables of pass.h, one function for each file of this folder; nothing outside it
// includes this.
#pragma once

#include "kernels/pass/pass.h"
#include "kernels/pass/tables.h"

namespace repose {

using KernelTables = Precisions<Kernels>;

void fill_scatter(Target target, KernelTables& tables);
void fill_gather(Target target, KernelTables& tables);
void fill_material(Target target, KernelTables& tables);
void fill_particles(Target target, KernelTables& tables);
void fill_nodes(Target target, KernelTables& tables);
void fill_node_stiffness(Target target, KernelTables& tables);
void fill_stiffness(Target target, KernelTables& tables);
void fill_vectors(Target target, KernelTables& tables);

}  // namespace repose
