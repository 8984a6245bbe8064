// Repose: a solid that deforms: one mesh per frame, from files. All vertices stay in memory, so that nothing
// can be missing once a run has begun; level sets, which are far larger, are made for the frames about the time
// that is asked for. The pose is a pure function of time, so a state needs to remember nothing of it. Or a host
// leads it: it gives each mesh when the stretch of time that ends with it begins, and what is past is let go.
#pragma once

#include <deque>
#include <memory>
#include <mutex>
#include <optional>
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

  /// One that a host leads: at rest as the mesh of `shape`, whose "file" has no "#", until next() is called.
  /// Meshes follow one another `rate` times a second. Errors as make().
  static Result<std::shared_ptr<MeshSequence>> led(const ShapeDescription& shape, double rate,
                                                   const std::string& folder, double spacing,
                                                   bool allow_outside_paths);
  /// Of one that is led, while nothing else asks: the mesh that it comes to when the stretch ends that begins
  /// at `time` (s), in coordinates as of the file; said again, the last one counts. Errors: 64 where no stretch
  /// begins, 65 no solid, 78.
  Result<void> next(TriangleMesh mesh, double time);
  /// The same, but that it stands so from now on.
  Result<void> stand(TriangleMesh mesh, double time);
  /// The triangles of its last mesh.
  const std::vector<Index3>& triangles() const { return *frames_.back().triangles; }
  std::size_t vertices() const { return frames_.back().vertices->size(); }
  bool is_led() const { return led_.has_value(); }

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
  Result<MeshFrame> frame_of(const ShapeDescription& shape, TriangleMesh mesh, const std::string& name) const;
  Result<std::int64_t> stretch_that_begins(double time) const;
  void put(std::size_t number, MeshFrame frame);
  void find_ways();
  double way_between(const MeshFrame& from, const MeshFrame& to) const;
  double frames_since_start(double time) const;
  Place place(double time) const;
  std::size_t count() const { return past_ + frames_.size(); }
  const MeshFrame& frame(std::size_t number) const { return frames_[number - past_]; }
  double way(std::size_t number) const { return ways_[number - past_]; }
  std::shared_ptr<const Shape> solid(std::size_t frame) const;
  std::shared_ptr<const MovingTriangles> track(std::size_t from, std::size_t to) const;

  SequenceDescription description_;
  double spacing_;
  std::optional<ShapeDescription> led_;  // where a host leads it: how its meshes are placed
  std::size_t past_ = 0;                 // meshes that a host has given and that are let go
  std::deque<MeshFrame> frames_;
  std::deque<double> ways_;  // from each frame to the next, m: of the point that goes farthest
  std::shared_ptr<Cache> cache_;
};

}  // namespace repose
