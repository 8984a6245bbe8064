#include "engine/io/ball_union.h"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <span>
#include <unordered_map>
#include <utility>

namespace repose {
namespace {

using Place = BlockLattice::Place;
constexpr int kSide = BlockLattice::kSide;

struct PlaceHash {
  std::size_t operator()(const Place& place) const {
    std::uint64_t hash = 0;
    for (const std::int32_t k : place) hash = (hash ^ static_cast<std::uint32_t>(k)) * 0x9e3779b97f4a7c15u;
    return hash ^ (hash >> 32);
  }
};

std::int32_t block_of(double x) {
  return static_cast<std::int32_t>(std::floor(x / kSide));
}

/// A ball whose centre is told from the first voxel of its bucket.
struct LocalBall {
  float at[3];
  float radius;
};

/// The balls whose centres lie in one block are neighbours in the list.
class Buckets {
 public:
  explicit Buckets(std::vector<Ball> balls) {
    // Of one radius after another, so that squares can be compared.
    const auto smaller = [](const Ball& a, const Ball& b) { return a.radius < b.radius; };
    if (!std::is_sorted(balls.begin(), balls.end(), smaller))
      std::stable_sort(balls.begin(), balls.end(), smaller);
    if (!balls.empty()) largest_ = balls.back().radius;
    std::vector<std::uint32_t> bucket(balls.size()), count;
    for (std::size_t k = 0; k < balls.size(); ++k) {
      const auto& x = balls[k].center;
      const Place place{block_of(x[0]), block_of(x[1]), block_of(x[2])};
      if (k > 0 && place == places_[bucket[k - 1]]) {
        bucket[k] = bucket[k - 1];
      } else {
        const auto [found, made] = index_.try_emplace(place, static_cast<std::uint32_t>(places_.size()));
        if (made) {
          places_.push_back(place);
          count.push_back(0);
        }
        bucket[k] = found->second;
      }
      ++count[bucket[k]];
    }
    first_.assign(count.size() + 1, 0);
    for (std::size_t b = 0; b < count.size(); ++b) first_[b + 1] = first_[b] + count[b];
    std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
    balls_.resize(balls.size());
    for (std::size_t k = 0; k < balls.size(); ++k) {
      LocalBall& ball = balls_[next[bucket[k]]++];
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double first = kSide * double(places_[bucket[k]][axis]);
        ball.at[axis] = static_cast<float>(balls[k].center[axis] - first);
      }
      ball.radius = balls[k].radius;
    }
  }

  std::size_t size() const { return places_.size(); }
  const Place& place(std::size_t bucket) const { return places_[bucket]; }
  std::span<const LocalBall> balls(std::size_t bucket) const {
    return {balls_.data() + first_[bucket], first_[bucket + 1] - first_[bucket]};
  }
  float largest() const { return largest_; }
  std::uint32_t find(const Place& place) const {
    const auto found = index_.find(place);
    return found == index_.end() ? BlockLattice::kNone : found->second;
  }

 private:
  std::vector<Place> places_;
  std::unordered_map<Place, std::uint32_t, PlaceHash> index_;
  std::vector<std::size_t> first_;
  std::vector<LocalBall> balls_;
  float largest_ = 0.0f;
};

template <class Body>
void for_each_place(const Place& lower, const Place& upper, const Body& body) {
  for (std::int32_t x = lower[0]; x <= upper[0]; ++x) {
    for (std::int32_t y = lower[1]; y <= upper[1]; ++y) {
      for (std::int32_t z = lower[2]; z <= upper[2]; ++z) body(Place{x, y, z});
    }
  }
}

/// How far the balls' distances are wanted along each axis, from their centres.
std::array<float, 3> reach_of(float radius, const Stretch& stretch, float margin) {
  std::array<float, 3> reach;
  reach.fill(radius + margin);
  if (stretch.axis >= 0) reach[static_cast<std::size_t>(stretch.axis)] += stretch.half;
  return reach;
}

/// The blocks that the balls reach.
std::vector<Place> reached(const Buckets& buckets, const Stretch& stretch, float margin) {
  std::vector<Place> places;
  for (std::size_t bucket = 0; bucket < buckets.size(); ++bucket) {
    Place lower, upper;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      float low = INFINITY, high = -INFINITY;
      for (const LocalBall& ball : buckets.balls(bucket)) {
        const float reach = reach_of(ball.radius, stretch, margin)[axis];
        low = std::min(low, ball.at[axis] - reach);
        high = std::max(high, ball.at[axis] + reach);
      }
      lower[axis] = buckets.place(bucket)[axis] + block_of(low);
      upper[axis] = buckets.place(bucket)[axis] + block_of(high);
    }
    for_each_place(lower, upper, [&places](const Place& place) { places.push_back(place); });
  }
  std::sort(places.begin(), places.end());
  places.erase(std::unique(places.begin(), places.end()), places.end());
  return places;
}

/// Distances of one block's voxels. While balls are of one radius, squares are compared.
class BlockDistances {
 public:
  BlockDistances(const Stretch& stretch, float margin, float* values)
      : stretch_(stretch), margin_(margin), values_(values) {
    std::fill(values_, values_ + BlockLattice::kVoxels, margin);
  }

  /// A ball of the bucket that lies `away` voxels from the block.
  void add(const LocalBall& ball, const std::array<float, 3>& away) {
    if (ball.radius != radius_) {
      fold();
      radius_ = ball.radius;
      reach_ = reach_of(radius_, stretch_, margin_);
      most_ = (radius_ + margin_) * (radius_ + margin_);
      squares_.fill(most_);
    }
    const float at[3] = {ball.at[0] + away[0], ball.at[1] + away[1], ball.at[2] + away[2]};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (at[axis] + reach_[axis] < 0.0f || at[axis] - reach_[axis] > kSide - 1) return;
    }
    float along[3][kSide];
    for (int axis = 0; axis < 3; ++axis) {
      const float half = axis == stretch_.axis ? stretch_.half : 0.0f;
      for (int k = 0; k < kSide; ++k) {
        const float off = std::max(std::abs(static_cast<float>(k) - at[axis]) - half, 0.0f);
        along[axis][k] = off * off;
      }
    }
    const Row along_z = Eigen::Map<const Row>(along[2]);
    for (int x = 0; x < kSide; ++x) {
      if (along[0][x] >= most_) continue;
      for (int y = 0; y < kSide; ++y) {
        const float across = along[0][x] + along[1][y];
        if (across >= most_) continue;
        Eigen::Map<Row> row(squares_.data() + x * 64 + y * 8);
        row = row.min(across + along_z);
      }
    }
  }

  /// Takes the squares so far into the distances.
  void fold() {
    if (radius_ < 0.0f) return;
    for (std::size_t k = 0; k < BlockLattice::kVoxels; ++k)
      values_[k] = std::min(values_[k], std::max(std::sqrt(squares_[k]) - radius_, -margin_));
  }

 private:
  using Row = Eigen::Array<float, kSide, 1>;

  Stretch stretch_;
  float margin_, radius_ = -1.0f, most_ = 0.0f;
  std::array<float, 3> reach_{};
  float* values_;
  std::array<float, BlockLattice::kVoxels> squares_;
};

}  // namespace

BallUnion unite(std::vector<Ball> balls, Stretch stretch, float margin, Threads& threads) {
  const Buckets buckets(std::move(balls));
  BallUnion made{BlockLattice(reached(buckets, stretch, margin)), {}};
  made.distance.resize(made.lattice.size() * BlockLattice::kVoxels);
  Place far;
  for (std::size_t axis = 0; axis < 3; ++axis)
    far[axis] =
        static_cast<std::int32_t>(std::ceil(reach_of(buckets.largest(), stretch, margin)[axis] / kSide));
  threads.for_each(made.lattice.size(), [&](std::size_t block) {
    const Place& here = made.lattice.place(block);
    BlockDistances distances(stretch, margin, values_of(made.distance, block));
    for_each_place({-far[0], -far[1], -far[2]}, far, [&](const Place& away) {
      const std::uint32_t bucket = buckets.find({here[0] + away[0], here[1] + away[1], here[2] + away[2]});
      if (bucket == BlockLattice::kNone) return;
      const std::array<float, 3> voxels{static_cast<float>(kSide * away[0]),
                                        static_cast<float>(kSide * away[1]),
                                        static_cast<float>(kSide * away[2])};
      for (const LocalBall& ball : buckets.balls(bucket)) distances.add(ball, voxels);
    });
    distances.fold();
  });
  return made;
}

}  // namespace repose
