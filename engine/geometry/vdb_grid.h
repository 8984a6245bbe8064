// Repose: values in space from VDB files, as other programs write them: trilinear between voxels, at places of
// the scene.
#pragma once

#include <memory>
#include <string>

#include "engine/base/params.h"
#include "engine/base/result.h"
#include "engine/base/vector.h"
#include "engine/vdb/vdb_reader.h"

namespace repose {

/// What a scene says of a grid (data only).
struct VdbDescription {
  bool given = false;
  std::string file;
  std::string name;  ///< of the grid in the file
};

/// Declares the scene keys of a grid; `values` says what stands in it, with their unit.
void describe_vdb(Fields& fields, VdbDescription& grid, const char* values);

/// Where the files of grids lie, and who parses them.
struct GridFiles {
  std::string folder;  ///< where relative paths start
  bool allow_outside_paths = false;
  VdbReader reader = {};
};

/// Immutable, so it may be asked from many threads. Values lie where the transform of the grid puts them, in
/// metres of the scene's frame; those of voxels that are not active are the grid's background.
class ScalarGrid {
 public:
  /// Reads a grid of floats, in a program of its own (engine/vdb/question.h). Errors, with the file: 65, no
  /// grid of this name (lists those there are), one of another type, values that are not finite, a file that
  /// Repose wrote and that is damaged; 66, a file that is missing or that OpenVDB cannot read within the limits
  /// of the reader, or no reader; 78, no memory.
  static Result<std::shared_ptr<const ScalarGrid>> read(const VdbDescription& grid, const GridFiles& files);
  virtual ~ScalarGrid() = default;

  /// At x (m), in the unit of the file.
  virtual double at(const Vec3& x) const = 0;
  /// The least value of all, with the background.
  virtual double least() const = 0;
};

/// The same for vectors of three floats; a staggered grid, as fluid solvers write, is read as such.
class VectorGrid {
 public:
  static Result<std::shared_ptr<const VectorGrid>> read(const VdbDescription& grid, const GridFiles& files);
  virtual ~VectorGrid() = default;

  virtual Vec3 at(const Vec3& x) const = 0;
  /// No value is larger, with the background.
  virtual double largest() const = 0;
};

}  // namespace repose
