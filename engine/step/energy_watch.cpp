#include "engine/step/energy_watch.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdio>
#include <limits>

#include "engine/base/vector.h"
#include "engine/step/acceptance.h"

namespace repose {

template <class Real>
void EnergyWatch<Real>::Sums::add(const Sums& other) {
  if (!other.any) return;
  matter.mass += other.matter.mass;
  matter.kinetic += other.matter.kinetic;
  momentum += other.momentum;
  affine += other.affine;
  elastic += other.elastic;
  potential += other.potential;
  begun += other.begun;
  newcomers += other.newcomers;
  lowest = any ? std::min(lowest, other.lowest) : other.lowest;
  highest = any ? std::max(highest, other.highest) : other.highest;
  any = true;
}

template <class Real>
EnergyWatch<Real>::EnergyWatch(const StepPlan<Real>& plan)
    : alarm_(plan.energy && !plan.energy->beyond_account ? &*plan.energy : nullptr),
      solids_(plan.tables.template get<Real>(kContactLog)) {}

/// In loops over plain arrays, for it must cost next to nothing.
template <class Real>
void EnergyWatch<Real>::sum_block(const State<Real>& state, std::size_t occupied, Sums& sums) const {
  sums = {};
  const Index3& block = state.grid.occupied_coordinates(occupied);
  const Vec3 corner = state.world(block, std::array<double, 3>{0, 0, 0});
  const Vec3 up = -alarm_->gravity;
  const double x_up = up[0] * state.spacing, y_up = up[1] * state.spacing, z_up = up[2] * state.spacing;
  for (const std::size_t k : state.sets_of_blocks.of(occupied)) {
    const ParticleSet<Real>& set = state.sets[k];
    const std::size_t first = set.begin[occupied], last = set.begin[occupied + 1];
    const Real *const u = set.velocity[0].data(), *const v = set.velocity[1].data(),
                      *const w = set.velocity[2].data();
    const Real *const x = set.position[0].data(), *const y = set.position[1].data(),
                      *const z = set.position[2].data();
    double square = 0.0, along[3] = {}, height = 0.0, affine = 0.0, elastic = 0.0, newcomers = 0.0, begun = 0.0;
    double lowest = std::numeric_limits<double>::infinity(), highest = -lowest;
    std::visit(
        [&](const auto& law) {
          for (std::size_t p = first; p < last; ++p) {
            const double a = u[p], b = v[p], c = w[p], kinetic = a * a + b * b + c * c;
            along[0] += a, along[1] += b, along[2] += c;
            square += kinetic;
            const double at = x_up * double(x[p]) + y_up * double(y[p]) + z_up * double(z[p]);
            height += at;
            lowest = std::min(lowest, at);
            highest = std::max(highest, at);
            double eps[kStrainComponents];
            for (std::size_t n = 0; n < kStrainComponents; ++n) eps[n] = set.strain[n][p];
            const double density = law.energy_density(eps);
            elastic += density;
            if (set.id[p] >= next_id_) {
              begun += set.particle_mass;
              newcomers +=
                  set.particle_mass * (0.5 * kinetic + up.dot(corner) + at) + set.particle_volume * density;
            }
          }
        },
        alarm_->laws[k]);
    Sums of_set;
    const double mass = set.particle_mass, count = static_cast<double>(last - first);
    const double inertia = 0.5 * mass * alarm_->affine_inertia;
    for (std::size_t n = 0; set.keeps_affine && n < kAffineComponents; ++n) {
      const Real* const c = set.affine[n].data();
      double sum = 0.0;
      for (std::size_t p = first; p < last; ++p) sum += double(c[p]) * double(c[p]);
      affine += sum;
      if (!(begun > 0.0)) continue;
      for (std::size_t p = first; p < last; ++p) {
        if (set.id[p] >= next_id_) newcomers += inertia * double(c[p]) * double(c[p]);
      }
    }
    of_set.any = true;
    of_set.matter.mass = mass * count;
    of_set.matter.kinetic = 0.5 * mass * square;
    of_set.momentum = mass * Vec3(along[0], along[1], along[2]);
    of_set.affine = inertia * affine;
    of_set.elastic = set.particle_volume * elastic;
    of_set.potential = mass * (count * up.dot(corner) + height);
    of_set.begun = begun;
    of_set.newcomers = newcomers;
    of_set.lowest = up.dot(corner) + lowest;
    of_set.highest = up.dot(corner) + highest;
    sums.add(of_set);
  }
}

template <class Real>
typename EnergyWatch<Real>::Sums EnergyWatch<Real>::look(const State<Real>& state, Threads& threads) {
  blocks_.resize(state.grid.occupied_blocks().size());
  threads.for_each(
      blocks_.size(), [&](std::size_t occupied) { sum_block(state, occupied, blocks_[occupied]); }, 8);
  Sums all;
  for (const Sums& block : blocks_) all.add(block);
  all.matter.momentum = all.momentum.norm();
  steps_ = 0;
  return all;
}

template <class Real>
void EnergyWatch<Real>::begin(const State<Real>& state, Threads& threads) {
  if (alarm_ == nullptr || watching_ || told_) return;
  next_id_ = state.ledger.next_id;
  last_ = look(state, threads);
  time_ = state.counters.time;
  begun_with_ = last_.energy();
  given_ = work_ = scale_ = most_speed_ = 0.0;
  watched_ = 0;
  watching_ = true;
}

/// Every so many steps, sooner where a frame ends, and in runs that are short: a look takes a fifth of a step.
template <class Real>
bool EnergyWatch<Real>::due(bool ends_frame) const {
  const std::int64_t most = alarm_->steps;
  if (std::has_single_bit(static_cast<std::uint64_t>(watched_)) && 16 * watched_ >= most) return true;
  return ends_frame ? 4 * steps_ >= std::min(watched_, 2 * most) : steps_ >= most;
}

/// What can have come into matter since the last look, J. What has gone leaves more of the account than there
/// was in it where its potential was below zero.
template <class Real>
double EnergyWatch<Real>::given_since(const State<Real>& state, const Sums& now) const {
  const double passed = state.counters.time - time_;
  const MatterInMotion most{std::max(last_.matter.mass, now.matter.mass),
                            std::max(last_.matter.kinetic, now.matter.kinetic),
                            std::max(last_.matter.momentum, now.matter.momentum), time_};
  double given = work_ + now.newcomers;
  for (const auto& power : alarm_->powers) given += passed * power(most);
  if (state.ledger.open()) {
    const double gone = std::max(0.0, last_.matter.mass + now.begun - now.matter.mass);
    const double deepest = last_.lowest - alarm_->gravity.norm() * most_speed_ * passed;
    given += gone * std::max(0.0, -deepest);
  }
  return given;
}

template <class Real>
void EnergyWatch<Real>::after_step(const State<Real>& state, Threads& threads, bool ends_frame,
                                   StepReport& report) {
  if (!watching_ || told_) return;
  most_speed_ = std::max(most_speed_, state.counters.max_speed);
  if (solids_ != nullptr) {
    for (std::size_t solid = 0; solid < solids_->solids(); ++solid) work_ += solids_->total(solid).work;
  }
  ++steps_, ++watched_;
  if (!due(ends_frame)) return;
  const Sums now = look(state, threads);
  given_ += given_since(state, now);
  report.energy = EnergyLook{now.matter.kinetic, now.affine, now.elastic, now.potential, given_};
  const double heights =
      now.matter.mass * (std::max(last_.highest, now.highest) - std::min(last_.lowest, now.lowest));
  scale_ = std::max({scale_, heights, std::abs(given_), last_.energy() - last_.potential});
  last_ = now;
  time_ = state.counters.time;
  next_id_ = state.ledger.next_id;
  work_ = most_speed_ = 0.0;
  // What draws matter at a speed may store more in its elasticity than anybody can tell; it is then its
  // motion alone that is judged.
  const double drawn = 2.0 * now.matter.mass * alarm_->drawn * alarm_->drawn;
  const double judged = alarm_->drawn > 0.0 ? now.energy() - now.elastic : now.energy();
  if (judged <= begun_with_ + given_ + drawn + alarm_->share * scale_) return;
  told_ = true;
  report.alarm = alert(state, now);
}

template <class Real>
EnergyAlert EnergyWatch<Real>::alert(const State<Real>& state, const Sums& now) const {
  EnergyAlert alert{
      "", fastest_particle(state, "is the fastest",
                           "smaller time.sound and time.strain, or grid.stencil quadratic, may help")};
  const FailedParticle& fastest = alert.fastest;
  char numbers[512];
  std::snprintf(
      numbers, sizeof numbers,
      "energy comes from nowhere: %.4g J after %lld steps, where %.4g J at the start and %.3g J from "
      "outside could leave no more than %.4g J; the fastest particle is %u of '%s', %.3g m/s at (%.4g, "
      "%.4g, %.4g) m; ",
      now.energy(), static_cast<long long>(state.counters.step), begun_with_, given_, begun_with_ + given_,
      fastest.id, fastest.set.c_str(), to_vec3(fastest.velocity).norm(), fastest.position[0],
      fastest.position[1], fastest.position[2]);
  alert.text = numbers + fastest.advice;
  return alert;
}

template class EnergyWatch<float>;
template class EnergyWatch<double>;

}  // namespace repose
