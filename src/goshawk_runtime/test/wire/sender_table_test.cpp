#include <gtest/gtest.h>

#include "../../src/wire/sender_table.hpp"

namespace goshawk::runtime {
namespace {

wire::SenderTable::Prefix named(std::uint8_t id) {
  wire::SenderTable::Prefix prefix{};
  prefix[11] = std::byte{id};
  return prefix;
}

TEST(SenderTable, HoldsAParticipantToThePortItWasFirstHeardFrom) {
  wire::SenderTable table;
  EXPECT_TRUE(table.admits(named(1), 40'000));
  EXPECT_TRUE(table.admits(named(2), 40'001));
  EXPECT_TRUE(table.admits(named(1), 40'000));
  EXPECT_FALSE(table.admits(named(1), 40'001));
  EXPECT_FALSE(table.admits(named(2), 50'000));
}

TEST(SenderTable, LetsAPortPassToANewProcess) {
  wire::SenderTable table;
  EXPECT_TRUE(table.admits(named(1), 40'000));
  EXPECT_TRUE(table.admits(named(3), 40'000));
  EXPECT_TRUE(table.admits(named(3), 40'000));
  EXPECT_TRUE(table.admits(named(1), 40'002));  // forgotten with its port
}

TEST(SenderTable, IsNotFilledByOneSenderOfManyNames) {
  wire::SenderTable table;
  for (int id = 0; id < 200; ++id) EXPECT_TRUE(table.admits(named(std::uint8_t(id)), 40'000));
  EXPECT_EQ(table.size(), 1U);
}

}  // namespace
}  // namespace goshawk::runtime
