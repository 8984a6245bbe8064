// Repose: the one SIMD vocabulary, on Highway: Pack, one register of particles side by side; Row, four
// neighbouring nodes along z, each [mass, x, y, z]; and the words of Pack for one number. Every operation is
// lane by lane or sums in an order written here, so AVX2 and AVX-512 give the same bits (both fuse; the
// portable baseline rounds its multiply-adds twice and gives others). Nothing but these files names Highway's
// operations. For kernels, once per instruction set; the parts have guards for that, so this page needs none.
#include "kernels/base/simd_pack-inl.h"
#include "kernels/base/simd_row-inl.h"
#include "kernels/base/simd_scalar-inl.h"
