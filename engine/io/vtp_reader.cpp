// Repose: VTP files that Repose wrote, for `info`: raw appended arrays with 64-bit sizes, one piece. That of
// other programs may be ASCII, compressed or in pieces; they are refused, since ParaView reads them all.
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <utility>
#include <vector>

#include "engine/io/point_cloud.h"

namespace repose {
namespace {

constexpr std::size_t kMostHeader = std::size_t{1} << 16;

/// The value of an attribute in an XML tag; empty where it has none.
std::string attribute_of(const std::string& tag, const std::string& name) {
  const std::string start = " " + name + "=\"";
  const std::size_t at = tag.find(start);
  if (at == std::string::npos) return "";
  const std::size_t first = at + start.size();
  return tag.substr(first, tag.find('"', first) - first);
}

std::uint64_t number_of(const std::string& tag, const std::string& name) {
  return std::strtoull(attribute_of(tag, name).c_str(), nullptr, 10);
}

/// One file: its header, and arrays by name.
class VtpFile {
 public:
  explicit VtpFile(const std::string& path) : path_(path), file_(path, std::ios::binary) {}

  Result<void> open();
  std::size_t points() const { return points_; }
  /// Names of arrays and their XML tags, in the order of the file.
  const std::vector<std::pair<std::string, std::string>>& tags() const { return tags_; }
  /// The tag of an array; empty where there is none.
  std::string tag(const std::string& name) const;

  /// Fills `values` with the array `name` of `components` Scalars a point.
  template <class Scalar, class Value>
  Result<void> read(const std::string& name, std::vector<Value>& values, std::size_t components);

  Error error(const std::string& message) const { return {ErrorKind::kIo, message, path_}; }

 private:
  std::string path_;
  std::ifstream file_;
  std::vector<std::pair<std::string, std::string>> tags_;
  std::uint64_t data_ = 0, size_ = 0;  // where arrays begin; the whole file, bytes
  std::size_t points_ = 0;
};

Result<void> VtpFile::open() {
  if (!file_) return Error{ErrorKind::kNoInput, "cannot be read; is the path right?", path_};
  std::error_code failure;
  size_ = std::filesystem::file_size(path_, failure);
  std::string header(kMostHeader, '\0');
  file_.read(header.data(), static_cast<std::streamsize>(header.size()));
  header.resize(static_cast<std::size_t>(file_.gcount()));
  file_.clear();
  const std::string start = "<AppendedData encoding=\"raw\">\n_";
  const std::size_t end = header.find(start);
  const bool ours = header.find("<VTKFile type=\"PolyData\"") != std::string::npos &&
                    header.find("header_type=\"UInt64\"") != std::string::npos;
  if (failure || end == std::string::npos || !ours) {
    return error("is not a VTP file as Repose writes it; ParaView reads others");
  }
  data_ = end + start.size();
  header.resize(end);
  for (std::size_t at = header.find('<'); at != std::string::npos; at = header.find('<', at + 1)) {
    const std::string tag = header.substr(at, header.find('>', at) - at);
    if (tag.starts_with("<Piece ")) points_ = number_of(tag, "NumberOfPoints");
    if (tag.starts_with("<DataArray ")) tags_.emplace_back(attribute_of(tag, "Name"), tag);
  }
  return {};
}

std::string VtpFile::tag(const std::string& name) const {
  for (const auto& [known, text] : tags_) {
    if (known == name) return text;
  }
  return "";
}

template <class Scalar, class Value>
Result<void> VtpFile::read(const std::string& name, std::vector<Value>& values, std::size_t components) {
  const std::string found = tag(name);
  if (found.empty()) return error("holds no array '" + name + "'; Repose writes one");
  const std::uint64_t at = data_ + number_of(found, "offset");
  std::uint64_t bytes = 0;
  file_.seekg(static_cast<std::streamoff>(at));
  file_.read(reinterpret_cast<char*>(&bytes), sizeof bytes);
  // The size before the memory: a damaged number must not ask for all there is.
  const bool fits = file_ && bytes <= size_ && at + sizeof bytes + bytes <= size_;
  if (!fits || bytes / sizeof(Scalar) / components != points_ || bytes % (sizeof(Scalar) * components) != 0) {
    return error("array '" + name + "' is cut short or has another size; write the file again");
  }
  values.resize(points_ * components * sizeof(Scalar) / sizeof(Value));
  file_.read(reinterpret_cast<char*>(values.data()), static_cast<std::streamsize>(bytes));
  if (!file_) return error("array '" + name + "' is cut short; write the file again");
  return {};
}

Result<void> read_positions(VtpFile& file, PointCloud& points) {
  const bool wide = attribute_of(file.tag("Points"), "type") == "Float64";
  if (wide) return file.read<double>("Points", points.position, 3);
  std::vector<std::array<float, 3>> single;
  if (auto read = file.read<float>("Points", single, 3); !read) return read;
  for (const auto& x : single) points.position.push_back({x[0], x[1], x[2]});
  return {};
}

}  // namespace

Result<PointCloud> read_vtp(const std::string& path) {
  VtpFile file(path);
  if (auto opened = file.open(); !opened) return opened.error();
  PointCloud points;
  Result<void> done = read_positions(file, points);
  if (done) done = file.read<float>("v", points.velocity, 3);
  if (done) done = file.read<std::uint32_t>("id", points.id, 1);
  if (done) done = file.read<float>("pscale", points.radius, 1);
  for (const auto& [name, tag] : file.tags()) {
    const bool known = name == "Points" || name == "v" || name == "id" || name == "pscale";
    if (!done || known || attribute_of(tag, "type") != "Float32") continue;
    PointAttribute attribute{name, static_cast<int>(number_of(tag, "NumberOfComponents")), {}};
    if (attribute.components < 1 || attribute.components > 9) {
      return file.error("array '" + name + "' has no number of components");
    }
    done = file.read<float>(name, attribute.values, static_cast<std::size_t>(attribute.components));
    points.attributes.push_back(std::move(attribute));
  }
  if (!done) return done.error();
  return points;
}

}  // namespace repose
