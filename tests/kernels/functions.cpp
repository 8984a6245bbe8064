// Repose tests: compiles the functions of functions.h for every instruction set, as Highway's foreach_target
// does for the kernels themselves.
#include "tests/kernels/functions.h"

#include <type_traits>

#include "tests/kernels/samples.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tests/kernels/functions.cpp"
#include "kernels/base/targets.h"

#include "hwy/foreach_target.h"
#include "hwy/highway.h"

#include "kernels/base/matrix_function-inl.h"
#include "kernels/layout/stencil.h"
#include "kernels/material/hencky.h"

HWY_BEFORE_NAMESPACE();
namespace repose {
namespace HWY_NAMESPACE {
namespace {

template <class N>
constexpr std::size_t lanes_of() {
  if constexpr (std::is_floating_point_v<N>) {
    return 1;
  } else {
    return N::size();
  }
}

template <class N>
N read(const Scalar<N>* from) {
  if constexpr (std::is_floating_point_v<N>) {
    return *from;
  } else {
    return N::load(from);
  }
}

template <class N>
void write(N value, Scalar<N>* to) {
  if constexpr (std::is_floating_point_v<N>) {
    *to = value;
  } else {
    value.store(to);
  }
}

/// Calls Function::apply(const N (&)[inputs], N (&)[outputs]) on all entries; the last pack repeats its last
/// entry.
template <class Function, class N>
void map(const Scalar<N>* from, Scalar<N>* to, std::size_t count) {
  using T = Scalar<N>;
  constexpr std::size_t kLanes = lanes_of<N>(), kInputs = Function::kInputs, kOutputs = Function::kOutputs;
  for (std::size_t first = 0; first < count; first += kLanes) {
    T lanes[kLanes];
    N in[kInputs], out[kOutputs];
    for (std::size_t k = 0; k < kInputs; ++k) {
      for (std::size_t lane = 0; lane < kLanes; ++lane) {
        const std::size_t entry = first + lane < count ? first + lane : count - 1;
        lanes[lane] = from[entry * kInputs + k];
      }
      in[k] = read<N>(lanes);
    }
    Function::template apply<N>(in, out);
    for (std::size_t k = 0; k < kOutputs; ++k) {
      write<N>(out[k], lanes);
      for (std::size_t lane = 0; lane < kLanes && first + lane < count; ++lane) {
        to[(first + lane) * kOutputs + k] = lanes[lane];
      }
    }
  }
}

template <class N>
Sym3<N> symmetric(const N* a) {
  return {a[0], a[1], a[2], a[3], a[4], a[5]};
}

template <class N>
void unpack(const Sym3<N>& a, N* out) {
  out[0] = a.xx, out[1] = a.xy, out[2] = a.xz, out[3] = a.yy, out[4] = a.yz, out[5] = a.zz;
}

template <class N>
Mat3<N> matrix(const N* a) {
  return {{{a[0], a[1], a[2]}, {a[3], a[4], a[5]}, {a[6], a[7], a[8]}}};
}

struct Log1p {
  static constexpr std::size_t kInputs = 1, kOutputs = 1;
  template <class N>
  static void apply(const N* in, N* out) {
    out[0] = log1p(in[0]);
  }
};

struct Expm1 {
  static constexpr std::size_t kInputs = 1, kOutputs = 1;
  template <class N>
  static void apply(const N* in, N* out) {
    out[0] = expm1(in[0]);
  }
};

struct EigenSym3 {
  static constexpr std::size_t kInputs = 6, kOutputs = 12;
  template <class N>
  static void apply(const N* in, N* out) {
    const Eigen3<N> result = eigen_sym3(symmetric(in));
    for (int k = 0; k < 3; ++k) out[k] = result.value[k];
    for (int k = 0; k < 9; ++k) out[3 + k] = result.u[k / 3][k % 3];
  }
};

struct HalfLog1p {
  static constexpr std::size_t kInputs = 6, kOutputs = 6;
  template <class N>
  static void apply(const N* in, N* out) {
    unpack(half_log1p(symmetric(in), kSmallestStretch<Scalar<N>> * kSmallestStretch<Scalar<N>>), out);
  }
};

struct Expm1Twice {
  static constexpr std::size_t kInputs = 6, kOutputs = 6;
  template <class N>
  static void apply(const N* in, N* out) {
    unpack(expm1_twice(symmetric(in)), out);
  }
};

struct PushForward {
  static constexpr std::size_t kInputs = 15, kOutputs = 6;
  template <class N>
  static void apply(const N* in, N* out) {
    unpack(push_forward(matrix(in), symmetric(in + 9)), out);
  }
};

struct Determinant {
  static constexpr std::size_t kInputs = 9, kOutputs = 1;
  template <class N>
  static void apply(const N* in, N* out) {
    out[0] = determinant(matrix(in));
  }
};

template <class Stencil>
struct WeightsOf {
  static constexpr std::size_t kInputs = 1, kOutputs = 4;
  template <class N>
  static void apply(const N* in, N* out) {
    N w[4];
    Weights<Stencil, N>{in[0]}.value(w);
    std::copy_n(w, 4, out);
  }
};

template <class Stencil>
struct SlopesOf {
  static constexpr std::size_t kInputs = 1, kOutputs = 4;
  template <class N>
  static void apply(const N* in, N* out) {
    N d[4];
    Weights<Stencil, N>{in[0]}.slope(d);
    std::copy_n(d, 4, out);
  }
};

template <class N, class... Stencil>
Functions<Scalar<N>> functions_of(const char* name, std::tuple<Stencil...>) {
  return {name,
          map<Log1p, N>,
          map<Expm1, N>,
          map<EigenSym3, N>,
          map<HalfLog1p, N>,
          map<Expm1Twice, N>,
          map<PushForward, N>,
          map<Determinant, N>,
          {map<WeightsOf<Stencil>, N>...},
          {map<SlopesOf<Stencil>, N>...}};
}

template <class N>
Functions<Scalar<N>> functions_of(const char* name) {
  return functions_of<N>(name, Stencils{});
}

void fill(const char* name, Functions<float>& single, Functions<double>& dual) {
  single = functions_of<Pack<float>>(name);
  dual = functions_of<Pack<double>>(name);
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace repose
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace repose {
HWY_EXPORT(fill);

namespace {

struct AllFunctions {
  std::vector<Functions<float>> single{HWY_NAMESPACE::functions_of<float>("scalar")};
  std::vector<Functions<double>> dual{HWY_NAMESPACE::functions_of<double>("scalar")};

  AllFunctions() {
    constexpr std::int64_t kBits[kTargets] = {HWY_STATIC_TARGET, HWY_AVX2, HWY_AVX3};
    for (const Target target : supported_targets()) {
      hwy::ChosenTarget chosen;
      chosen.Update(kBits[static_cast<int>(target)]);
      (*(HWY_DISPATCH_TABLE(fill)[chosen.GetIndex()]))(target_name(target), single.emplace_back(),
                                                       dual.emplace_back());
    }
  }
};

const AllFunctions& everything() {
  static const AllFunctions all;
  return all;
}

}  // namespace

template <>
const std::vector<Functions<float>>& all_functions<float>() {
  return everything().single;
}
template <>
const std::vector<Functions<double>>& all_functions<double>() {
  return everything().dual;
}

}  // namespace repose
#endif
