#include "engine/element/element.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <optional>

#include "engine/compiler/compiler.h"

namespace repose {
namespace {

constexpr std::array<int, 6> kRow{0, 0, 0, 1, 1, 2}, kColumn{0, 1, 2, 1, 2, 2};

Mat3 matrix_of(const Symmetric6& a) {
  Mat3 m;
  for (std::size_t k = 0; k < 6; ++k) m(kRow[k], kColumn[k]) = m(kColumn[k], kRow[k]) = a[k];
  return m;
}

Symmetric6 six_of(const Mat3& m) {
  Symmetric6 a;
  for (std::size_t k = 0; k < 6; ++k) a[k] = m(kRow[k], kColumn[k]);
  return a;
}

Mat3 deviator(const Mat3& m) {
  return m - m.trace() / 3.0 * Mat3::Identity();
}

/// log(F F^T) / 2.
Mat3 hencky_strain_of(const Mat3& deformation) {
  const Eigen::SelfAdjointEigenSolver<Mat3> solver(deformation * deformation.transpose());
  const Vec3 logs = 0.5 * solver.eigenvalues().array().log().matrix();
  return solver.eigenvectors() * logs.asDiagonal() * solver.eigenvectors().transpose();
}

bool forms_trial_strain(const PassDescription& pass) {
  const auto has = [](const std::vector<HandleInfo>& list, const HandleInfo& handle) {
    return std::find(list.begin(), list.end(), handle) != list.end();
  };
  return has(pass.reads, kGradient.kInfo) &&
         (has(pass.writes, kTrialStrain.kInfo) || has(pass.writes, kHenckyStrain.kInfo));
}

}  // namespace

double ElementState::p() const {
  return 0.0 - matrix_of(stress).trace() / 3.0;  // no pressure is 0, not -0
}

double ElementState::q() const {
  return std::sqrt(1.5) * deviator(matrix_of(stress)).norm();
}

struct Element::Parts {
  Scene scene;
  State<double> particles;
  ScratchLayout layout;
  std::optional<Scratch<double>> scratch;
  ParticlePass<double> stress;
  std::vector<ParticlePass<double>> passes;  // the first forms the trial strain
  std::vector<std::string> channels;
  ElementState state;
  double log_volume = 0.0;  // since the material was at rest
  Mat3 deformation = Mat3::Identity();

  ParticleSet<double>& set() { return particles.sets[0]; }

  Symmetric6 strain() {
    Symmetric6 eps;
    for (std::size_t k = 0; k < 6; ++k) eps[k] = set().strain[k][0];
    return eps;
  }

  /// Kirchhoff's, of the strain at hand, Pa.
  Mat3 kirchhoff(Chunk<double>& chunk) {
    stress.run(chunk);
    const double* const tau = scratch->at(layout.place(kKirchhoffStress.kInfo));
    Symmetric6 six;
    for (std::size_t k = 0; k < 6; ++k) six[k] = tau[k * kChunk];
    return matrix_of(six);
  }

  Chunk<double> chunk(double dt) {
    return {set(),
            0,
            set().span(0, 1),
            *scratch,
            dt,
            particles.spacing,
            particles.counters.time,
            particles.counters.step,
            Vec3(0, 0, 0)};
  }

  void look(const Mat3& tau) {
    state.elastic = strain();
    state.stress = six_of(tau / std::exp(log_volume));
    state.strain = six_of(hencky_strain_of(deformation));
    double eps[6];
    for (std::size_t k = 0; k < 6; ++k) eps[k] = state.elastic[k];
    state.elastic_energy =
        std::visit([&](const auto& law) { return law.energy_density(eps); }, scene.materials[0].parameters);
    for (std::size_t k = 0; k < channels.size(); ++k) state.channels[k] = set().extra[k].values[0];
  }
};

Element::Element(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
Element::Element(Element&&) noexcept = default;
Element& Element::operator=(Element&&) noexcept = default;
Element::~Element() = default;

Result<Element> Element::create(const Scene& scene, Target target) {
  auto parts = std::make_unique<Parts>();
  parts->scene = scene;
  CompileOptions options;
  options.target = target;
  auto compiled = compile_scene<double>(parts->scene, options);
  if (!compiled) return compiled.error();
  parts->particles = std::move(compiled->state);
  parts->layout = compiled->plan.scratch;
  parts->scratch.emplace(parts->layout);
  auto& gather = compiled->plan.gather[0];
  const auto trial = std::find_if(gather.begin(), gather.end(),
                                  [](const auto& pass) { return forms_trial_strain(pass.description); });
  const auto& scatter = compiled->plan.scatter[0];
  const auto stress = std::find_if(scatter.begin(), scatter.end(), [](const auto& pass) {
    const auto& writes = pass.description.writes;
    return std::find(writes.begin(), writes.end(), kKirchhoffStress.kInfo) != writes.end();
  });
  REPOSE_ASSERT(trial != gather.end() && stress != scatter.end());
  parts->stress = *stress;
  parts->passes.assign(trial, gather.end());
  for (const auto& channel : parts->set().extra) parts->channels.push_back(channel.name);
  parts->state.channels.resize(parts->channels.size());
  Chunk<double> chunk = parts->chunk(1.0);
  parts->look(parts->kirchhoff(chunk));
  return Element(std::move(parts));
}

void Element::step(const Mat3& gradient, double dt) {
  Parts& my = *parts_;
  Chunk<double> chunk = my.chunk(dt);
  double entries[9];
  for (int k = 0; k < 9; ++k) {
    entries[k] = gradient(k / 3, k % 3);
    chunk.moving_gradient[k] = &entries[k];
  }
  const Mat3 before = my.kirchhoff(chunk);
  my.passes.front().run(chunk);
  const Mat3 trial = matrix_of(my.strain());
  for (std::size_t k = 1; k < my.passes.size(); ++k) my.passes[k].run(chunk);
  const Mat3 after = my.kirchhoff(chunk);

  const Mat3 step = dt * gradient, one = Mat3::Identity();
  const Mat3 middle = step * (one + 0.5 * step).inverse();  // dt L in the middle of the step
  const Mat3 rate = 0.5 * (middle + middle.transpose());
  const double volume = std::log((one + step).determinant());
  ElementState& state = my.state;
  state.work += 0.5 * (before + after).cwiseProduct(rate).sum();
  state.plastic_work += after.cwiseProduct(trial - matrix_of(my.strain())).sum();
  state.deviatoric += std::sqrt(2.0 / 3.0) * deviator(rate).norm();
  state.volumetric += volume;
  state.time += dt;
  my.log_volume += volume;
  my.deformation = (one + step) * my.deformation;
  my.particles.counters.time += dt;
  ++my.particles.counters.step;
  my.look(after);
}

const ElementState& Element::state() const {
  return parts_->state;
}
const std::vector<std::string>& Element::channels() const {
  return parts_->channels;
}
const MaterialDescription& Element::material() const {
  return parts_->scene.materials[0];
}

void Element::begin_path() {
  ElementState& state = parts_->state;
  parts_->deformation = Mat3::Identity();
  parts_->particles.counters.time = 0.0;
  parts_->particles.counters.step = 0;
  state.time = state.volumetric = state.deviatoric = state.work = state.plastic_work = 0.0;
  state.strain = {};
}

Element::Snapshot Element::save() const {
  return {parts_->state, parts_->log_volume, parts_->deformation, parts_->strain(),
          parts_->particles.counters.step};
}

void Element::restore(const Snapshot& snapshot) {
  Parts& my = *parts_;
  my.state = snapshot.state;
  my.log_volume = snapshot.log_volume;
  my.deformation = snapshot.deformation;
  my.particles.counters.time = snapshot.state.time;
  my.particles.counters.step = snapshot.step;
  for (std::size_t k = 0; k < 6; ++k) my.set().strain[k][0] = snapshot.strain[k];
  for (std::size_t k = 0; k < my.channels.size(); ++k) my.set().extra[k].values[0] = snapshot.state.channels[k];
}

}  // namespace repose
