#include "engine/effect/age.h"

#include "engine/effect/effect.h"

namespace repose {

std::vector<Example> Age::examples() {
  return {{"age", {}, {"age={}"}}};
}

void Age::declare(Fields& fields, const SceneOutline&) {
  fields.feature("age", enabled,
                 "particles remember when they began, for the attribute \"age\" of output.attributes",
                 [](Fields&) {});
}

namespace {

template <class Real>
class BirthTimes : public Effect<Real> {
 public:
  explicit BirthTimes(const Age&) {}

  void initialize(Newcomers<Real>& newcomers) const override {
    Real* const birth = newcomers.channel(kBirth);
    for (std::size_t p = newcomers.first; p < newcomers.last; ++p)
      birth[p] = static_cast<Real>(newcomers.birth(p));
  }
};

}  // namespace

REPOSE_EFFECT(Age, BirthTimes)

}  // namespace repose
