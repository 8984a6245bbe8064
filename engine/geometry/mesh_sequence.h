// Repose: a solid that deforms: one mesh per frame, from files. All vertices stay in memory, so that nothing
// can be missing once a run has begun; level sets, which are far larger, are made for the frames about the time
// that is asked for. The pose is a pure function of time, so a state needs to remember nothing of it.
#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "engine/base/params.h"
#include "engine/base/result.h"
#include "engine/geometry/morphed_shape.h"

namespace repose {

/// What a scene says of a sequence (data only).
struct SequenceDescription {
  bool given = false;
  std::int64_t first = 1;
  std::int64_t count = 2;
  double rate = 24.0;   ///< 1/s
  double start = 0.0;   ///< s
  bool repeat = false;  ///< the first frame follows the last
};

/// Declares the scene keys of a sequence.
void describe(Fields& fields, SequenceDescription& frames);

/// The file of a frame: the row of "#" becomes its number, with zeros before it. Empty where there is not just
/// one row of "#".
std::string frame_file(const std::string& file, std::int64_t number);

/// Rests before the first frame and, unless it repeats, after the last. Safe from many threads.
class MeshSequence {
 public:
  /// Reads all files of `shape`, a mesh, and checks that each is a solid that fits in memory. Errors: 65, 66,
  /// 78, naming the file.
  static Result<std::shared_ptr<const MeshSequence>> make(const ShapeDescription& shape,
                                                          const SequenceDescription& frames,
                                                          const std::string& folder, double spacing,
                                                          bool allow_outside_paths);

  /// How it stands at a time (s). Throws std::bad_alloc where there is no memory for its level sets.
  std::shared_ptr<const MorphedShape> at(double time) const;

  /// The share of the time between two moments (s) in which it does not rest for its frames have not begun or
  /// have ended.
  double moving_share(double from, double to) const;
  /// No point of the surface is faster between two times (s), in m/s.
  double fastest(double from, double to) const;
  /// Where meshes succeed one another, 1/s.
  double rate() const { return description_.rate; }

  /// Time is cut into windows in which no point goes farther than `way` (m): when the one of `time` begins, s.
  double window(double time, double way) const;

 private:
  /// Between which frames a time lies.
  struct Place {
    std::size_t from, to;
    double share;
  };
  template <class Made>
  struct Recent;
  struct Cache;

  MeshSequence(const SequenceDescription& description, double spacing);
  Result<void> add(const ShapeDescription& shape, const std::string& path);
  void find_ways();
  double way_between(const MeshFrame& from, const MeshFrame& to) const;
  double frames_since_start(double time) const;
  Place place(double time) const;
  std::shared_ptr<const Shape> solid(std::size_t frame) const;
  std::shared_ptr<const MovingTriangles> track(std::size_t from, std::size_t to) const;

  SequenceDescription description_;
  double spacing_;
  std::vector<MeshFrame> frames_;
  std::vector<double> ways_;  // from each frame to the next, m: of the point that goes farthest
  std::shared_ptr<Cache> cache_;
};

}  // namespace repose
