// Files that lie: each ends in an error with a sentence, or in a sound map; never in a crash, a
// hang, or a word on stderr from a library below.

#include <gmock/gmock.h>
#include <octomap/OcTree.h>

#include <limits>

#include "goshawk/map_server/map_file.hpp"
#include "goshawk/map_server/voxel_map.hpp"
#include "support.hpp"

namespace goshawk::map_server {
namespace {

using testing::Folder;
using ::testing::HasSubstr;

void expect_refused(const std::string& path, ErrorCode code) {
  const auto source = load_map(path);
  EXPECT_EQ(source.code(), code) << path;
  if (source.ok()) return;
  EXPECT_THAT(source.error().message, HasSubstr(path));
  EXPECT_GT(source.error().message.size(), path.size() + 20);
}

// A small tree of both kinds of file, with unknown, free and occupied space.
void write_tree(const Folder& folder) {
  octomap::OcTree tree(0.1);
  Random random(5);
  for (int i = 0; i < 40; ++i) {
    tree.updateNode(octomap::point3d(float(random.uniform(0, 1)), float(random.uniform(0, 1)),
                                     float(random.uniform(0, 1))),
                    random.chance(0.5));
  }
  ASSERT_TRUE(tree.write(folder.file("t.ot")));
  ASSERT_TRUE(tree.writeBinary(folder.file("t.bt")));
}

std::vector<std::pair<std::string, std::string>> valid_files() {
  const Folder folder;
  write_tree(folder);
  const std::string pcd =
      "VERSION .7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 2\n"
      "HEIGHT 1\nPOINTS 2\nDATA ";
  const std::string floats("\0\0\x80\x3f\0\0\0\x40\0\0\x40\x40\0\0\x80\x3f\0\0\x80\x3f\0\0\x80\x3f",
                           24);
  // LZF: two literal runs of 12 bytes.
  const std::string packed = "\x0b" + floats.substr(0, 12) + "\x0b" + floats.substr(12);
  const std::string sizes("\x1a\0\0\0\x18\0\0\0", 8);
  const std::string ply =
      "element vertex 2\nproperty float x\nproperty float y\nproperty float z\n"
      "end_header\n";
  return {{"t.bt", testing::bytes_of(folder.file("t.bt"))},
          {"t.ot", testing::bytes_of(folder.file("t.ot"))},
          {"a.pcd", pcd + "ascii\n1 2 3\n1 1 1\n"},
          {"b.pcd", pcd + "binary\n" + floats},
          {"c.pcd", pcd + "binary_compressed\n" + sizes + packed},
          {"a.ply", "ply\nformat ascii 1.0\n" + ply + "1 2 3\n1 1 1\n"},
          {"b.ply", "ply\nformat binary_little_endian 1.0\n" + ply + floats},
          {"m.3dmap", "voxel 4 5 6\n1 2 3\n0 0 0\n"}};
}

TEST(HostileFile, TheValidOnesAreValid) {
  const Folder folder;
  for (const auto& [name, bytes] : valid_files()) {
    const auto source = load_map(folder.write(name, bytes));
    EXPECT_TRUE(source) << name << ": " << (source ? "" : source.error().message);
  }
}

// What is cut off is refused, but for text files cut where a shorter file is a file as well.
TEST(HostileFile, CutOffAtEveryByteItIsRefusedOrStillSound) {
  const auto files = valid_files();
  ::testing::internal::CaptureStderr();
  for (const auto& [name, bytes] : files) {
    const bool ends_anywhere = name == "m.3dmap" || name == "a.pcd" || name == "a.ply";
    for (std::size_t length = 0; length < bytes.size(); ++length) {
      const auto source = load_map_bytes(bytes.substr(0, length), name);
      if (!ends_anywhere || length + 2 < bytes.size() / 2) {
        EXPECT_FALSE(source) << name << " cut to " << length;
      }
      if (!source) {
        EXPECT_TRUE(source.code() == ErrorCode::map_malformed ||
                    source.code() == ErrorCode::map_empty)
            << name << " cut to " << length << ": " << source.error().message;
      } else {
        EXPECT_TRUE(voxelize(*source)) << name;
      }
    }
  }
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

TEST(HostileFile, FlippedBitsNeverCrash) {
  const auto files = valid_files();
  Random random(9);
  ::testing::internal::CaptureStderr();
  int refused = 0;
  for (const auto& [name, bytes] : files) {
    for (int round = 0; round < 4000; ++round) {
      std::string damaged = bytes;
      for (int flips = 1 + random.below(4); flips > 0; --flips) {
        damaged[std::size_t(random.below(int(damaged.size())))] ^= char(1 << random.below(8));
      }
      LoadOptions options;
      options.max_voxels = 1'000'000;  // a flipped coordinate may span a large map: not wanted here
      const auto source = load_map_bytes(damaged, name, options);
      refused += source ? 0 : 1;
      if (source) {
        VoxelizeOptions small;
        small.max_voxels = 1'000'000;
        (void)voxelize(*source, small).ok();
      }
    }
  }
  EXPECT_GT(refused, 5000);
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

TEST(HostileFile, WhatIsNoFileIsUnreadable) {
  const Folder folder;
  expect_refused(folder.file("missing.bt"), ErrorCode::map_unreadable);
  expect_refused("/dev/zero.bt", ErrorCode::map_unreadable);
  std::filesystem::create_directory(folder.file("folder.bt"));
  expect_refused(folder.file("folder.bt"), ErrorCode::map_unreadable);
  expect_refused(folder.write("map.png", "x"), ErrorCode::map_unreadable);
  expect_refused(folder.write("map", "x"), ErrorCode::map_unreadable);
  EXPECT_EQ(load_map("").code(), ErrorCode::map_unreadable);
  ASSERT_EQ(::symlink("/dev/zero", folder.file("zero.bt").c_str()), 0);
  expect_refused(folder.file("zero.bt"), ErrorCode::map_unreadable);
}

TEST(HostileFile, EmptyAndForeignFilesAreMalformed) {
  const Folder folder;
  const std::string png("\x89PNG\r\n\x1a\n\0\0\0\rIHDR\xff\xff\xff\xff", 20);
  for (const std::string ending : {".bt", ".ot", ".pcd", ".ply", ".3dmap"}) {
    expect_refused(folder.write("empty" + ending, ""), ErrorCode::map_malformed);
    expect_refused(folder.write("png" + ending, png), ErrorCode::map_malformed);
    expect_refused(folder.write("zeros" + ending, std::string(5000, '\0')),
                   ErrorCode::map_malformed);
    expect_refused(folder.write("ones" + ending, std::string(5000, '\xff')),
                   ErrorCode::map_malformed);
  }
}

TEST(HostileFile, ClaimsOfABillionPointsAreCheckedAgainstTheFile) {
  const Folder folder;
  const std::string pcd =
      "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 1000000000\n"
      "HEIGHT 1\nPOINTS 1000000000\nDATA ";
  expect_refused(folder.write("a.pcd", pcd + "ascii\n1 2 3\n"), ErrorCode::map_malformed);
  expect_refused(folder.write("b.pcd", pcd + "binary\n123412341234"), ErrorCode::map_malformed);
  expect_refused(folder.write("c.pcd", pcd + "binary_compressed\n" +
                                           std::string("\x04\0\0\0\0\xd8\x2b\xcb\0\0\0\0", 12)),
                 ErrorCode::map_malformed);
  std::string most = pcd + "binary\n1234";
  most.replace(most.find("POINTS 1000000000"), 17, "POINTS 18446744073709551615");
  expect_refused(folder.write("d.pcd", most), ErrorCode::map_malformed);
  const std::string ply =
      "ply\nformat FORMAT 1.0\nelement junk 1000000000000\nelement vertex "
      "1000000000\nproperty float x\nproperty float y\nproperty float z\n"
      "end_header\n1 2 3\n";
  for (const std::string format : {"ascii", "binary_little_endian", "binary_big_endian"}) {
    std::string bytes = ply;
    bytes.replace(bytes.find("FORMAT"), 6, format);
    expect_refused(folder.write(format + ".ply", bytes), ErrorCode::map_malformed);
  }
  expect_refused(folder.write("list.ply",
                              "ply\nformat ascii 1.0\nelement junk 1\nproperty list "
                              "uint int i\nelement vertex 1\nproperty float x\n"
                              "property float y\nproperty float z\nend_header\n"
                              "4000000000 1 2\n"),
                 ErrorCode::map_malformed);
}

TEST(HostileFile, WarframeMapsMustHoldTheirVoxels) {
  const Folder folder;
  const auto refused = [&](const std::string& text, ErrorCode code) {
    expect_refused(folder.write("m.3dmap", text), code);
  };
  refused("voxel 0 5 5\n", ErrorCode::map_malformed);
  refused("voxel 5 5\n", ErrorCode::map_malformed);
  refused("voxel 5 5 -5\n", ErrorCode::map_malformed);
  refused("voxel 5 5 5\n5 0 0\n", ErrorCode::map_malformed);
  refused("voxel 5 5 5\n-1 0 0\n", ErrorCode::map_malformed);
  refused("voxel 5 5 5\n1 2\n", ErrorCode::map_malformed);
  refused("voxel 5 5 5\n1 2 99999999999\n", ErrorCode::map_malformed);
  refused("voxel 2147483647 2147483647 2147483647\n", ErrorCode::map_too_large);
  refused("voxel 30000 30000 30000\n", ErrorCode::map_too_large);
}

TEST(HostileFile, PointsFarApartAreTooLargeAndTheBoxMendsIt) {
  const Folder folder;
  const std::string path = folder.write(
      "far.pcd",
      "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 2\nHEIGHT 1\nPOINTS 2\n"
      "DATA ascii\n0.1 0.1 0.1\n1e30 1e30 -1e30\n");
  expect_refused(path, ErrorCode::map_too_large);
  LoadOptions options;
  options.box = Box{Vec3::Zero(), Vec3::Ones()};
  EXPECT_TRUE(load_map(path, options));
  options = {};
  options.cloud = CloudMeaning::scan;
  ::testing::internal::CaptureStderr();
  EXPECT_TRUE(load_map(path, options));
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

TEST(HostileFile, CloudsWithoutAUsablePointAreEmpty) {
  const Folder folder;
  const std::string header = "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\n";
  expect_refused(folder.write("none.pcd", header + "WIDTH 0\nHEIGHT 1\nPOINTS 0\nDATA binary\n"),
                 ErrorCode::map_empty);
  expect_refused(folder.write("nan.pcd", header + "WIDTH 1\nHEIGHT 1\nDATA ascii\nnan nan nan\n"),
                 ErrorCode::map_empty);
}

TEST(HostileFile, TreesThatRunDeepOrLieAboutTheirSizeAreMalformed) {
  const Folder folder;
  const auto bt = [&](const std::string& size, const std::string& res, const std::string& payload) {
    return folder.write("t.bt", "# Octomap OcTree binary file\nid OcTree\nsize " + size + "\nres " +
                                    res + "\ndata\n" + payload);
  };
  const std::string leaf("\x01\0", 2);
  EXPECT_TRUE(load_map(bt("2", "0.1", leaf)));
  // A million levels of "all children have children": OctoMap's own reader overflows the stack.
  expect_refused(bt("2000000", "0.1", std::string(2'000'000, '\xff')), ErrorCode::map_malformed);
  expect_refused(bt("3", "0.1", leaf), ErrorCode::map_malformed);
  expect_refused(bt("2", "0.1", leaf + "x"), ErrorCode::map_malformed);
  expect_refused(bt("-2", "0.1", leaf), ErrorCode::map_malformed);
  expect_refused(bt("2", "0", leaf), ErrorCode::map_malformed);
  expect_refused(bt("2", "nan", leaf), ErrorCode::map_malformed);
  expect_refused(bt("2", "1e-300", leaf), ErrorCode::map_malformed);
  expect_refused(bt("0", "0.1", ""), ErrorCode::map_empty);
  expect_refused(bt("1", "0.1", std::string(2, '\0')), ErrorCode::map_empty);
  expect_refused(folder.write("t.ot",
                              "# Octomap OcTree file\nid OcTreeStamped\nsize 1\nres 0.1\n"
                              "data\n12345"),
                 ErrorCode::map_malformed);
  const std::string nan_leaf = std::string("\0\0\0\0\x01", 5) + std::string("\0\0\xc0\x7f\0", 5);
  expect_refused(
      folder.write("n.ot", "# Octomap OcTree file\nid OcTree\nsize 2\nres 0.1\ndata\n" + nan_leaf),
      ErrorCode::map_malformed);
}

// One leaf of 32768 voxels a side is a sound file of a few bytes.
TEST(HostileFile, AHugeLeafIsTooLargeUnlessABoxCutsIt) {
  const Folder folder;
  const MapSource source =
      load_map(folder.write("t.bt",
                            "# Octomap OcTree binary file\nid OcTree\nsize 2\nres 0.1\n"
                            "data\n" +
                                std::string("\0\x80", 2)))
          .value();
  EXPECT_EQ(voxelize(source).code(), ErrorCode::map_too_large);
  VoxelizeOptions options;
  options.box = Box{Vec3(-1, -1, -1), Vec3(1, 1, 1)};
  const RawVoxels raw = voxelize(source, options).value();
  EXPECT_EQ(raw.occupied.count(), 1000);
  EXPECT_EQ(raw.known.count(), 1000);
}

}  // namespace
}  // namespace goshawk::map_server
