// Repose: particles as VTK PolyData (XML, raw appended binary), for ParaView and f3d, and the list that makes a
// sequence of them play with its times.
#include <bit>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <iomanip>
#include <limits>
#include <sstream>
#include <utility>

#include "engine/io/atomic_file.h"
#include "engine/io/point_layout.h"

namespace repose {
namespace {

static_assert(std::endian::native == std::endian::little, "the header says LittleEndian");

/// One array: how the header calls it, and what appends its bytes.
struct Block {
  std::string element;  // XML element up to its offset
  std::uint64_t bytes = 0;
  std::function<Result<void>(AtomicFile&)> write;
};

/// The blocks in the order in which they are appended.
struct Layout {
  std::vector<Block> point_data;
  std::vector<Block> points;
  std::vector<Block> vertices;
};

std::string array_element(const std::string& type, const std::string& name, int components) {
  return "<DataArray type=\"" + type + "\" Name=\"" + name + "\" NumberOfComponents=\"" +
         std::to_string(components) + "\" format=\"appended\"";
}

/// An array that lies in memory as the file wants it. `values` must outlive the block.
template <class Value>
Block plain_block(const std::string& type, const std::string& name, int components,
                  const std::vector<Value>& values) {
  const std::uint64_t bytes = values.size() * sizeof(Value);
  return {array_element(type, name, components), bytes,
          [&values, bytes](AtomicFile& file) { return file.write(values.data(), bytes); }};
}

/// An array of `count` values that are computed on the way.
template <class Value, class Get>
Block computed_block(const std::string& type, const std::string& name, int components, std::size_t count,
                     Get get) {
  return {array_element(type, name, components), count * sizeof(Value), [count, get](AtomicFile& file) {
            Result<void> done;
            for (std::size_t i = 0; done && i < count; ++i) {
              const Value value = get(i);
              done = file.write(&value, sizeof value);
            }
            return done;
          }};
}

Block position_block(const PointCloud& points) {
  if (needs_double(points)) return plain_block("Float64", "Points", 3, points.position);
  return computed_block<std::array<float, 3>>("Float32", "Points", 3, points.size(), [&](std::size_t p) {
    const auto& x = points.position[p];
    return std::array<float, 3>{static_cast<float>(x[0]), static_cast<float>(x[1]), static_cast<float>(x[2])};
  });
}

Layout layout_of(const PointCloud& points) {
  Layout layout;
  layout.point_data.push_back(plain_block("Float32", "v", 3, points.velocity));
  layout.point_data.push_back(plain_block("UInt32", "id", 1, points.id));
  layout.point_data.push_back(plain_block("Float32", "pscale", 1, points.radius));
  for (const PointAttribute& attribute : points.attributes) {
    layout.point_data.push_back(plain_block("Float32", attribute.name, attribute.components, attribute.values));
  }
  layout.points.push_back(position_block(points));
  // One vertex cell per particle, not one cell of all: so that thresholds and selections by cell work.
  for (const auto& [name, first] : {std::pair{"connectivity", 0}, std::pair{"offsets", 1}}) {
    layout.vertices.push_back(
        computed_block<std::int64_t>("Int64", name, 1, points.size(),
                                     [first](std::size_t p) { return static_cast<std::int64_t>(p) + first; }));
  }
  return layout;
}

std::string header_text(const Layout& layout, std::size_t count) {
  std::ostringstream text;
  text.imbue(std::locale::classic());
  std::uint64_t offset = 0;
  const auto put = [&](const char* section, const std::vector<Block>& blocks) {
    text << '<' << section << ">\n";
    for (const Block& block : blocks) {
      text << block.element << " offset=\"" << offset << "\"/>\n";
      offset += sizeof(std::uint64_t) + block.bytes;
    }
    text << "</" << section << ">\n";
  };
  text << "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" "
          "header_type=\"UInt64\">\n<PolyData>\n<Piece NumberOfPoints=\""
       << count << "\" NumberOfVerts=\"" << count
       << "\" NumberOfLines=\"0\" NumberOfStrips=\"0\" NumberOfPolys=\"0\">\n";
  put("PointData", layout.point_data);
  put("Points", layout.points);
  put("Verts", layout.vertices);
  text << "</Piece>\n</PolyData>\n<AppendedData encoding=\"raw\">\n_";
  return text.str();
}

Result<void> write_text(AtomicFile& file, const std::string& text) {
  return file.write(text.data(), text.size());
}

Result<void> write_blocks(AtomicFile& file, const std::vector<Block>& blocks) {
  for (const Block& block : blocks) {
    if (Result<void> done = file.write(&block.bytes, sizeof block.bytes); !done) return done;
    if (Result<void> done = block.write(file); !done) return done;
  }
  return {};
}

std::string json_text(const std::string& plain) {
  std::string quoted = "\"";
  for (const char c : plain) {
    char code[8];
    if (c == '"' || c == '\\') {
      quoted += '\\';
      quoted += c;
    } else if (static_cast<unsigned char>(c) < 0x20) {
      std::snprintf(code, sizeof code, "\\u%04x", static_cast<unsigned>(c));
      quoted += code;
    } else {
      quoted += c;
    }
  }
  return quoted + '"';
}

}  // namespace

Result<void> write_vtp(const PointCloud& points, const std::string& path) {
  if (Result<void> good = check_cloud(points, path); !good) return good;
  Result<AtomicFile> file = AtomicFile::create(path);
  if (!file) return file.error();
  const Layout layout = layout_of(points);
  Result<void> done = write_text(*file, header_text(layout, points.size()));
  for (const auto* blocks : {&layout.point_data, &layout.points, &layout.vertices}) {
    if (done) done = write_blocks(*file, *blocks);
  }
  if (done) done = write_text(*file, "\n</AppendedData>\n</VTKFile>\n");
  if (!done) return done;
  return file->commit();
}

Result<void> write_vtp_series(const std::vector<std::string>& paths, const std::vector<double>& times,
                              const std::string& path) {
  if (paths.size() != times.size()) {
    return Error{ErrorKind::kUsage, "a series needs one time for each file", path};
  }
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text << std::setprecision(std::numeric_limits<double>::max_digits10)
       << "{\n  \"file-series-version\": \"1.0\",\n  \"files\": [";
  for (std::size_t i = 0; i < paths.size(); ++i) {
    // Names are relative to the list, so that the folder can be moved.
    const std::filesystem::path relative = std::filesystem::path(paths[i]).lexically_relative(folder);
    text << (i == 0 ? "\n" : ",\n")
         << "    {\"name\": " << json_text(relative.empty() ? paths[i] : relative.string())
         << ", \"time\": " << times[i] << "}";
  }
  text << "\n  ]\n}\n";
  Result<AtomicFile> file = AtomicFile::create(path);
  if (!file) return file.error();
  if (Result<void> done = write_text(*file, text.str()); !done) return done;
  return file->commit();
}

}  // namespace repose
