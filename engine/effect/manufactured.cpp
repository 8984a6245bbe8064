#include "engine/effect/manufactured.h"

#include <cmath>
#include <numbers>

#include "engine/effect/effect.h"

namespace repose {
namespace {

using std::numbers::pi;

void describe_bar(Fields& fields, ManufacturedSolution& solution) {
  fields.vector("direction", solution.direction,
                {.meaning = "of any length, from the fixed end, at \"origin\", to the free one"});
  fields.number("length", solution.length,
                {.unit = "m", .meaning = "of the bar", .low = 0.0, .low_open = true, .required = true});
  fields.number("speed", solution.speed, {.unit = "m/s", .meaning = "of the free end", .required = true});
  fields.check(solution.direction.norm() > 0.0, "direction", "must not be zero, for example [1, 0, 0]");
}

void describe_vortex(Fields& fields, ManufacturedSolution& solution) {
  fields.vector("axis", solution.axis, {.meaning = "direction of the axis, which passes through \"origin\""});
  fields.number("inner", solution.inner,
                {.unit = "m", .meaning = "radius within which nothing turns", .low = 0.0});
  fields.number("outer", solution.outer,
                {.unit = "m", .meaning = "radius beyond which nothing turns", .low = 0.0, .low_open = true});
  fields.number("angle", solution.angle,
                {.unit = "degrees", .meaning = "that the ring between them has turned by at most"});
  fields.number("half_period", solution.half_period,
                {.unit = "s", .meaning = "after which all is where it began", .low = 0.0, .low_open = true});
  fields.check(solution.axis.norm() > 0.0, "axis", "must not be zero, for example [0, 0, 1]");
  fields.check(solution.outer > solution.inner, "outer", "must be greater than \"inner\"");
}

void describe_axis_aligned(Fields& fields, ManufacturedSolution& solution) {
  fields.vector(
      "amplitude", solution.amplitude,
      {.unit = "m", .meaning = "of the displacement along each axis; its sign is the phase, 0 or pi"});
  fields.number("length", solution.length,
                {.unit = "m",
                 .meaning = "after which the solution repeats, along each axis",
                 .low = 0.0,
                 .low_open = true});
  fields.check(2.0 * pi * solution.amplitude.cwiseAbs().maxCoeff() < solution.length, "amplitude",
               "must be less than length / (2 pi), or matter would be turned inside out");
}

void describe(Fields& fields, ManufacturedSolution& solution) {
  const Alternative types[] = {
      {"bar_mode", "the first mode of a bar that is fixed at one end: a velocity at the start, no force",
       [&](Fields& f) { describe_bar(f, solution); }},
      {"generalized_vortex", "rings that turn against each other and back, for neo_hookean",
       [&](Fields& f) { describe_vortex(f, solution); }},
      {"axis_aligned", "stretching along the axes of a periodic box, for neo_hookean",
       [&](Fields& f) { describe_axis_aligned(f, solution); }}};
  int chosen = static_cast<int>(solution.type);
  fields.alternatives(chosen, types, "the motion");
  solution.type = static_cast<ManufacturedSolution::Type>(chosen);
  fields.vector("origin", solution.origin, {.unit = "m", .meaning = "where the formula's coordinates begin"});
}

/// What no key can say alone; empty if all is right.
std::string wrong_with(const ManufacturedSolution& solution, const SetDescription& set,
                       const Surroundings& around) {
  using Type = ManufacturedSolution::Type;
  const int flat = around.flat_axis;
  if (solution.type == Type::kBarMode) {
    if (set.yields()) return "is for an elastic solid, and material \"" + set.material + "\" yields";
    if (flat >= 0 && solution.direction[flat] != 0.0)
      return "the bar's direction must lie in the plane (plane_strain)";
    return "";
  }
  if (set.law() != "neo_hookean")
    return "is for a body of neo_hookean; change the type of material \"" + set.material + "\"";
  if (around.gravity.norm() > 0.0)
    return "is a solution without gravity; set gravity.acceleration to [0, 0, 0]";
  if (flat >= 0 && solution.type == Type::kAxisAligned && solution.amplitude[flat] != 0.0)
    return "the amplitude must be zero along the flat axis (plane_strain)";
  if (flat >= 0 && solution.type == Type::kGeneralizedVortex &&
      std::abs(solution.axis[flat]) < (1.0 - 1e-12) * solution.axis.norm())
    return "the vortex must turn about the flat axis (plane_strain)";
  return "";
}

/// The polar frame of a vortex at a place.
struct Polar {
  double radius;  ///< R
  Vec3 out, along;

  Polar(const ManufacturedSolution& vortex, const Vec3& X) {
    const Vec3 axis = vortex.axis.normalized();
    const Vec3 from_axis = X - axis * axis.dot(X);
    radius = from_axis.norm();
    out = radius > 0.0 ? Vec3(from_axis / radius) : Vec3::Zero();
    along = axis.cross(out);
  }
};

/// How much of the turn a ring takes part in, h = (1 - 4 s^2)^2 with s from -1/2 to 1/2 across the ring, and
/// its slopes by R.
struct Share {
  double h = 0.0, slope = 0.0, curvature = 0.0;

  Share(const ManufacturedSolution& vortex, double radius) {
    if (!(radius > vortex.inner && radius < vortex.outer)) return;
    const double width = vortex.outer - vortex.inner;
    const double s = (radius - 0.5 * (vortex.inner + vortex.outer)) / width;
    h = std::pow(1.0 - 4.0 * s * s, 2);
    slope = (-16.0 * s + 64.0 * s * s * s) / width;
    curvature = (-16.0 + 192.0 * s * s) / (width * width);
  }
};

/// Force of the vortex. With theta = Theta + g(t) h(R) and Div P of the law, by parts along (e_R, e_Theta)
/// where the particle began; the sign of -R (g' h)^2 in the second is that of the balance of momentum.
Vec3 vortex_force(const ManufacturedSolution& vortex, const Vec3& X, double t, const Elasticity& e) {
  const Polar at(vortex, X);
  const Share share(vortex, at.radius);
  const double rate = pi / vortex.half_period, most = vortex.angle * pi / 180.0;
  const double g = most * std::sin(rate * t), speed = most * rate * std::cos(rate * t);
  const double stiffness = e.mu() / e.density, R = at.radius, turn = g * share.h;
  const double k = stiffness * g * (3.0 * share.slope + R * share.curvature) + R * rate * rate * turn;
  const double q = stiffness * R * std::pow(g * share.slope, 2) - R * std::pow(speed * share.h, 2);
  return (k * std::sin(turn) + q * std::cos(turn)) * at.out +
         (q * std::sin(turn) - k * std::cos(turn)) * at.along;
}

/// Force of u_i = A_i sin(2 pi X_i / L) sin(omega t): F is diagonal, and so is
/// P_ii = lambda ln J / F_i + mu (F_i - 1 / F_i).
Vec3 axis_aligned_force(const ManufacturedSolution& solution, const Vec3& X, double t, const Elasticity& e) {
  const double k = 2.0 * pi / solution.length;
  const double omega = 0.5 * k * std::sqrt(e.youngs_modulus / e.density);
  const double now = std::sin(omega * t);
  Vec3 u, F;
  for (int i = 0; i < 3; ++i) {
    u[i] = solution.amplitude[i] * now * std::sin(k * X[i]);
    F[i] = 1.0 + k * solution.amplitude[i] * now * std::cos(k * X[i]);
  }
  const double volume = std::log(F.prod());
  Vec3 b;
  for (int i = 0; i < 3; ++i) {
    const double square = F[i] * F[i];
    const double modulus = e.lambda() * (1.0 - volume) / square + e.mu() * (1.0 + 1.0 / square);
    b[i] = u[i] * (k * k * modulus / e.density - omega * omega);
  }
  return b;
}

}  // namespace

Vec3 ManufacturedSolution::velocity(const Vec3& X, const Elasticity& e) const {
  switch (type) {
    case Type::kBarMode: {
      const Vec3 along = direction.normalized();
      return speed * std::sin(0.5 * pi * along.dot(X) / length) * along;
    }
    case Type::kGeneralizedVortex: {
      const Polar at(*this, X);
      return at.radius * angle * pi / 180.0 * pi / half_period * Share(*this, at.radius).h * at.along;
    }
    case Type::kAxisAligned:
      break;
  }
  const double k = 2.0 * pi / length, omega = 0.5 * k * std::sqrt(e.youngs_modulus / e.density);
  return omega * amplitude.cwiseProduct(Vec3(std::sin(k * X[0]), std::sin(k * X[1]), std::sin(k * X[2])));
}

Vec3 ManufacturedSolution::force(const Vec3& X, double t, const Elasticity& e) const {
  switch (type) {
    case Type::kBarMode:
      return Vec3::Zero();
    case Type::kGeneralizedVortex:
      return vortex_force(*this, X, t, e);
    case Type::kAxisAligned:
      break;
  }
  return axis_aligned_force(*this, X, t, e);
}

std::vector<Example> Manufactured::examples() {
  const std::vector<std::string> base{
      R"(materials.sand={"type": "neo_hookean", "density": 2200, "youngs_modulus": 3.537e5})",
      "gravity.acceleration=[0, 0, 0]"};
  return {
      {"manufactured: bar_mode",
       base,
       {R"(manufactured={"column": {"type": "bar_mode", "direction": [0, 1, 0], "length": 1, "speed": 0.1}})"}},
      {"manufactured: generalized_vortex",
       base,
       {R"(manufactured={"column": {"type": "generalized_vortex", "axis": [0, 1, 0], "angle": 5,
               "origin": [-0.5, 0, 0.5]}})"}},
      {"manufactured: axis_aligned",
       base,
       {R"(manufactured={"column": {"type": "axis_aligned", "amplitude": [0.002, 0.002, -0.002]}})"}}};
}

void Manufactured::declare(Fields& fields, const SceneOutline&) {
  fields.dictionary("manufactured", false, "bodies that move as a formula says, by name: to verify with",
                    [this](const std::string& body, Fields& f) {
                      ManufacturedSolution solution;
                      solution.body = body;
                      describe(f, solution);
                      list.push_back(solution);
                    });
}

std::string Manufactured::why() const {
  std::string keys;
  for (const ManufacturedSolution& solution : list) {
    keys += (keys.empty() ? "manufactured." : ", manufactured.") + solution.body;
  }
  return keys.empty() ? "no entry in 'manufactured'" : keys;
}

const ManufacturedSolution* Manufactured::find(const std::string& body) const {
  for (const ManufacturedSolution& solution : list) {
    if (solution.body == body) return &solution;
  }
  return nullptr;
}

std::vector<Channel> Manufactured::channels(const SetDescription& set) const {
  const ManufacturedSolution* solution = find(set.name);
  if (solution == nullptr || !solution->pushes()) return {};
  return {{kX}, {kY}, {kZ}};
}

namespace {

template <class Real>
class KnownMotion : public Effect<Real> {
 public:
  explicit KnownMotion(const Manufactured& manufactured) : manufactured_(manufactured) {}

  /// Errors, with the key: a body or a material that the solution is not for, gravity where the solution has
  /// none, motion across the plane of plane strain.
  Result<void> prepare(const Surroundings& surroundings) override {
    for (const ManufacturedSolution& solution : manufactured_.list) {
      const std::string key = "manufactured." + solution.body;
      const SetDescription* body = surroundings.body(solution.body);
      if (body == nullptr) return surroundings.no_body(solution.body, key);
      const std::string wrong = wrong_with(solution, *body, surroundings);
      if (!wrong.empty()) return Error{ErrorKind::kBadScene, wrong, surroundings.where(key)};
    }
    return {};
  }

  void initialize(Newcomers<Real>& newcomers) const override;

  void add_to(PlanBuilder<Real>& plan) const override {
    for (SetSlots<Real>& set : plan.sets) {
      const ManufacturedSolution* solution = manufactured_.find(set.description.name);
      if (solution == nullptr || !solution->pushes()) continue;
      push(set, *solution);
      plan.drives.beyond_account();
      // Blocks do not know whose particles they hold.
      plan.rest.wake("manufactured." + solution->body,
                     [](const State<Real>&, const Index3&, double, double) { return true; });
    }
  }

 private:
  static void push(SetSlots<Real>& set, const ManufacturedSolution& solution) {
    set.scatter_own_velocity();
    set.before_scatter.add(
        {"body force of " + solution.body, "manufactured." + solution.body},
        reads(kP2gVelocity, Manufactured::kX, Manufactured::kY, Manufactured::kZ), writes(kP2gVelocity),
        [solution, e = set.description.elasticity()](const auto& at) {
          const Real *const x = at.read(Manufactured::kX), *const y = at.read(Manufactured::kY),
                            *const z = at.read(Manufactured::kZ);
          const auto told = at.write(kP2gVelocity);
          const double dt = double(at.dt());
          for (std::size_t p = 0; p < at.count(); ++p) {
            const Vec3 b = solution.force({double(x[p]), double(y[p]), double(z[p])}, at.time(), e);
            for (std::size_t i = 0; i < 3; ++i)
              told[i][p] = static_cast<Real>(double(told[i][p]) + dt * b[static_cast<int>(i)]);
          }
        });
  }

  Manufactured manufactured_;
};

template <class Real>
void KnownMotion<Real>::initialize(Newcomers<Real>& newcomers) const {
  const ManufacturedSolution* solution = manufactured_.find(newcomers.description.name);
  if (solution == nullptr) return;
  ParticleSet<Real>& set = newcomers.set;
  const Elasticity& e = newcomers.description.elasticity();
  const double h = 1e-3 * newcomers.surroundings.spacing;
  constexpr std::array kReference{Manufactured::kX.kName, Manufactured::kY.kName, Manufactured::kZ.kName};
  for (std::size_t p = newcomers.first; p < newcomers.last; ++p) {
    const Vec3 X = newcomers.position(p) - solution->origin;
    const Vec3 v = solution->velocity(X, e);
    for (int i = 0; i < 3; ++i) {
      set.velocity[i][p] = static_cast<Real>(double(set.velocity[i][p]) + v[i]);
      if (solution->pushes())
        set.extra[set.extra_index(kReference[static_cast<std::size_t>(i)])].values[p] = static_cast<Real>(X[i]);
    }
    // C is the gradient of the velocity, by columns.
    for (int j = 0; set.keeps_affine && j < 3; ++j) {
      const Vec3 step = h * Vec3::Unit(j);
      const Vec3 slope = (solution->velocity(X + step, e) - solution->velocity(X - step, e)) / (2.0 * h);
      for (int i = 0; i < 3; ++i) {
        Real& c = set.affine[3 * i + j][p];
        c = static_cast<Real>(double(c) + slope[i]);
      }
    }
  }
}

}  // namespace

REPOSE_EFFECT(Manufactured, KnownMotion)

}  // namespace repose
