#include <gmock/gmock.h>

#include <fstream>

#include "../src/payload_check.hpp"
#include "domain.hpp"
#include "goshawk/core/random.hpp"
#include "goshawk_msgs.h"
#include "nav_msgs.h"
#include "sensor_msgs.h"
#include "visualization_msgs.h"

namespace goshawk::runtime {
namespace {

using goshawk_msgs::msg::VehicleStatus;
using runtime_test::join;
using runtime_test::spin_until;
using Bytes = std::vector<unsigned char>;

/// Writes raw bytes under the name of a real type, then a good message, and expects the good one.
class Hostile : public testing::Test {
 protected:
  template <typename Message>
  void survives(const std::vector<Bytes>& payloads, const Message& good) {
    int got = 0;
    Message last;
    victim_.subscribe<Message>("target", Qos::reliable_last(1000),
                               [&](const Message& m, const auto&) {
                                 last = m;
                                 ++got;
                               });
    const auto type = raw_message_type(message_type<Message>().name());
    const auto attacker = attacker_.advertise_raw("target", type, Qos::reliable_last(1000));
    ASSERT_TRUE(spin_until(victim_, [&] { return attacker.matched() > 0; }));
    const Bytes good_bytes = encode(good);
    for (const auto& payload : payloads) {
      (void)attacker.publish_raw(&payload);
      ASSERT_TRUE(attacker.publish_raw(&good_bytes));
    }
    // All were queued before the first take: none of the good ones may get lost behind a bad one.
    EXPECT_TRUE(spin_until(victim_, [&] { return got >= int(payloads.size()); }))
        << got << " of " << payloads.size() << " good messages";
    EXPECT_EQ(last, good);
  }

  std::unique_ptr<Context> context_a_ = join();
  std::unique_ptr<Context> context_b_ = join();
  Node attacker_{*context_a_, "attacker"};
  Node victim_{*context_b_, "victim"};
};

TEST_F(Hostile, BytesThatAreNoMessage) {
  VehicleStatus good;
  good.header().frame_id("map");
  good.command_age(0.5);
  const Bytes bytes = encode(good);
  std::vector<Bytes> payloads = {
      {}, {0}, {0, 1}, {0, 1, 0, 0}, Bytes(5, 0xff), Bytes(10'000, 0xff)};
  for (std::size_t n = 4; n < bytes.size(); n += 3) {
    payloads.emplace_back(bytes.begin(), bytes.begin() + long(n));
  }
  Bytes bad_bool = bytes;
  bad_bool[4 + 8 + 4 + 4] = 7;  // stamp, length of "map", its characters
  payloads.push_back(bad_bool);
  for (const unsigned char kind : {2, 3, 7, 0x55, 255}) {  // encapsulations that are none of ours
    payloads.push_back(bytes);
    payloads.back()[1] = kind;
  }
  survives(payloads, good);
}

TEST_F(Hostile, LengthsOfABillion) {
  nav_msgs::msg::Path good;
  good.header().frame_id("map");
  good.poses().resize(3);
  Bytes text = encode(good), sequence = encode(good);
  for (int i = 0; i < 4; ++i) {
    text[std::size_t(12 + i)] = sequence[std::size_t(20 + i)] =
        (unsigned char)(1'000'000'000 >> 8 * i);
  }
  survives({text, sequence}, good);
}

TEST(Decode, SaysNoToTheBadBool) {
  VehicleStatus good, out;
  Bytes bytes = encode(good);
  EXPECT_TRUE(decode(bytes, out));
  bytes[4 + 8 + 4 + 1] = 7;
  EXPECT_FALSE(decode(bytes, out));
  for (const Bytes& none : {Bytes{}, Bytes{0}, Bytes{0, 1, 0, 0}}) EXPECT_FALSE(decode(none, out));
}

TEST(Decode, SurvivesRandomBytes) {
  Random random(1);
  visualization_msgs::msg::MarkerArray out;
  for (int i = 0; i < 2000; ++i) {
    Bytes bytes = {0, (unsigned char)(random.below(2)), 0, 0};
    for (int n = random.below(200); n > 0; --n)
      bytes.push_back((unsigned char)(random.below(3) == 0 ? random.below(256) : 0));
    (void)decode(bytes, out);
  }
}

void put(Bytes& bytes, std::size_t at, std::uint32_t value) {
  for (std::size_t i = 0; i < 4; ++i) bytes[at + i] = (unsigned char)(value >> 8 * i);
}

/// [byte] of this process: "VmRSS", or "VmHWM", the most since reset_peak()
std::size_t memory(const std::string& which) {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (line.starts_with(which + ":")) return std::stoul(line.substr(which.size() + 1)) * 1024;
  }
  return 0;
}

/// @return [byte] that decoding took at the most, without what it was given
template <typename Message>
std::size_t taken_by(const Bytes& bytes, Message& out, bool decodes) {
  std::ofstream("/proc/self/clear_refs") << 5;  // the peak is what is held now
  const std::size_t before = memory("VmRSS");
  EXPECT_EQ(decode(bytes, out), decodes);
  const std::size_t most = memory("VmHWM");
  return most < before + bytes.size() ? 0 : most - before - bytes.size();
}

/// A sequence that claims `count` elements, of which nothing but `size` bytes of zeros is there.
Bytes claiming(std::uint32_t count, std::size_t size) {
  Bytes bytes(8 + size);
  bytes[1] = 1;  // little-endian
  put(bytes, 4, count);
  return bytes;
}

// Each marker is several hundred bytes in memory, and its fields take 130 on the wire at the least.
TEST(Decode, ClaimsNoMemoryForElementsThatAreNotThere) {
  constexpr std::size_t kBytes = 4 << 20;
  visualization_msgs::msg::MarkerArray out;
  for (const std::uint32_t count : {4'000'000U, 1'000'000'000U, 0xffffffffU}) {
    EXPECT_LT(taken_by(claiming(count, kBytes), out, false), 32U << 20) << count;
  }
}

// As many as are there, but far larger in memory than on the wire: 24 bytes make 88.
TEST(Decode, ClaimsNoMoreMemoryThanMessagesNeed) {
  goshawk_msgs::msg::VoxelGridUpdate out;
  Bytes bytes = encode(out);
  const std::size_t count_at = bytes.size() - 4;  // of the bricks
  EXPECT_TRUE(decode(bytes, out));
  constexpr std::uint32_t kBricks = 1'000'000, kBrick = 24;
  bytes.resize(count_at + 4 + kBricks * kBrick);
  put(bytes, count_at, kBricks);
  EXPECT_LT(taken_by(bytes, out, false), 32U << 20);
  put(bytes, count_at, 20'000);  // a map of 80 million voxels
  bytes.resize(count_at + 4 + 20'000 * kBrick);
  EXPECT_TRUE(decode(bytes, out));
  EXPECT_EQ(out.bricks().size(), 20'000U);
}

TEST(PayloadCheck, NamesWhatIsClaimedAndWhatIsAllowed) {
  const PayloadCheck check("visualization_msgs::msg::dds_::MarkerArray_");
  const std::string fault = check.fault_of(claiming(1'000'000'000, 1000));
  EXPECT_THAT(fault, testing::StartsWith("markers claims 1000000000 elements of "));
  EXPECT_THAT(fault, testing::HasSubstr("but the 1000 bytes left allow "));
  EXPECT_THAT(PayloadCheck("std_msgs::msg::dds_::String_").fault_of(claiming(1'000'000, 10)),
              testing::StartsWith("data claims 1000000 characters, but only 10 bytes are left"));
  visualization_msgs::msg::MarkerArray markers;
  markers.markers().resize(2);
  Bytes bytes = encode(markers);
  bytes.resize(bytes.size() - 10);
  EXPECT_THAT(check.fault_of(bytes), testing::StartsWith("markers."));
  EXPECT_THROW(PayloadCheck("std_msgs::msg::dds_::Nothing_"), std::logic_error);
}

/// Every whole message passes, none that is cut off anywhere does, and no byte that is wrong makes
/// the decoder throw or claim what is not there.
template <typename Message>
void expect_exact(const Message& message) {
  const PayloadCheck check(message_type<Message>().name());
  const Bytes bytes = encode(message);
  EXPECT_EQ(check.fault_of(bytes), "");
  Bytes padded = bytes;
  padded.resize(bytes.size() + 3);  // by RTPS
  EXPECT_EQ(check.fault_of(padded), "");
  for (std::size_t n = 0; n < bytes.size(); ++n) {
    EXPECT_NE(check.fault_of({bytes.data(), n}), "") << n << " of " << bytes.size();
  }
  Message out;
  for (std::size_t n = 4; n < bytes.size(); ++n) {
    Bytes wrong = bytes;
    wrong[n] ^= 0x81;
    if (decode(wrong, out)) {
      EXPECT_EQ(check.fault_of(wrong), "");
    }
  }
}

TEST(PayloadCheck, PassesWhatTheGeneratedCodeWrites) {
  nav_msgs::msg::Path path;
  path.header().frame_id("map");
  path.poses().resize(3);
  path.poses()[1].header().frame_id("a longer name of a frame");
  expect_exact(path);
  goshawk_msgs::msg::BezierTrajectory trajectory;
  trajectory.request().header().frame_id("map");
  trajectory.implementation("x");
  trajectory.pieces().resize(3);
  trajectory.polytopes().resize(2);
  trajectory.polytopes()[0].normals().resize(9);
  trajectory.polytopes()[0].offsets().resize(3);
  trajectory.yaw_points().resize(5);
  expect_exact(trajectory);
  goshawk_msgs::msg::VoxelGridUpdate update;
  update.header().frame_id("m");
  update.bricks().resize(2);
  update.bricks()[0].grown().resize(3);
  expect_exact(update);
  visualization_msgs::msg::MarkerArray markers;
  markers.markers().resize(3);
  markers.markers()[0].ns("n");
  markers.markers()[1].points().resize(2);
  markers.markers()[1].colors().resize(3);
  expect_exact(markers);
  goshawk_msgs::msg::StageReport report;
  report.counters().resize(3);
  expect_exact(report);
  VehicleStatus status;
  status.header().frame_id("map");
  expect_exact(status);
  sensor_msgs::msg::PointCloud2 cloud;
  cloud.fields().resize(3);
  cloud.fields()[1].name("y");
  cloud.data().resize(5);
  expect_exact(cloud);
}

}  // namespace
}  // namespace goshawk::runtime
