// Repose: particles to files and back, and what happens when the disk, the folder or the file is bad.
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <numeric>
#include <random>

#include "engine/io/atomic_file.h"
#include "engine/io/point_cloud.h"
#include "tests/file_bytes.h"

namespace repose {
namespace {

namespace fs = std::filesystem;

/// A folder that vanishes with the test.
class PointFiles : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("repose_points_" + std::to_string(::getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  std::size_t files() const { return std::distance(fs::directory_iterator(folder_), fs::directory_iterator()); }

  fs::path folder_;
};
using AtomicFiles = PointFiles;

PointCloud make_cloud(std::size_t count, std::array<double, 3> origin = {0, 0, 0}) {
  PointCloud points;
  points.spacing = 0.02;
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  for (std::size_t p = 0; p < count; ++p) {
    points.position.push_back({origin[0] + unit(random), origin[1] + unit(random), origin[2] + unit(random)});
    points.velocity.push_back({static_cast<float>(unit(random)), 1e-20f, -3e7f});
    points.id.push_back(static_cast<std::uint32_t>(0xfffffff0u - 7 * p));  // above the range of int32
    points.radius.push_back(0.005f + 1e-6f * static_cast<float>(p % 100));
  }
  for (const auto& [name, components] :
       {std::pair{"density", 1}, std::pair{"normal", 3}, std::pair{"stress", 6}, std::pair{"uv", 2},
        std::pair{"F", 9}, std::pair{"orient", 4}, std::pair{"age", 1}}) {
    PointAttribute attribute{name, components, {}};
    for (std::size_t i = 0; i < count * static_cast<std::size_t>(components); ++i) {
      attribute.values.push_back(static_cast<float>(unit(random)));
    }
    points.attributes.push_back(attribute);
  }
  return points;
}

std::vector<std::size_t> order_by_id(const PointCloud& points) {
  std::vector<std::size_t> order(points.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return points.id[a] < points.id[b]; });
  return order;
}

/// All but positions must come back to the bit; positions within `tolerance` metres.
void expect_same(const PointCloud& want, const PointCloud& have, double tolerance) {
  ASSERT_EQ(want.size(), have.size());
  EXPECT_EQ(want.spacing, have.spacing);
  const std::vector<std::size_t> a = order_by_id(want), b = order_by_id(have);
  for (std::size_t i = 0; i < want.size(); ++i) {
    ASSERT_EQ(want.id[a[i]], have.id[b[i]]);
    for (std::size_t k = 0; k < 3; ++k) {
      ASSERT_NEAR(want.position[a[i]][k], have.position[b[i]][k], tolerance);
    }
    ASSERT_EQ(want.velocity[a[i]], have.velocity[b[i]]);
    ASSERT_EQ(want.radius[a[i]], have.radius[b[i]]);
  }
  ASSERT_EQ(want.attributes.size(), have.attributes.size());
  for (std::size_t k = 0; k < want.attributes.size(); ++k) {
    const PointAttribute &w = want.attributes[k], &h = have.attributes[k];
    EXPECT_EQ(w.name, h.name);
    ASSERT_EQ(w.components, h.components);
    const auto n = static_cast<std::size_t>(w.components);
    for (std::size_t i = 0; i < want.size() * n; ++i) {
      ASSERT_EQ(w.values[a[i / n] * n + i % n], h.values[b[i / n] * n + i % n]) << w.name;
    }
  }
}

void put_bytes(const std::string& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

TEST_F(PointFiles, Vdb_RoundTrip_KeepsEverything) {
  const PointCloud points = make_cloud(20000);
  ASSERT_TRUE(write_vdb_points(points, path("a.vdb")));
  const Result<PointCloud> back = read_vdb_points(path("a.vdb"));
  ASSERT_TRUE(back) << back.error().text();
  expect_same(points, *back, points.spacing / 65535.0 * 1.01);
}

TEST_F(PointFiles, Vtp_RoundTrip_KeepsAllButTheSpacing) {
  for (const double far : {0.0, 1.0e5}) {  // near as float, far as double
    PointCloud points = make_cloud(2000, {far, 0, -far});
    ASSERT_TRUE(write_vtp(points, path("a.vtp")));
    const Result<PointCloud> back = read_vtp(path("a.vtp"));
    ASSERT_TRUE(back) << back.error().text();
    EXPECT_EQ(back->spacing, 0.0);
    points.spacing = 0.0;
    expect_same(points, *back, far > 0.0 ? 0.0 : 1e-7);
  }
}

TEST_F(PointFiles, VtpThatIsDamagedOrForeign_IsRefused) {
  EXPECT_EQ(read_vtp(path("none.vtp")).error().kind, ErrorKind::kNoInput);
  ASSERT_TRUE(write_vtp(make_cloud(200), path("a.vtp")));
  const std::string good = bytes_of(path("a.vtp"));
  const std::size_t data = good.find("\n_") + 2, verts = good.find("</VTKFile>") - 200 * 16 - 64;
  for (std::size_t size = 0; size < verts; size += size < data ? 50 : 1999) {
    put_bytes(path("cut.vtp"), good.substr(0, size));
    const Result<PointCloud> cut = read_vtp(path("cut.vtp"));
    ASSERT_FALSE(cut) << size;
    EXPECT_EQ(cut.error().kind, ErrorKind::kIo);
    EXPECT_EQ(cut.error().where, path("cut.vtp"));
  }
  std::string huge = good;
  for (std::size_t k = 0; k < 8; ++k) huge[data + k] = '\xff';  // the size of the first array
  put_bytes(path("huge.vtp"), huge);
  EXPECT_NE(read_vtp(path("huge.vtp")).error().message.find("array 'v' is cut short"), std::string::npos);
  std::string ascii = good;
  ascii.replace(ascii.find("encoding=\"raw\""), 14, "encoding=\"b64\"");
  put_bytes(path("b64.vtp"), ascii);
  EXPECT_NE(read_vtp(path("b64.vtp")).error().message.find("as Repose writes it"), std::string::npos);
}

TEST_F(PointFiles, Vdb_TenKilometresAway_PositionsAsExact) {
  const PointCloud points = make_cloud(2000, {10000.0, -10000.0, 3.0});
  ASSERT_TRUE(write_vdb_points(points, path("a.vdb")));
  const Result<PointCloud> back = read_vdb_points(path("a.vdb"));
  ASSERT_TRUE(back) << back.error().text();
  expect_same(points, *back, points.spacing / 65535.0 * 1.01);
}

TEST_F(PointFiles, Vdb_SameCloudTwice_SameBytes) {
  const PointCloud points = make_cloud(20000);
  ASSERT_TRUE(write_vdb_points(points, path("a.vdb")));
  for (int i = 0; i < 5; ++i) {
    ASSERT_TRUE(write_vdb_points(points, path("b.vdb")));
    EXPECT_EQ(bytes_of(path("a.vdb")), bytes_of(path("b.vdb")));
  }
}

TEST_F(PointFiles, Ply_RoundTrip_KeepsEverything) {
  const PointCloud points = make_cloud(5000);
  ASSERT_TRUE(write_ply(points, path("a.ply")));
  EXPECT_NE(bytes_of(path("a.ply")).find("property float x"), std::string::npos);
  const Result<PointCloud> back = read_ply(path("a.ply"));
  ASSERT_TRUE(back) << back.error().text();
  expect_same(points, *back, 1e-4 * points.spacing);
}

TEST_F(PointFiles, Ply_TenKilometresAway_PositionsAreDouble) {
  const PointCloud points = make_cloud(500, {10000.0, 0.0, 0.0});
  ASSERT_TRUE(write_ply(points, path("a.ply")));
  const Result<PointCloud> back = read_ply(path("a.ply"));
  ASSERT_TRUE(back) << back.error().text();
  expect_same(points, *back, 0.0);
}

TEST_F(PointFiles, Ply_FromElsewhere_OnlyPositionsNeeded) {
  std::string text =
      "ply\nformat binary_little_endian 1.0\ncomment by hand\nelement vertex 1\nproperty float x\n"
      "property double y\nproperty uchar red\nproperty short z\nelement face 0\n"
      "property list uchar int vertex_indices\nend_header\n";
  const float x = 1.5f;
  const double y = 2.25;
  const std::int16_t z = -3;
  text.append(reinterpret_cast<const char*>(&x), 4).append(reinterpret_cast<const char*>(&y), 8);
  text.append("\x07").append(reinterpret_cast<const char*>(&z), 2);
  put_bytes(path("a.ply"), text);
  const Result<PointCloud> back = read_ply(path("a.ply"));
  ASSERT_TRUE(back) << back.error().text();
  EXPECT_EQ(back->position.at(0), (std::array<double, 3>{1.5, 2.25, -3.0}));
  EXPECT_EQ(back->id.at(0), 0u);
  ASSERT_EQ(back->attributes.size(), 1u);
  EXPECT_EQ(back->attributes[0].name, "red");
  EXPECT_EQ(back->attributes[0].values.at(0), 7.0f);
}

TEST_F(PointFiles, AllFormats_NoParticles_WorkAndReadBack) {
  const PointCloud none;
  ASSERT_TRUE(write_vdb_points(none, path("a.vdb")));
  ASSERT_TRUE(write_ply(none, path("a.ply")));
  ASSERT_TRUE(write_vtp(none, path("a.vtp")));
  const Result<PointCloud> vdb = read_vdb_points(path("a.vdb"));
  const Result<PointCloud> ply = read_ply(path("a.ply"));
  ASSERT_TRUE(vdb) << vdb.error().text();
  ASSERT_TRUE(ply) << ply.error().text();
  EXPECT_EQ(vdb->size(), 0u);
  EXPECT_EQ(ply->size(), 0u);
}

TEST_F(PointFiles, AllWriters_FolderThatRefuses_CannotCreate) {
  const PointCloud points = make_cloud(10);
  put_bytes(path("plain"), "a file is no folder");
  for (const char* name : {"missing/a", "plain/a"}) {
    for (const auto write : {write_vdb_points, write_ply, write_vtp}) {
      const Result<void> done = write(points, path(name));
      ASSERT_FALSE(done);
      EXPECT_EQ(done.error().kind, ErrorKind::kCannotCreate);
      EXPECT_EQ(done.error().where, path(name));
    }
  }
}

TEST_F(PointFiles, AllWriters_DiskGivesOut_IoErrorAndOldFileKept) {
  const PointCloud points = make_cloud(30000);
  put_bytes(path("a"), "old");
  const auto before = std::signal(SIGXFSZ, SIG_IGN);
  rlimit limit{};
  getrlimit(RLIMIT_FSIZE, &limit);
  const rlimit tight{100000, limit.rlim_max};
  setrlimit(RLIMIT_FSIZE, &tight);  // stands in for a full disk: the write comes back short, then fails
  std::vector<Result<void>> done;
  for (const auto write : {write_vdb_points, write_ply, write_vtp}) done.push_back(write(points, path("a")));
  setrlimit(RLIMIT_FSIZE, &limit);
  std::signal(SIGXFSZ, before);
  for (const Result<void>& each : done) {
    ASSERT_FALSE(each);
    EXPECT_EQ(each.error().kind, ErrorKind::kIo) << each.error().text();
    EXPECT_NE(each.error().message.find("File too large"), std::string::npos) << each.error().text();
  }
  EXPECT_EQ(bytes_of(path("a")), "old");
  EXPECT_EQ(files(), 1u);  // no temporary is left
}

TEST_F(PointFiles, Readers_MissingFile_NoInput) {
  for (const auto read : {read_vdb_points, read_ply}) {
    const Result<PointCloud> back = read(path("none"));
    ASSERT_FALSE(back);
    EXPECT_EQ(back.error().kind, ErrorKind::kNoInput);
  }
}

TEST_F(PointFiles, Readers_CutAnywhere_ErrorNoCrash) {
  const PointCloud points = make_cloud(300);
  ASSERT_TRUE(write_vdb_points(points, path("a.vdb")));
  ASSERT_TRUE(write_ply(points, path("a.ply")));
  const std::string vdb = bytes_of(path("a.vdb")), ply = bytes_of(path("a.ply"));
  for (int i = 0; i < 60; ++i) {
    put_bytes(path("cut.vdb"), vdb.substr(0, vdb.size() * static_cast<std::size_t>(i) / 60));
    put_bytes(path("cut.ply"), ply.substr(0, ply.size() * static_cast<std::size_t>(i) / 60));
    const Result<PointCloud> cut_vdb = read_vdb_points(path("cut.vdb")), cut_ply = read_ply(path("cut.ply"));
    ASSERT_FALSE(cut_vdb);
    ASSERT_FALSE(cut_ply);
    EXPECT_EQ(cut_vdb.error().kind, ErrorKind::kIo);
    EXPECT_EQ(cut_ply.error().kind, ErrorKind::kIo);
    if (i < 59) continue;
    EXPECT_NE(cut_vdb.error().message.find("cut short"), std::string::npos) << cut_vdb.error().text();
    EXPECT_NE(cut_ply.error().message.find("cut short"), std::string::npos) << cut_ply.error().text();
  }
}

TEST_F(PointFiles, VdbReader_AnyFlippedBit_ErrorNoCrash) {
  ASSERT_TRUE(write_vdb_points(make_cloud(50), path("a.vdb")));
  const std::string good = bytes_of(path("a.vdb"));
  std::mt19937 random(11);
  for (int i = 0; i < 500; ++i) {
    std::string bad = good;
    bad[random() % bad.size()] ^= static_cast<char>(1 << random() % 8);
    put_bytes(path("bad.vdb"), bad);
    const Result<PointCloud> back = read_vdb_points(path("bad.vdb"));
    ASSERT_FALSE(back);
    EXPECT_EQ(back.error().kind, ErrorKind::kIo);
  }
}

TEST_F(PointFiles, PlyReader_ImpossibleHeaders_ErrorNoCrash) {
  const std::string start = "ply\nformat binary_little_endian 1.0\n";
  const std::string xyz = "property float x\nproperty float y\nproperty float z\n";
  const std::string row(12, '\0');
  for (const std::string& bad :
       {std::string("not a ply"),
        std::string("ply\nformat ascii 1.0\nelement vertex 0\n") + xyz + "end_header\n",
        start + "element vertex 18446744073709551615\n" + xyz + "end_header\n" + row,
        start + "element vertex 2\n" + xyz + "end_header\n" + row,
        start + "element vertex 9\nend_header\n" + row,
        start + "element vertex 1\nproperty list uchar int x\n" + xyz + "end_header\n" + row,
        start + "element face 1\nproperty float x\nelement vertex 1\n" + xyz + "end_header\n" + row + row,
        start + "element vertex 1\n" + xyz + "end_header\n" + std::string("\0\0\x80\x7f", 4) + row,
        start + "element vertex 1\nproperty float x\nproperty float y\nend_header\n" + row, start}) {
    put_bytes(path("bad.ply"), bad);
    const Result<PointCloud> back = read_ply(path("bad.ply"));
    ASSERT_FALSE(back) << bad;
    EXPECT_EQ(back.error().kind, ErrorKind::kIo);
  }
}

TEST_F(PointFiles, AllWriters_CloudThatNoFileCouldHold_Refused) {
  const auto expect_refused = [&](const PointCloud& points, ErrorKind kind) {
    for (const auto write : {write_vdb_points, write_ply, write_vtp}) {
      const Result<void> done = write(points, path("a"));
      ASSERT_FALSE(done);
      EXPECT_EQ(done.error().kind, kind) << done.error().text();
    }
  };
  PointCloud points = make_cloud(10);
  points.position[3][1] = std::numeric_limits<double>::quiet_NaN();
  expect_refused(points, ErrorKind::kIo);
  points = make_cloud(10);
  points.radius.pop_back();
  expect_refused(points, ErrorKind::kUsage);
  for (const char* name : {"v", "x", "bad name", "<xml>", "", "stress_yy", "density"}) {
    points = make_cloud(10);
    points.attributes.push_back({name, 1, std::vector<float>(10)});
    expect_refused(points, ErrorKind::kUsage);
  }
  points = make_cloud(10);
  points.attributes.push_back({"odd", 5, std::vector<float>(50)});
  expect_refused(points, ErrorKind::kUsage);
  EXPECT_EQ(files(), 0u);
}

TEST_F(PointFiles, VtpSeries_NamesAreRelativeToTheList) {
  ASSERT_TRUE(write_vtp_series({path("a.0001.vtp"), path("odd\".vtp")}, {0.0, 1.0 / 24}, path("a.vtp.series")));
  const std::string text = bytes_of(path("a.vtp.series"));
  EXPECT_NE(text.find("{\"name\": \"a.0001.vtp\", \"time\": 0}"), std::string::npos) << text;
  EXPECT_NE(text.find("{\"name\": \"odd\\\".vtp\", \"time\": 0.041666666666666664}"), std::string::npos)
      << text;
  EXPECT_FALSE(write_vtp_series({"a.vtp"}, {}, path("b.vtp.series")));
}

TEST_F(AtomicFiles, NotCommitted_LeavesNothing) {
  {
    Result<AtomicFile> file = AtomicFile::create(path("a"));
    ASSERT_TRUE(file);
    ASSERT_TRUE(file->write("abc", 3));
    EXPECT_EQ(files(), 1u);
  }
  EXPECT_EQ(files(), 0u);
}

TEST_F(AtomicFiles, Committed_HoldsWhatWasWrittenAndOverwritten) {
  const std::string large(3 << 20, 'x');
  Result<AtomicFile> file = AtomicFile::create(path("a"));
  ASSERT_TRUE(file);
  ASSERT_TRUE(file->write("abcdef", 6));
  ASSERT_TRUE(file->overwrite(1, "BC", 2));
  ASSERT_TRUE(file->write(large.data(), large.size()));
  ASSERT_TRUE(file->write("end", 3));
  EXPECT_FALSE(fs::exists(path("a")));
  ASSERT_TRUE(file->commit());
  EXPECT_EQ(bytes_of(path("a")), "aBCdef" + large + "end");
  EXPECT_EQ(files(), 1u);
}

TEST_F(AtomicFiles, NameTakenByAFolder_CannotCreateAndNothingLeft) {
  Result<AtomicFile> file = AtomicFile::create(path("a"));
  ASSERT_TRUE(file);
  fs::create_directories(path("a"));
  const Result<void> done = file->commit();
  ASSERT_FALSE(done);
  EXPECT_EQ(done.error().kind, ErrorKind::kCannotCreate);
  EXPECT_EQ(AtomicFile::create(path("a")).error().kind, ErrorKind::kCannotCreate) << "before the work";
  EXPECT_EQ(files(), 1u);
}

}  // namespace
}  // namespace repose
