// Repose: the list of specimens of materials; see kernels/material/materials.h, which includes it where
// REPOSE_SPECIMENS is defined.
#ifndef REPOSE_TESTS_SPECIMENS_MATERIALS_H_LIST
#define REPOSE_TESTS_SPECIMENS_MATERIALS_H_LIST
#define REPOSE_SPECIMEN_MATERIALS(X) X(VonMises) X(Tracked)
#endif

#include "tests/specimens/tracked.h"
#include "tests/specimens/von_mises.h"
