#include "engine/implicit/first_guess.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace repose {
namespace {

constexpr double kUndefined = std::numeric_limits<double>::infinity();

}  // namespace

template <class Real>
std::optional<double> FirstGuess<Real>::find(Vector& dv) {
  const bool knows = !sweep_.state().last_motion.blocks.empty();
  follow_blocks();
  if (!knows) return begin_at(Kind::kAtRest, dv);
  const auto by_rate = begin_at(Kind::kAtLastRate, dv);
  const bool gains = sweep_.state().last_motion.gained > kGood;
  if (by_rate && (gains || *by_rate <= tolerance_ * balance_.scale())) return by_rate;
  const auto by_velocity = begin_at(Kind::kAtLastVelocity, dv);
  const double most = std::min(kBetter * by_rate.value_or(kUndefined), kGood * balance_.scale());
  if (by_velocity && *by_velocity <= most) return by_velocity;
  // Once more, for the solve goes on with what was evaluated last.
  return begin_at(by_rate ? Kind::kAtLastRate : Kind::kAtRest, dv);
}

/// Brings the motion of the last step to the blocks as they now lie.
template <class Real>
void FirstGuess<Real>::follow_blocks() {
  LastMotion<Real>& kept = sweep_.state().last_motion;
  const BlockGrid& grid = sweep_.state().grid;
  const auto blocks = grid.blocks();
  if (std::equal(blocks.begin(), blocks.end(), kept.blocks.begin(), kept.blocks.end())) return;
  for (Vector* const field : {&kept.velocity, &kept.acceleration}) {
    Vector now;
    now.values.resize(blocks.size() * kBlockValues);  // zeros: blocks that are new know of no motion
    for (std::size_t b = 0; b < kept.blocks.size(); ++b) {
      const std::int32_t place = grid.find_block(kept.blocks[b]);
      if (place >= 0) std::copy_n(field->block(b), kBlockValues, now.block(static_cast<std::size_t>(place)));
    }
    *field = std::move(now);
  }
  kept.blocks.assign(blocks.begin(), blocks.end());
}

/// |r| at a guess, with contacts as the forces there would have them where that is better. Each that is found
/// here saves an iteration of Newton's method.
template <class Real>
std::optional<double> FirstGuess<Real>::begin_at(Kind kind, Vector& dv) {
  const std::optional<double> norm = evaluate_at(kind, dv);
  if (!norm || *norm <= kGood * balance_.scale() || !foresee_contacts(dv)) return norm;
  const std::optional<double> foreseen = balance_.evaluate(dv);
  if (foreseen && *foreseen <= *norm) return foreseen;
  return evaluate_at(kind, dv);
}

template <class Real>
std::optional<double> FirstGuess<Real>::evaluate_at(Kind kind, Vector& dv) {
  place(kind, dv);
  balance_.forget_scale();  // of another guess, that may be far off
  return balance_.evaluate(dv);
}

/// A guess, as far as contacts let it be: those that it, or v^free, would pass. Nodes that had no mass in the
/// last step begin at v^n.
template <class Real>
void FirstGuess<Real>::place(Kind kind, Vector& dv) {
  sweep_.for_each_block([&](std::size_t b) {
    const LastMotion<Real>& last = sweep_.state().last_motion;
    const Real *const velocity = last.velocity.block(b), *const acceleration = last.acceleration.block(b);
    const Real *const nodes = sweep_.state().nodes.block(b), *const begin =
                                                                 sweep_.state().before_forces.block(b);
    Real* const to = dv.block(b);
    Real free[kBlockValues];
    for (std::size_t at = 0; at < kBlockValues; at += kNodeValues) {
      const bool known = kind != Kind::kAtRest && nodes[at] > Real(0) && velocity[at] > Real(0);
      to[at] = free[at] = Real(0);
      for (std::size_t k = at + 1; k < at + kNodeValues; ++k) {
        const Real change = kind == Kind::kAtLastRate ? sweep_.dt() * acceleration[k] : velocity[k] - begin[k];
        to[k] = known ? change : Real(0);
        free[k] = nodes[k] - begin[k];
      }
    }
    contacts_.release_all(b);
    contacts_.take_up(b, to);
    contacts_.take_up(b, free);
    contacts_.apply(b, to);
  });
}

/// Takes up contacts that an explicit step with the forces at dv would pass, and stops what friction would stop
/// in one. Returns whether there are any.
template <class Real>
bool FirstGuess<Real>::foresee_contacts(Vector& dv) {
  const auto [found] = sweep_.sums_of_blocks([&](std::size_t b) {
    if (!contacts_.any(b)) return std::array{0.0};
    const Real *const r = balance_.residual().block(b), *const nodes = sweep_.state().nodes.block(b);
    Real* const to = dv.block(b);
    Real next[kBlockValues];
    for (std::size_t at = 0; at < kBlockValues; ++at) {
      const Real mass = nodes[at - at % kNodeValues];
      next[at] = mass > Real(0) ? to[at] - r[at] / mass : Real(0);
    }
    const int stopped = contacts_.stop_held(b, nodes, r, to);
    const int taken = contacts_.take_up(b, next);
    contacts_.apply(b, to);
    return std::array{static_cast<double>(stopped + taken)};
  });
  return found > 0.0;
}

template <class Real>
void FirstGuess<Real>::keep(const Vector& dv) {
  LastMotion<Real>& last = sweep_.state().last_motion;
  const auto [gained] = sweep_.sums_of_blocks([&](std::size_t b) {
    double sum = 0.0;
    const Real *const change = dv.block(b), *const nodes = sweep_.state().nodes.block(b);
    const Real* const begin = sweep_.state().before_forces.block(b);
    Real *const velocity = last.velocity.block(b), *const acceleration = last.acceleration.block(b);
    for (std::size_t at = 0; at < kBlockValues; at += kNodeValues) {
      const bool empty = !(nodes[at] > Real(0)), known = !empty && velocity[at] > Real(0);
      velocity[at] = empty ? Real(0) : nodes[at];
      acceleration[at] = Real(0);
      for (std::size_t k = at + 1; k < at + kNodeValues; ++k) {
        const Real now = empty ? Real(0) : begin[k] + change[k];
        const auto gain = known ? static_cast<double>(now - velocity[k]) : 0.0;
        sum += static_cast<double>(velocity[at]) * gain * gain;
        velocity[k] = now;
        acceleration[k] = empty ? Real(0) : change[k] / sweep_.dt();
      }
    }
    return std::array{sum};
  });
  last.gained = gained > 0.0 ? std::sqrt(gained) / balance_.scale() : 0.0;
}

template class FirstGuess<float>;
template class FirstGuess<double>;

}  // namespace repose
