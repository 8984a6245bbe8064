#include "engine/effect/age.h"

namespace repose {

std::vector<Example> Age::examples() {
  return {{"age", {}, {"age={}"}}};
}

void Age::declare(Fields& fields) {
  fields.object("age", enabled, false,
                "particles remember when they began, for the attribute \"age\" of output.attributes",
                [](Fields&) {});
}

template <class Real>
void Age::initialize(Newcomers<Real>& newcomers) const {
  Real* const birth = newcomers.set.extra[newcomers.set.extra_index(kBirth.kName)].values.data();
  for (std::size_t p = newcomers.first; p < newcomers.last; ++p)
    birth[p] = static_cast<Real>(newcomers.birth(p));
}

template void Age::initialize(Newcomers<float>&) const;
template void Age::initialize(Newcomers<double>&) const;

}  // namespace repose
