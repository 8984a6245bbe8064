// Repose: particles as binary PLY, the format that every mesh program reads. Positions are float, since many
// readers know nothing else, unless float would move a particle by more than 1e-4 cells: then double.
#include <algorithm>
#include <array>
#include <bit>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <limits>
#include <optional>
#include <sstream>
#include <utility>

#include "engine/base/input_file.h"
#include "engine/io/atomic_file.h"
#include "engine/io/point_layout.h"

namespace repose {
namespace {

static_assert(std::endian::native == std::endian::little, "PLY rows are copied as they lie in memory");

enum class Type { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kFloat, kDouble };

struct TypeName {
  const char* name;
  const char* sized_name;  // the other spelling that is about
  Type type;
  std::size_t bytes;
};

constexpr std::array<TypeName, 8> kTypes{{{"char", "int8", Type::kInt8, 1},
                                          {"uchar", "uint8", Type::kUint8, 1},
                                          {"short", "int16", Type::kInt16, 2},
                                          {"ushort", "uint16", Type::kUint16, 2},
                                          {"int", "int32", Type::kInt32, 4},
                                          {"uint", "uint32", Type::kUint32, 4},
                                          {"float", "float32", Type::kFloat, 4},
                                          {"double", "float64", Type::kDouble, 8}}};

struct Property {
  std::string name;
  Type type = Type::kFloat;
  std::size_t offset = 0;  // bytes from the start of the row
};

struct Header {
  std::uint64_t count = 0;
  std::size_t row_bytes = 0;
  double spacing = 0.0;
  std::vector<Property> properties;
};

Error damaged(const std::string& path, const std::string& why) {
  return Error{ErrorKind::kIo, "is not a PLY file of points: " + why, path};
}

// --- Writing

std::string header_text(const PointCloud& points, bool wide) {
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text << "ply\nformat binary_little_endian 1.0\ncomment created by repose\n"
       << std::setprecision(std::numeric_limits<double>::max_digits10) << "comment spacing " << points.spacing
       << "\nelement vertex " << points.size() << '\n';
  for (const char* name : {"x", "y", "z"}) text << "property " << (wide ? "double " : "float ") << name << '\n';
  for (const char* name : {"vx", "vy", "vz"}) text << "property float " << name << '\n';
  text << "property uint id\nproperty float radius\n";
  for (const PointAttribute& attribute : points.attributes) {
    for (int k = 0; k < attribute.components; ++k) {
      text << "property float " << component_name(attribute, k) << '\n';
    }
  }
  text << "end_header\n";
  return text.str();
}

Result<void> write_row(const PointCloud& points, std::size_t p, bool wide, AtomicFile& file) {
  std::array<std::byte, 24 + 12 + 4 + 4> row;
  std::size_t bytes = 0;
  const auto put = [&](const auto& value) {
    std::memcpy(&row[bytes], &value, sizeof value);
    bytes += sizeof value;
  };
  for (const double x : points.position[p]) wide ? put(x) : put(static_cast<float>(x));
  put(points.velocity[p]);
  put(points.id[p]);
  put(points.radius[p]);
  Result<void> done = file.write(row.data(), bytes);
  for (const PointAttribute& attribute : points.attributes) {
    const auto n = static_cast<std::size_t>(attribute.components);
    if (done) done = file.write(&attribute.values[p * n], n * sizeof(float));
  }
  return done;
}

// --- Reading

const TypeName* find_type(const std::string& name) {
  const auto found = std::find_if(kTypes.begin(), kTypes.end(),
                                  [&](const TypeName& t) { return name == t.name || name == t.sized_name; });
  return found == kTypes.end() ? nullptr : &*found;
}

// One line of the header after the first two; an empty string, or what is wrong with it.
std::string read_header_line(const std::string& line, bool& in_vertex, Header& header) {
  std::istringstream words(line);
  words.imbue(std::locale::classic());
  std::string keyword, first, second;
  words >> keyword >> first;
  if (keyword == "comment") {
    if (first == "spacing" && !(words >> header.spacing && header.spacing >= 0.0)) header.spacing = 0.0;
  } else if (keyword == "element") {
    if (!in_vertex && first != "vertex")
      return header.properties.empty() ? "its first element is no vertex" : "";
    in_vertex = first == "vertex";
    if (in_vertex && !header.properties.empty()) return "it has two lists of vertices";
    if (in_vertex && !(words >> header.count)) return "its number of vertices cannot be read";
  } else if (keyword == "property" && in_vertex) {
    const TypeName* type = find_type(first);
    if (!type || !(words >> second))
      return "its line '" + line.substr(0, 80) + "' names no scalar type and name";
    header.properties.push_back({second, type->type, header.row_bytes});
    header.row_bytes += type->bytes;
  } else if (keyword != "property" && keyword != "obj_info") {
    return "its header line '" + line.substr(0, 80) + "' is unknown";
  }
  return "";
}

Result<Header> read_header(std::ifstream& file, const std::string& path) {
  const auto next = [&](std::string& line) {
    constexpr std::size_t kLongest = 1000;
    line.clear();
    for (char c = 0; file.get(c) && c != '\n' && line.size() < kLongest;) {
      if (c != '\r') line += c;
    }
    return static_cast<bool>(file) && line.size() < kLongest;
  };
  std::string line;
  if (!next(line) || line != "ply") return damaged(path, "it does not begin with 'ply'");
  if (!next(line) || line != "format binary_little_endian 1.0") {
    return damaged(path, "its format is not binary_little_endian 1.0");
  }
  Header header;
  bool in_vertex = false;
  constexpr int kMostLines = 1000;
  for (int i = 0; i < kMostLines && next(line); ++i) {
    if (line == "end_header") return header;
    if (std::string wrong = read_header_line(line, in_vertex, header); !wrong.empty())
      return damaged(path, wrong);
  }
  return damaged(path, "its header has no end");
}

double value_of(const char* row, const Property& property) {
  const auto as = [&]<class T>(T value) {
    std::memcpy(&value, row + property.offset, sizeof value);
    return static_cast<double>(value);
  };
  switch (property.type) {
    case Type::kInt8:
      return as(std::int8_t{});
    case Type::kUint8:
      return as(std::uint8_t{});
    case Type::kInt16:
      return as(std::int16_t{});
    case Type::kUint16:
      return as(std::uint16_t{});
    case Type::kInt32:
      return as(std::int32_t{});
    case Type::kUint32:
      return as(std::uint32_t{});
    case Type::kFloat:
      return as(float{});
    case Type::kDouble:
      return as(double{});
  }
  return 0.0;
}

/// Takes rows apart. Properties that are not ours become attributes; those of ours that lack stay zero.
class RowReader {
 public:
  RowReader(const Header& header, PointCloud& points) : points_(points) {
    constexpr std::array<const char*, kKnown> kNames{"x", "y", "z", "vx", "vy", "vz", "id", "radius"};
    for (const Property& property : header.properties) {
      const auto known = std::find(kNames.begin(), kNames.end(), property.name);
      if (known != kNames.end()) {
        known_[static_cast<std::size_t>(known - kNames.begin())] = property;
      } else {
        extras_.push_back(property);
        points_.attributes.push_back({property.name, 1, {}});
      }
    }
  }

  bool has_positions() const { return known_[0] && known_[1] && known_[2]; }

  /// False where the position is not finite or the id is none.
  bool add(const char* row) {
    std::array<double, kKnown> value{};
    value[kId] = static_cast<double>(points_.size());
    for (std::size_t k = 0; k < kKnown; ++k) {
      if (known_[k]) value[k] = value_of(row, *known_[k]);
    }
    const auto& [x, y, z, vx, vy, vz, id, radius] = value;
    if (!std::isfinite(x) || !std::isfinite(y) || !std::isfinite(z)) return false;
    if (!(id >= 0.0 && id <= 4294967295.0)) return false;
    points_.position.push_back({x, y, z});
    points_.velocity.push_back({static_cast<float>(vx), static_cast<float>(vy), static_cast<float>(vz)});
    points_.id.push_back(static_cast<std::uint32_t>(id));
    points_.radius.push_back(static_cast<float>(radius));
    for (std::size_t k = 0; k < extras_.size(); ++k) {
      points_.attributes[k].values.push_back(static_cast<float>(value_of(row, extras_[k])));
    }
    return true;
  }

 private:
  static constexpr std::size_t kKnown = 8;
  static constexpr std::size_t kId = 6;
  PointCloud& points_;
  std::array<std::optional<Property>, kKnown> known_;
  std::vector<Property> extras_;
};

Result<PointCloud> read_rows(std::ifstream& file, const Header& header, const std::string& path) {
  PointCloud points;
  points.spacing = header.spacing;
  RowReader reader(header, points);
  if (!reader.has_positions()) return damaged(path, "its vertices have no x, y and z");
  constexpr std::uint64_t kRowsAtOnce = 4096;
  std::vector<char> block(kRowsAtOnce * header.row_bytes);
  for (std::uint64_t first = 0; first < header.count; first += kRowsAtOnce) {
    const std::uint64_t rows = std::min(kRowsAtOnce, header.count - first);
    if (!file.read(block.data(), static_cast<std::streamsize>(rows * header.row_bytes))) {
      return Error{ErrorKind::kIo, "reading failed", path};
    }
    for (std::uint64_t row = 0; row < rows; ++row) {
      if (reader.add(block.data() + row * header.row_bytes)) continue;
      return damaged(path, "vertex " + std::to_string(first + row) + " has no finite position or no 32-bit id");
    }
  }
  points.attributes = join_components(std::move(points.attributes));
  return points;
}

}  // namespace

Result<void> write_ply(const PointCloud& points, const std::string& path) {
  if (Result<void> good = check_cloud(points, path); !good) return good;
  Result<AtomicFile> file = AtomicFile::create(path);
  if (!file) return file.error();
  const bool wide = needs_double(points);
  const std::string header = header_text(points, wide);
  Result<void> done = file->write(header.data(), header.size());
  for (std::size_t p = 0; done && p < points.size(); ++p) done = write_row(points, p, wide, *file);
  if (!done) return done;
  return file->commit();
}

Result<PointCloud> read_ply(const std::string& path) {
  std::ifstream file = open_input(path);
  if (!file) return Error{ErrorKind::kNoInput, std::string("cannot be opened: ") + std::strerror(errno), path};
  Result<Header> header = read_header(file, path);
  if (!header) return header.error();

  // The count is believed only as far as there are bytes for it, so it cannot ask for all memory.
  std::error_code failed;
  const std::uintmax_t size = std::filesystem::file_size(path, failed);
  const std::uint64_t body = failed ? 0 : size - static_cast<std::uint64_t>(file.tellg());
  if (header->count > 0 && (header->row_bytes == 0 || header->count > body / header->row_bytes)) {
    return Error{ErrorKind::kIo,
                 "is cut short or damaged: it promises " + std::to_string(header->count) + " vertices of " +
                     std::to_string(header->row_bytes) + " bytes and holds " + std::to_string(body) + " bytes",
                 path};
  }
  return read_rows(file, *header, path);
}

}  // namespace repose
