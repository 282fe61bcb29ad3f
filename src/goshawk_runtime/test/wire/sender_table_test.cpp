#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

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

TEST(SenderTable, KnowsThePortThatAParticipantWasHeardFrom) {
  wire::SenderTable table;
  EXPECT_EQ(table.port_of(named(1)), std::nullopt);
  EXPECT_TRUE(table.admits(named(1), 7));
  EXPECT_EQ(table.port_of(named(1)), 7);
  // Another one has the port: the first has ended.
  EXPECT_TRUE(table.admits(named(2), 7));
  EXPECT_EQ(table.port_of(named(1)), std::nullopt);
}

TEST(Ports, AreTakenAsLongAsTheirSocketIsOpen) {
  const int socket = ::socket(AF_INET, SOCK_DGRAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  ASSERT_EQ(bind(socket, reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
  socklen_t size = sizeof address;
  ASSERT_EQ(getsockname(socket, reinterpret_cast<sockaddr*>(&address), &size), 0);
  const std::uint16_t port = ntohs(address.sin_port);
  EXPECT_TRUE(wire::is_taken(port));
  EXPECT_TRUE(wire::is_taken(port)) << "looking must not take it";
  close(socket);
  EXPECT_FALSE(wire::is_taken(port));
}

}  // namespace
}  // namespace goshawk::runtime
