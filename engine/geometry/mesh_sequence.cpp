#include "engine/geometry/mesh_sequence.h"

#include <algorithm>
#include <cmath>
#include <new>

#include "engine/base/wording.h"
#include "engine/geometry/mesh_reader.h"
#include "engine/geometry/mesh_shape.h"
#include "engine/geometry/mesh_solid.h"
#include "engine/geometry/placement.h"
#include "engine/geometry/scene_path.h"

namespace repose {
namespace {

/// The frames about both ends of a step are four at most, and so are those about two times that follow.
constexpr std::size_t kKept = 4;

/// A step ends where its stretch ends but for the rounding of its length in single precision: what it comes to
/// is the end of that stretch, and how it got there the way along it. In stretches.
constexpr double kRounding = 1e-6;

/// Frames in a sequence: an hour at 24 per second, so that a slip of the pen is no search of a million files.
constexpr double kMostFrames = 86400;

TriangleMesh mesh_of(const MeshFrame& frame) {
  return {*frame.vertices, *frame.triangles};
}

/// How far a mesh lies from another at the most, seen from its corners and the middles of its triangles, m.
double farthest(const MeshFrame& mesh, const MeshFrame& other) {
  const MovingTriangles still(other.vertices, other.vertices, other.triangles);
  double most = 0.0;
  const auto look = [&](const Vec3& x) { most = std::max(most, still.nearest(x, 0.0).distance); };
  for (const Index3& t : *mesh.triangles) {
    const Vec3 &a = (*mesh.vertices)[t[0]], &b = (*mesh.vertices)[t[1]], &c = (*mesh.vertices)[t[2]];
    for (const Vec3& x : {a, b, c, Vec3((a + b + c) / 3.0)}) look(x);
  }
  return most;
}

}  // namespace

void describe(Fields& fields, SequenceDescription& frames) {
  fields.integer("first", frames.first, {.meaning = "number of the first file", .low = 0.0});
  fields.integer("count", frames.count,
                 {.meaning = "how many files", .low = 1.0, .high = kMostFrames, .required = true});
  fields.number("rate", frames.rate,
                {.unit = "1/s", .meaning = "files per second", .low = 0.0, .low_open = true});
  fields.number("start", frames.start, {.unit = "s", .meaning = "when the solid is as in the first file"});
  fields.flag("repeat", frames.repeat,
              "the last file goes over into the first, and so on; else the last stays");
}

std::string frame_file(const std::string& file, std::int64_t number) {
  const std::size_t begin = file.find('#');
  if (begin == std::string::npos) return {};
  const std::size_t end = std::min(file.find_first_not_of('#', begin), file.size());
  if (file.find('#', end) != std::string::npos) return {};
  std::string digits = std::to_string(number);
  if (digits.size() < end - begin) digits.insert(0, end - begin - digits.size(), '0');
  return file.substr(0, begin) + digits + file.substr(end);
}

/// The things made last, by number.
template <class Made>
struct MeshSequence::Recent {
  std::vector<std::pair<std::size_t, std::shared_ptr<const Made>>> list;

  template <class Make>
  std::shared_ptr<const Made> get(std::size_t number, Make make) {
    auto found =
        std::find_if(list.begin(), list.end(), [&](const auto& entry) { return entry.first == number; });
    if (found == list.end()) {
      if (list.size() == kKept) list.pop_back();
      found = list.insert(list.end(), {number, make()});
    }
    std::rotate(list.begin(), found, found + 1);
    return list.front().second;
  }
  void forget(std::size_t number) {
    std::erase_if(list, [&](const auto& entry) { return entry.first == number; });
  }
};

struct MeshSequence::Cache {
  std::mutex mutex;
  Recent<Shape> solids;
  Recent<MovingTriangles> tracks;
};

MeshSequence::MeshSequence(const SequenceDescription& description, double spacing)
    : description_(description), spacing_(spacing), cache_(std::make_shared<Cache>()) {}

Result<std::shared_ptr<const MeshSequence>> MeshSequence::make(const ShapeDescription& shape,
                                                               const SequenceDescription& frames,
                                                               const std::string& folder, double spacing,
                                                               bool allow_outside_paths) {
  const bool numbers = frames.count >= 1 && static_cast<double>(frames.count) <= kMostFrames &&
                       frames.rate > 0 && std::isfinite(frames.rate) && std::isfinite(frames.start);
  if (!numbers || shape.type != ShapeDescription::Type::kMesh || frame_file(shape.file, frames.first).empty()) {
    return Error{
        ErrorKind::kBadScene, "a sequence needs a mesh whose \"file\" has one row of \"#\", and frames", {}};
  }
  try {
    const std::shared_ptr<MeshSequence> sequence(new MeshSequence(frames, spacing));
    for (std::int64_t k = 0; k < frames.count; ++k) {
      const auto path =
          resolve_path(folder, frame_file(shape.file, frames.first + k), "mesh file", allow_outside_paths);
      if (!path) return path.error();
      if (auto added = sequence->add(shape, *path); !added) return added.error();
    }
    sequence->find_ways();
    return std::shared_ptr<const MeshSequence>(sequence);
  } catch (const std::bad_alloc&) {
    return Error{ErrorKind::kMemory, "not enough memory for the meshes", shape.file};
  }
}

Result<void> MeshSequence::add(const ShapeDescription& shape, const std::string& path) {
  auto mesh = read_mesh(path);
  if (!mesh) return mesh.error();
  auto frame = frame_of(shape, std::move(*mesh), path);
  if (!frame) return frame.error();
  frames_.push_back(std::move(*frame));
  return {};
}

/// A mesh where the shape places it, of the triangles of another frame where they are the same.
Result<MeshFrame> MeshSequence::frame_of(const ShapeDescription& shape, TriangleMesh mesh,
                                         const std::string& name) const {
  const Placement placement{rotation_matrix(shape.rotation_axis, shape.rotation_angle), shape.translation};
  for (Vec3& vertex : mesh.vertices) vertex = placement.point(shape.scale * vertex);
  const auto solid = make_solid(mesh, name);
  if (!solid) return solid.error();
  if (auto fits = MeshShape::check_size(*solid, spacing_); !fits) {
    return Error{fits.error().kind, fits.error().message, name};
  }
  if (enclosed_volume(mesh) < 0.0) {
    for (Index3& t : mesh.triangles) std::swap(t[1], t[2]);
  }
  MeshFrame frame;
  for (const std::size_t k : {std::size_t{0}, frames_.size() - 1}) {
    if (frames_.empty() || frames_[k].vertices->size() != mesh.vertices.size()) continue;
    if (*frames_[k].triangles == mesh.triangles) frame.triangles = frames_[k].triangles;
  }
  if (frame.triangles == nullptr) {
    frame.triangles = std::make_shared<const std::vector<Index3>>(std::move(mesh.triangles));
  }
  frame.vertices = std::make_shared<const std::vector<Vec3>>(std::move(mesh.vertices));
  return frame;
}

Result<std::shared_ptr<MeshSequence>> MeshSequence::led(const ShapeDescription& shape, double rate,
                                                        const std::string& folder, double spacing,
                                                        bool allow_outside_paths) {
  if (!(std::isfinite(rate) && rate > 0.0))
    return Error{ErrorKind::kUsage, "meshes need a positive rate, in 1/s", ""};
  SequenceDescription frames;
  frames.given = true;
  frames.rate = rate;
  try {
    const std::shared_ptr<MeshSequence> sequence(new MeshSequence(frames, spacing));
    const auto path = resolve_path(folder, shape.file, "mesh file", allow_outside_paths);
    if (!path) return path.error();
    if (auto added = sequence->add(shape, *path); !added) return added.error();
    sequence->led_ = shape;
    sequence->find_ways();
    return sequence;
  } catch (const std::bad_alloc&) {
    return Error{ErrorKind::kMemory, "not enough memory for the mesh", shape.file};
  }
}

Result<std::int64_t> MeshSequence::stretch_that_begins(double time) const {
  const double since = time * description_.rate, whole = std::round(since);
  if (std::abs(since - whole) <= kRounding) return static_cast<std::int64_t>(whole);
  return Error{ErrorKind::kUsage,
               "meshes follow one another " + number_text(description_.rate) + " times a second, and time " +
                   number_text(time) + " s lies between two of them",
               ""};
}

/// What it rests at until then is repeated, and what is past let go.
void MeshSequence::put(std::size_t number, MeshFrame frame) {
  const std::lock_guard<std::mutex> lock(cache_->mutex);
  while (count() < number) {
    frames_.push_back(frames_.back());
    ways_.push_back(0.0);
  }
  cache_->solids.forget(number);
  for (const std::size_t k : {number - 1, number}) cache_->tracks.forget(k);
  if (count() > number) {  // said again
    frames_.resize(number - past_);
    ways_.resize(number - past_);
  }
  ways_.back() = way_between(frames_.back(), frame);
  frames_.push_back(std::move(frame));
  ways_.push_back(0.0);
  constexpr std::size_t kHeld = 3;  // the ends of the stretch at hand, and one before
  while (frames_.size() > kHeld) {
    frames_.pop_front();
    ways_.pop_front();
    ++past_;
  }
}

Result<void> MeshSequence::next(TriangleMesh mesh, double time) {
  const auto stretch = stretch_that_begins(time);
  if (!stretch) return stretch.error();
  if (static_cast<std::size_t>(*stretch) < past_)
    return Error{ErrorKind::kUsage, "time has gone back since its last mesh; say first where it stands now",
                 ""};
  try {
    auto frame = frame_of(*led_, std::move(mesh), "mesh of a host");
    if (!frame) return frame.error();
    put(static_cast<std::size_t>(*stretch) + 1, std::move(*frame));
    return {};
  } catch (const std::bad_alloc&) {
    return Error{ErrorKind::kMemory, "not enough memory for the mesh", ""};
  }
}

/// From its very beginning on, as far as anybody asks.
Result<void> MeshSequence::stand(TriangleMesh mesh, double time) {
  const auto stretch = stretch_that_begins(time);
  if (!stretch) return stretch.error();
  try {
    auto frame = frame_of(*led_, std::move(mesh), "mesh of a host");
    if (!frame) return frame.error();
    const std::lock_guard<std::mutex> lock(cache_->mutex);
    cache_->solids.list.clear();
    cache_->tracks.list.clear();
    past_ = static_cast<std::size_t>(std::max<std::int64_t>(0, *stretch - 1));
    frames_.assign(static_cast<std::size_t>(*stretch) - past_ + 1, *frame);
    ways_.assign(frames_.size(), 0.0);
    return {};
  } catch (const std::bad_alloc&) {
    return Error{ErrorKind::kMemory, "not enough memory for the mesh", ""};
  }
}

void MeshSequence::find_ways() {
  for (std::size_t k = 0; k < frames_.size(); ++k) {
    const bool last = k + 1 == frames_.size();
    const bool ends = last && !description_.repeat;
    ways_.push_back(ends ? 0.0 : way_between(frames_[k], frames_[last ? 0 : k + 1]));
  }
}

double MeshSequence::way_between(const MeshFrame& from, const MeshFrame& to) const {
  if (from.triangles != to.triangles) return std::max(farthest(from, to), farthest(to, from));
  double most = 0.0;
  for (std::size_t i = 0; i < from.vertices->size(); ++i) {
    most = std::max(most, ((*to.vertices)[i] - (*from.vertices)[i]).norm());
  }
  return most;
}

/// As many frames as have passed; not less than none, and but for rounding no more than there are.
double MeshSequence::frames_since_start(double time) const {
  const double since = std::max(0.0, (time - description_.start) * description_.rate);
  const double last = static_cast<double>(count() - 1);
  return description_.repeat || since <= last + kRounding ? since : last;
}

MeshSequence::Place MeshSequence::place(double time) const {
  const double number = static_cast<double>(count()), since = frames_since_start(time);
  const double within = description_.repeat ? std::fmod(since, number) : since;
  const std::size_t last = count() - 1;
  // At its very end a sequence is at the end of its last stretch: that is the one that it was moved along.
  const std::size_t stretches = description_.repeat ? count() : std::max<std::size_t>(last, 1);
  const std::size_t from = std::min(static_cast<std::size_t>(within), stretches - 1);
  const double share = within - static_cast<double>(from);
  const bool comes_round = description_.repeat && from == 0 && since > 0.5;
  if (share <= kRounding && (from > past_ || comes_round)) return {from == 0 ? last : from - 1, from, 1.0};
  return {from, from == last ? 0 : from + 1, std::min(share, 1.0)};
}

std::shared_ptr<const Shape> MeshSequence::solid(std::size_t number) const {
  return cache_->solids.get(number, [&] {
    auto closed = make_solid(mesh_of(frame(number)), "frame");
    if (!closed) throw std::bad_alloc();  // it was a solid, and it fitted, when it was read
    auto shape = MeshShape::make(std::move(*closed), spacing_);
    if (!shape) throw std::bad_alloc();
    return *shape;
  });
}

std::shared_ptr<const MovingTriangles> MeshSequence::track(std::size_t from, std::size_t to) const {
  if (frame(from).triangles != frame(to).triangles || !(way(from) > 0.0)) return nullptr;
  return cache_->tracks.get(from, [&] {
    return std::make_shared<const MovingTriangles>(frame(from).vertices, frame(to).vertices,
                                                   frame(from).triangles);
  });
}

std::shared_ptr<const MorphedShape> MeshSequence::at(double time) const {
  const std::lock_guard<std::mutex> lock(cache_->mutex);
  const Place now = place(time);
  MeshFrame from = frame(now.from), to = frame(now.to);
  from.solid = solid(now.from);
  to.solid = solid(now.to);
  return std::make_shared<const MorphedShape>(std::move(from), std::move(to), track(now.from, now.to),
                                              now.share, MeshShape::kBandCells * spacing_);
}

double MeshSequence::moving_share(double from, double to) const {
  if (!(to > from)) return 0.0;
  return std::min(1.0, (frames_since_start(to) - frames_since_start(from)) / ((to - from) * description_.rate));
}

double MeshSequence::fastest(double from, double to) const {
  const double begin = frames_since_start(from), end = frames_since_start(to);
  if (!(end > begin)) return 0.0;
  const double number = static_cast<double>(count());
  const double first = std::floor(begin + kRounding), last = std::min(end - kRounding, first + number);
  double most = 0.0;
  for (double k = first; k == first || k < last; k += 1.0) {
    most = std::max(most, way(std::max(past_, static_cast<std::size_t>(std::fmod(k, number)))));
  }
  return most * description_.rate;
}

double MeshSequence::window(double time, double margin) const {
  const double since = frames_since_start(time), whole = std::floor(since);
  const auto at = static_cast<std::size_t>(std::fmod(whole, static_cast<double>(count())));
  const double parts = std::max(1.0, std::ceil(way(std::max(past_, at)) / margin));
  return description_.start + (whole + std::floor((since - whole) * parts) / parts) / description_.rate;
}

}  // namespace repose
