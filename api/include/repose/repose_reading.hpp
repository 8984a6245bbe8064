/**
 * @file repose_reading.hpp
 * What repose.hpp, which includes it, lets a host read of an engine: copies of particles, and volumes.
 */
#ifndef REPOSE_REPOSE_READING_HPP
#define REPOSE_REPOSE_READING_HPP

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "repose_base.hpp"

namespace repose {
// Names apart from those of the engine, which the static library holds.
inline namespace host_1 {

/** A copy of all particles in the order of their ids. */
class Points {
 public:
  explicit Points(repose_points handle) : handle_(handle) {
    detail::check(repose_points_count(get(), &count_));
  }
  std::size_t size() const { return count_; }
  int components(const std::string& attribute) const {
    std::int32_t components = 0;
    detail::check(repose_points_components(get(), attribute.c_str(), &components));
    return components;
  }
  void read(const std::string& attribute, Span<float> into) const {
    detail::check(repose_points_read(get(), attribute.c_str(), into.data(), into.size()));
  }
  std::vector<float> read(const std::string& attribute) const {
    std::vector<float> values(count_ * static_cast<std::size_t>(components(attribute)) + 1);
    read(attribute, values);
    values.pop_back();  // so that there was an address also for no particle
    return values;
  }
  /** The bits of numbers in half precision. */
  std::vector<std::uint16_t> read_half(const std::string& attribute) const {
    std::vector<std::uint16_t> values(count_ * static_cast<std::size_t>(components(attribute)) + 1);
    detail::check(repose_points_read_half(get(), attribute.c_str(), values.data(), values.size()));
    values.pop_back();
    return values;
  }
  std::vector<std::array<double, 3>> positions() const {
    std::vector<std::array<double, 3>> positions(count_ + 1);
    detail::check(repose_points_positions(get(), positions[0].data(), 3 * count_));
    positions.pop_back();
    return positions;
  }
  std::vector<std::uint32_t> ids() const {
    std::vector<std::uint32_t> ids(count_ + 1);
    detail::check(repose_points_ids(get(), ids.data(), count_));
    ids.pop_back();
    return ids;
  }
  void write(const std::string& path) const { detail::check(repose_points_write(get(), path.c_str())); }
  repose_points get() const { return handle_.get(); }

 private:
  detail::Owned<repose_points, repose_points_destroy> handle_;
  std::size_t count_ = 0;
};

/** The material as a box of voxels. */
class Volume {
 public:
  explicit Volume(repose_volume handle) : handle_(handle), lattice_(repose_lattice_init()) {
    detail::check(repose_volume_lattice(get(), &lattice_));
  }
  const repose_lattice& lattice() const { return lattice_; }
  /** Values that a grid of one number has; "v" has three times as many numbers. */
  std::size_t size() const {
    return static_cast<std::size_t>(lattice_.count[0] * lattice_.count[1] * lattice_.count[2]);
  }
  void read(const std::string& grid, Span<float> into) const {
    detail::check(repose_volume_read(get(), grid.c_str(), into.data(), into.size()));
  }
  std::vector<float> read(const std::string& grid) const {
    const std::size_t numbers = size() * (grid == "v" ? 3 : 1);
    std::vector<float> values(numbers + 1);  // so that there was an address also for no value
    read(grid, values);
    values.pop_back();
    return values;
  }
  repose_volume get() const { return handle_.get(); }

 private:
  detail::Owned<repose_volume, repose_volume_destroy> handle_;
  repose_lattice lattice_;
};

}  // namespace host_1
}  // namespace repose

#endif
