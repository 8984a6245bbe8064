// Repose: what an implicit step asks of particles. With G = dt grad v at the particle, b = (I + G) b^n (I +
// G)^T its trial state and tau the Kirchhoff stress there, forces are f_i = -V0 S g_i, S = tau (I + G)^-T, g_i
// the gradient of node i's weight (Klar et al. 2016, eq. 23, pulled back to the step's begin). Its change is
// linear in dG,
//   dS = (d tau - tau dL^T)(I + G)^-T,  dL = dG (I + G)^-1,
// and in the axes U of b, scaled by the stretches s, it takes 15 numbers beside U and Q = (I + G)^-1 U diag(s)
// (supplement, algorithm 2): no tensor with 81 entries is ever built.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/pass/stiffness.cpp"
#include "kernels/base/targets.h"

#include "hwy/foreach_target.h"
#include "hwy/highway.h"

#include "kernels/base/eigen_sym3-inl.h"
#include "kernels/base/matrix_arrays-inl.h"
#include "kernels/material/materials.h"
#include "kernels/material/response-inl.h"
#include "kernels/pass/fill.h"
#include "kernels/pass/own_channels-inl.h"

HWY_BEFORE_NAMESPACE();
namespace repose {
namespace HWY_NAMESPACE {
namespace {

/// A particle that a step would flatten to this share of its volume has no stress that could be trusted.
constexpr double kLeastDeterminant = 0.01;

template <class N>
REPOSE_INLINE Mat3<N> inverse(const Mat3<N>& a) {
  const auto minor = [&](int r0, int c0, int r1, int c1) {
    return fnma(a.m[r0][c1], a.m[r1][c0], a.m[r0][c0] * a.m[r1][c1]);
  };
  const N scale = N(Scalar<N>(1)) / determinant(a);
  Mat3<N> out;
  HWY_UNROLL(3)
  for (int r = 0; r < 3; ++r) {
    HWY_UNROLL(3)
    for (int c = 0; c < 3; ++c) {
      out.m[c][r] = scale * minor((r + 1) % 3, (c + 1) % 3, (r + 2) % 3, (c + 2) % 3);
    }
  }
  return out;
}

/// I + dt grad v
template <class T>
REPOSE_INLINE Mat3<Pack<T>> load_map(const T* const gradient[9], T dt, std::size_t first, std::size_t lanes) {
  Mat3<Pack<T>> step = load_mat3<T>(gradient, first, lanes);
  HWY_UNROLL(9)
  for (int k = 0; k < 9; ++k) {
    step.m[k / 3][k % 3] = fma(Pack<T>(dt), step.m[k / 3][k % 3], Pack<T>(T(k % 4 == 0 ? 1 : 0)));
  }
  return step;
}

/// matrix <- tau (I + dt grad v)^-T; whether no det(I + dt grad v) is nearly zero or less.
template <class T>
bool pull_back(const T* const stress[6], const T* const gradient[9], T dt, T* const matrix[9],
               std::size_t count) {
  bool upright = true;
  for (const auto [first, lanes] : packs<T>(count)) {
    const Mat3<Pack<T>> map = load_map<T>(gradient, dt, first, lanes), back = inverse(map);
    upright = upright && !any(!(determinant(map) > Pack<T>(T(kLeastDeterminant))));
    const Sym3<Pack<T>> t = load_sym3<T>(stress, first, lanes);
    const Pack<T> tau[3][3] = {{t.xx, t.xy, t.xz}, {t.xy, t.yy, t.yz}, {t.xz, t.yz, t.zz}};
    Mat3<Pack<T>> s;
    HWY_UNROLL(3)
    for (int r = 0; r < 3; ++r) {
      HWY_UNROLL(3)
      for (int c = 0; c < 3; ++c) {
        s.m[r][c] = fma(tau[r][0], back.m[c][0], fma(tau[r][1], back.m[c][1], tau[r][2] * back.m[c][2]));
      }
    }
    store_mat3(s, matrix, first, lanes);
  }
  return upright;
}

/// Where the numbers of the particles from `first` on stand: packs of any width find theirs in groups of 16.
template <class T>
REPOSE_INLINE T* tangent_at(T* tangent, std::size_t first) {
  return tangent + (first / kTangentGroup) * kTangentValues * kTangentGroup + first % kTangentGroup;
}

template <class T>
REPOSE_INLINE void store_tangent(const Eigen3<Pack<T>>& axes, const Mat3<Pack<T>>& back,
                                 const Response<Pack<T>>& r, T* to) {
  using P = Pack<T>;
  P stretch[3], per_stretch[3];
  HWY_UNROLL(3)
  for (int i = 0; i < 3; ++i) {
    stretch[i] = expm1(axes.value[i]) + P(T(1));
    per_stretch[i] = P(T(1)) / stretch[i];
  }
  HWY_UNROLL(3)
  for (int i = 0; i < 3; ++i) {
    HWY_UNROLL(3)
    for (int j = 0; j < 3; ++j) {
      axes.u[i][j].store(to + static_cast<std::size_t>(3 * i + j) * kTangentGroup);
      const P q = fma(back.m[i][0], axes.u[0][j], fma(back.m[i][1], axes.u[1][j], back.m[i][2] * axes.u[2][j]));
      (q * stretch[j]).store(to + static_cast<std::size_t>(9 + 3 * i + j) * kTangentGroup);
      const P slope = i == j ? r.slope[i][i] - r.tau[i] : r.slope[i][j];
      (slope * per_stretch[i] * per_stretch[j])
          .store(to + static_cast<std::size_t>(18 + 3 * i + j) * kTangentGroup);
    }
  }
  HWY_UNROLL(3)
  for (int k = 0; k < 3; ++k) {
    const int i = kPairs[k][0], j = kPairs[k][1];
    r.shear[k].store(to + static_cast<std::size_t>(27 + k) * kTangentGroup);
    // theta lambda_i - tau_i = theta lambda_j - tau_j; of the two the mean is symmetric to the last bit.
    const P one_way = fma(r.shear[k] * stretch[i], stretch[i], -r.tau[i]),
            other_way = fma(r.shear[k] * stretch[j], stretch[j], -r.tau[j]);
    (P(T(0.5)) * (one_way + other_way) * per_stretch[i] * per_stretch[j])
        .store(to + static_cast<std::size_t>(30 + k) * kTangentGroup);
  }
}

/// How a law answers in a mode at trial strains along their axes.
template <class Law, TangentMode mode, class T>
REPOSE_INLINE Response<Pack<T>> answer(const TangentInput<T>& in, const Pack<T> (&eps)[3], std::size_t first,
                                       std::size_t lanes) {
  using P = Pack<T>;
  constexpr bool kWithin = mode == TangentMode::kExact || mode == TangentMode::kProjected;
  constexpr bool kWhole = mode == TangentMode::kExact;
  const auto& constants = *static_cast<const typename Law::template Constants<T>*>(in.material.constants);
  if constexpr (!Law::Parameters::kYields) {
    if constexpr (kOwn<Law> == 0) return Law::respond(constants, eps);
    if constexpr (kOwn<Law> != 0)
      return Law::respond(constants, eps, load_own<Law>(in.material, first, lanes).number);
  } else if constexpr (mode == TangentMode::kUnilateral && Law::Parameters::kHasCone) {
    return Law::unilateral_response(constants, in.unilateral, eps);
  } else if constexpr (!kWithin) {
    return Law::elastic_response(constants, eps);
  } else if constexpr (Law::Parameters::kHasCone) {
    const auto number = [first, lanes](const T* from, T without) HWY_ATTR {
      return from == nullptr ? P(without) : P::load_first(from + first, lanes);
    };
    const YieldSurface<P> surface{number(in.surface.yield_slope, constants.yield_slope),
                                  number(in.surface.cohesion, T(0)), number(in.surface.dilatancy, T(0))};
    return Law::template respond<kWhole>(constants, eps, surface);
  } else if constexpr (kOwn<Law> == 0) {
    return Law::template respond<kWhole>(constants, eps);
  } else {
    return Law::template respond<kWhole>(constants, eps, load_own<Law>(in.material, first, lanes).number);
  }
}

template <class Law, TangentMode mode, class T>
void linearize(const TangentInput<T>& in) {
  using P = Pack<T>;
  for (const auto [first, lanes] : packs<T>(in.material.count)) {
    const Eigen3<P> axes = eigen_sym3(load_sym3<T>(in.material.strain, first, lanes));
    const Response<P> response = answer<Law, mode>(in, axes.value, first, lanes);
    const auto back = inverse(load_map<T>(in.material.gradient, in.material.dt, first, lanes));
    store_tangent(axes, back, response, tangent_at(in.tangent, first));
  }
}

/// Where the next linear model is made (docs/math.md, 45): with eps the trial strain and e the elastic strain
/// of the stress that was predicted, at the eps' of
///   Z(eps') + theta eps' = e + theta eps,
/// which has Z(eps') = Z((e + theta eps) / (1 + theta)), for a return map keeps the direction of the deviator,
/// and in the cone the trace too.
template <class Law, class T>
void linearization_point(const TangentInput<T>& in, const T* const predicted[9], T* const offset[9]) {
  using P = Pack<T>;
  static constexpr int kSymmetric[6][2] = {{0, 0}, {0, 1}, {0, 2}, {1, 1}, {1, 2}, {2, 2}};
  constexpr T kTheta = T(kTrialWeight);
  const auto& constants = *static_cast<const typename Law::template Constants<T>*>(in.material.constants);
  const P theta(kTheta), per_theta(T(1) / kTheta), share(T(1) / (T(1) + kTheta)), half(T(0.5));
  for (const auto [first, lanes] : packs<T>(in.material.count)) {
    const Sym3<P> trial = load_sym3<T>(in.material.strain, first, lanes);
    const Mat3<P> map = load_map<T>(in.material.gradient, in.material.dt, first, lanes);
    const Mat3<P> s = load_mat3<T>(predicted, first, lanes);
    const auto product = [&](int r, int c) HWY_ATTR {
      return fma(s.m[r][0], map.m[c][0], fma(s.m[r][1], map.m[c][1], s.m[r][2] * map.m[c][2]));
    };
    P tau[6];
    HWY_UNROLL(6)
    for (int k = 0; k < 6; ++k) {
      const int r = kSymmetric[k][0], c = kSymmetric[k][1];
      tau[k] = half * (product(r, c) + product(c, r));
    }
    const Sym3<P> stress{tau[0], tau[1], tau[2], tau[3], tau[4], tau[5]};
    const Sym3<P> sum = fma(theta, trial, Law::elastic_strain(constants, stress));
    Sym3<P> returned;
    if (in.surface.yield_slope == nullptr) {
      returned = Law::return_map(constants, share * sum);
    } else {
      const auto number = [first = first, lanes = lanes](const T* from)
                              HWY_ATTR { return P::load_first(from + first, lanes); };
      returned = Law::return_map_per_particle(share * sum, number(in.surface.yield_slope),
                                              number(in.surface.cohesion), number(in.surface.dilatancy))
                     .strain;
    }
    Sym3<P> point = per_theta * fma(P(T(-1)), returned, sum);
    // A cone looks the same from everywhere along a line through its tip: strains need not leave what exp
    // takes.
    const P length = sqrt(square_norm(point));
    point = (P(T(1)) / max(length, P(T(1)))) * point;
    const Sym3<P> apart = fma(P(T(-1)), point, trial);
    const P d[3][3] = {
        {apart.xx, apart.xy, apart.xz}, {apart.xy, apart.yy, apart.yz}, {apart.xz, apart.yz, apart.zz}};
    Mat3<P> change;
    HWY_UNROLL(3)
    for (int r = 0; r < 3; ++r) {
      HWY_UNROLL(3)
      for (int c = 0; c < 3; ++c)
        change.m[r][c] = fma(d[r][0], map.m[0][c], fma(d[r][1], map.m[1][c], d[r][2] * map.m[2][c]));
    }
    store_mat3(change, offset, first, lanes);
    store_sym3<T>(point, in.material.strain, first, lanes);
  }
}

/// stress <- that of the unilateral energy at the trial strain
template <class Law, class T>
void unilateral_stress(const MaterialInput<T>& in, const UnilateralConstants<T>& unilateral) {
  const auto& constants = *static_cast<const typename Law::template Constants<T>*>(in.constants);
  for (const auto [first, lanes] : packs<T>(in.count)) {
    const auto strain = load_sym3<T>(in.strain, first, lanes);
    store_sym3<T>(Law::unilateral_stress(constants, unilateral, strain), in.stress, first, lanes);
  }
}

/// matrix <- dS = U T Q^T of the change dG, with L = U^T dG Q.
template <class T>
void apply_tangent(const T* tangent, const T* const gradient[9], T* const matrix[9], std::size_t count) {
  using P = Pack<T>;
  for (const auto [first, lanes] : packs<T>(count)) {
    const T* from = tangent_at(tangent, first);
    const auto number = [from](int k)
                            HWY_ATTR { return P::load(from + static_cast<std::size_t>(k) * kTangentGroup); };
    const Mat3<P> g = load_mat3<T>(gradient, first, lanes);
    P u[3][3], q[3][3], half[3][3], l[3][3], t[3][3];
    HWY_UNROLL(9)
    for (int k = 0; k < 9; ++k) {
      u[k / 3][k % 3] = number(k);
      q[k / 3][k % 3] = number(9 + k);
    }
    HWY_UNROLL(3)
    for (int r = 0; r < 3; ++r) {
      HWY_UNROLL(3)
      for (int c = 0; c < 3; ++c)
        half[r][c] = fma(g.m[r][0], q[0][c], fma(g.m[r][1], q[1][c], g.m[r][2] * q[2][c]));
    }
    HWY_UNROLL(3)
    for (int i = 0; i < 3; ++i) {
      HWY_UNROLL(3)
      for (int j = 0; j < 3; ++j)
        l[i][j] = fma(u[0][i], half[0][j], fma(u[1][i], half[1][j], u[2][i] * half[2][j]));
    }
    HWY_UNROLL(3)
    for (int i = 0; i < 3; ++i) {
      const int a = 18 + 3 * i;
      t[i][i] = fma(number(a), l[0][0], fma(number(a + 1), l[1][1], number(a + 2) * l[2][2]));
      const int r = kPairs[i][0], c = kPairs[i][1];
      const P theta = number(27 + i), beta = number(30 + i);
      t[r][c] = fma(theta, l[r][c], beta * l[c][r]);
      t[c][r] = fma(theta, l[c][r], beta * l[r][c]);
    }
    HWY_UNROLL(3)
    for (int i = 0; i < 3; ++i) {
      HWY_UNROLL(3)
      for (int c = 0; c < 3; ++c) half[i][c] = fma(t[i][0], q[c][0], fma(t[i][1], q[c][1], t[i][2] * q[c][2]));
    }
    Mat3<P> s;
    HWY_UNROLL(3)
    for (int r = 0; r < 3; ++r) {
      HWY_UNROLL(3)
      for (int c = 0; c < 3; ++c) {
        s.m[r][c] = fma(u[r][0], half[0][c], fma(u[r][1], half[1][c], u[r][2] * half[2][c]));
      }
    }
    store_mat3(s, matrix, first, lanes);
  }
}

template <class Law, class T>
void fill_tangents_of(MaterialKernels<T>& table) {
  table.linearize[0] = linearize<Law, TangentMode::kExact, T>;
  table.linearize[1] = linearize<Law, TangentMode::kProjected, T>;
  table.linearize[2] = linearize<Law, TangentMode::kLagged, T>;
  table.linearize[3] = linearize<Law, TangentMode::kUnilateral, T>;
  if constexpr (Law::Parameters::kHasCone) {
    table.unilateral_stress = unilateral_stress<Law, T>;
    table.linearization_point = linearization_point<Law, T>;
  }
}

template <class T>
void fill_precision(Kernels<T>& table) {
  table.tangent.pull_back = pull_back<T>;
  table.tangent.apply = apply_tangent<T>;
  [&]<std::size_t... k>(std::index_sequence<k...>) {
    (fill_tangents_of<std::tuple_element_t<k, Materials>>(table.material[k]), ...);
  }
  (std::make_index_sequence<std::tuple_size_v<Materials>>());
}

void fill(KernelTables& tables) {
  fill_precision(tables.single);
  fill_precision(tables.dual);
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace repose
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace repose {
REPOSE_DEFINE_FILL(stiffness, Kernels)
}  // namespace repose
#endif
