#include "../src/ros_entities.hpp"

#include <gmock/gmock.h>

#include <numeric>
#include <random>

#include "goshawk/runtime/message_type.hpp"
#include "rmw_dds_common.h"

namespace goshawk::runtime {
namespace {

namespace msg = rmw_dds_common::msg;
using Bytes = std::vector<unsigned char>;
using testing::ElementsAre;

Gid gid(unsigned char first) {
  Gid value{};
  std::iota(value.begin(), value.end(), first);
  return value;
}

// Names of several lengths, so that what follows them has every alignment.
RosEntities example() {
  return {gid(1),
          {{"/uav1/navigator", {gid(20), gid(40)}, {gid(60)}},
           {"/viewer", {}, {gid(80)}},
           {"/a/b/cd", {gid(100)}, {}},
           {"/x", {}, {}}}};
}

msg::Gid as_message(const Gid& value) {
  msg::Gid message;
  std::ranges::copy(value, message.data().begin());
  return message;
}

TEST(RosEntities, HaveTheBytesOfTheGeneratedTypeInHumblesLayout) {
  msg::ParticipantEntitiesInfo message;
  message.gid(as_message(gid(1)));
  const std::vector<std::pair<std::string, std::string>> names = {
      {"/uav1", "navigator"}, {"/", "viewer"}, {"/a/b", "cd"}, {"/", "x"}};
  const RosEntities entities = example();
  for (std::size_t i = 0; i < names.size(); ++i) {
    msg::NodeEntitiesInfo node;
    node.node_namespace(names[i].first);
    node.node_name(names[i].second);
    for (const auto& g : entities.nodes[i].readers) node.reader_gid_seq().push_back(as_message(g));
    for (const auto& g : entities.nodes[i].writers) node.writer_gid_seq().push_back(as_message(g));
    message.node_entities_info_seq().push_back(node);
  }
  EXPECT_EQ(encode(entities, GidLength::humble), encode(message));
}

TEST(RosEntities, HaveGidsOf16BytesFromIronOn) {
  const RosEntities entities{gid(1), {{"/n", {gid(32)}, {}}}};
  const Bytes expected = {0,  1,  0,  0,                                                    //
                          1,  2,  3,  4,  5,   6,  7,  8,  9,  10, 11, 12, 13, 14, 15, 16,  //
                          1,  0,  0,  0,                                                    //
                          2,  0,  0,  0,  '/', 0,  0,  0,                                   //
                          2,  0,  0,  0,  'n', 0,  0,  0,                                   //
                          1,  0,  0,  0,                                                    //
                          32, 33, 34, 35, 36,  37, 38, 39, 40, 41, 42, 43, 44, 45, 46, 47,  //
                          0,  0,  0,  0};
  EXPECT_EQ(encode(entities, GidLength::iron), expected);
}

TEST(RosEntities, AreReadInEitherLayout) {
  for (const auto length : {GidLength::humble, GidLength::iron}) {
    const auto told = decode_node_names(encode(example(), length));
    ASSERT_TRUE(told) << int(length);
    EXPECT_EQ(told->participant, gid(1));
    EXPECT_THAT(told->names, ElementsAre("/uav1/navigator", "/viewer", "/a/b/cd", "/x"));
    const auto none = decode_node_names(encode(RosEntities{gid(1), {}}, length));
    ASSERT_TRUE(none) << int(length);
    EXPECT_TRUE(none->names.empty());
  }
}

TEST(RosEntities, AreReadInEitherByteOrder) {
  const RosEntities entities{gid(1), {{"/n", {}, {}}}};
  Bytes big = encode(entities, GidLength::iron);
  big[1] = 0;
  // The counts: of nodes, of the bytes of both names, of readers and writers.
  for (const std::size_t at : {20, 24, 32, 40, 44}) std::reverse(&big[at], &big[at] + 4);
  const auto told = decode_node_names(big);
  ASSERT_TRUE(told);
  EXPECT_THAT(told->names, ElementsAre("/n"));
}

TEST(RosEntities, NameNoNodeIfCutOffAnywhere) {
  for (const auto length : {GidLength::humble, GidLength::iron}) {
    const Bytes whole = encode(example(), length);
    for (std::size_t size = 0; size < whole.size(); ++size) {
      // What is left may be a participant without nodes, in the other layout.
      const auto told = decode_node_names(std::span(whole).first(size));
      EXPECT_TRUE(!told || told->names.empty()) << size;
    }
    Bytes longer = whole;
    longer.resize(whole.size() + 3);  // padding
    EXPECT_TRUE(decode_node_names(longer));
    longer.push_back(0);
    EXPECT_FALSE(decode_node_names(longer));
  }
}

TEST(RosEntities, AreRefusedWithNamesThatAreNoneInRos) {
  for (const char* name : {"/a b", "/\x1b[2J", "/a//b", "a/b", "/a/"}) {
    EXPECT_FALSE(decode_node_names(encode(RosEntities{gid(1), {{name, {}, {}}}}, GidLength::iron)))
        << name;
  }
}

// A claim of 4 billion elements costs nothing; the sanitizers watch the rest.
TEST(RosEntities, OfAHostileSenderAreReadWithoutHarm) {
  std::mt19937 random(1);
  const Bytes whole = encode(example(), GidLength::humble);
  int refused = 0;
  for (int trial = 0; trial < 20'000; ++trial) {
    Bytes bytes = whole;
    for (int i = 0; i < 3; ++i) bytes[random() % bytes.size()] = (unsigned char)(random());
    const auto told = decode_node_names(bytes);
    refused += told ? 0 : 1;
    EXPECT_LE(told ? told->names.size() : 0, bytes.size());
  }
  EXPECT_GT(refused, 1000);
}

}  // namespace
}  // namespace goshawk::runtime
