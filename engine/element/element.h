// Repose: one point of a material without a grid: the passes that a step of a scene makes of its particles from
// the trial strain on, hardening, cohesion and the like with them, driven by gradients of velocity that are
// given. In double precision, whatever the scene's.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "engine/base/result.h"
#include "engine/base/vector.h"
#include "engine/scene/scene.h"
#include "kernels/pass/target.h"

namespace repose {

/// A symmetric tensor, xx xy xz yy yz zz.
using Symmetric6 = std::array<double, 6>;

/// The numbers of an element at one time. Tension and stretch are positive; p is positive in compression.
struct ElementState {
  double time = 0.0;        ///< s, since the path began
  Symmetric6 strain{};      ///< log(F F^T) / 2 since the path began
  double volumetric = 0.0;  ///< ln det F since the path began
  double deviatoric = 0.0;  ///< sum of sqrt(2/3) |dev D dt| along the path
  Symmetric6 elastic{};     ///< Hencky strain of the elastic part, of the material at rest
  /// Cauchy's, tau / J, Pa; J the whole change of volume since the material was at rest.
  Symmetric6 stress{};
  /// Sum of tau : D dt, by the mean of both ends of a step, J/m^3 of the material at rest.
  double work = 0.0;
  double plastic_work = 0.0;     ///< sum of tau : (trial - returned), likewise; no step makes it less
  double elastic_energy = 0.0;   ///< psi, likewise
  std::vector<double> channels;  ///< what law and effects keep, in the order of Element::channels

  /// -tr(stress) / 3, Pa.
  double p() const;
  /// sqrt(3/2) |dev stress|, Pa: in triaxial tests the difference of axial and lateral stress.
  double q() const;
};

/// The scene of an element: a point of one material, and of the effects those that are a matter of the
/// material. `left_out` gets the names of the others that are on: gravity, colliders ... Errors: 64 no such
/// material (`name` empty: there are several); 65, by the key: the material has something that an element
/// cannot have, such as `variation`, which goes by place.
Result<Scene> element_scene(const Scene& scene, const std::string& name, std::vector<std::string>& left_out);

/// The cone on which an element of a scene as element_scene makes it yields.
struct ElementCone {
  double ratio = 0.0;  ///< q/p; 0: there is none, or it changes on the way
  double apex = 0.0;   ///< q that it bears without pressure, Pa
};
ElementCone cone_of_element(const Scene& scene);

class Element {
 public:
  /// Of a scene as element_scene makes it. Errors: as compile_scene.
  static Result<Element> create(const Scene& scene, Target target = best_target());
  Element(Element&&) noexcept;
  Element& operator=(Element&&) noexcept;
  ~Element();

  /// A step of `dt` (s) by the gradient of velocity L (1/s): F <- (I + dt L) F, whose determinant must be above
  /// 0.
  void step(const Mat3& gradient, double dt);

  const ElementState& state() const;
  /// The names of what law and effects keep beside the strain.
  const std::vector<std::string>& channels() const;
  const MaterialDescription& material() const;

  /// From here a path begins: strains, time and work count from now on.
  void begin_path();

  /// All that a step changes, to try one and go back.
  struct Snapshot {
    ElementState state;
    double log_volume;
    Mat3 deformation;
    Symmetric6 strain;
    std::int64_t step;
  };
  Snapshot save() const;
  void restore(const Snapshot& snapshot);

 private:
  struct Parts;
  explicit Element(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

}  // namespace repose
