#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <thread>
#include <utility>
#include <vector>

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
}

TEST(SenderTable, KnowsThatAParticipantHasEndedWhenAnotherHasItsPort) {
  wire::SenderTable table;
  EXPECT_TRUE(table.admits(named(1), 7));
  EXPECT_FALSE(table.has_ended(named(1)));
  EXPECT_FALSE(table.has_ended(named(2))) << "was never heard";
  EXPECT_TRUE(table.admits(named(2), 7));
  EXPECT_EQ(table.port_of(named(1)), std::nullopt);
  EXPECT_TRUE(table.has_ended(named(1)));
  EXPECT_FALSE(table.has_ended(named(2)));
  EXPECT_TRUE(table.admits(named(1), 8));
  EXPECT_FALSE(table.has_ended(named(1)));
}

/// A socket with a port of 127.0.0.1 that the kernel chose.
std::pair<int, std::uint16_t> open_port() {
  const int socket = ::socket(AF_INET, SOCK_DGRAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  EXPECT_EQ(bind(socket, reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
  socklen_t size = sizeof address;
  EXPECT_EQ(getsockname(socket, reinterpret_cast<sockaddr*>(&address), &size), 0);
  return {socket, ntohs(address.sin_port)};
}

TEST(Ports, AreTakenAsLongAsTheirSocketIsOpen) {
  const auto [socket, port] = open_port();
  EXPECT_TRUE(wire::is_taken(port));
  EXPECT_TRUE(wire::is_taken(port)) << "looking must not take it";
  close(socket);
  EXPECT_FALSE(wire::is_taken(port));
}

// All readers of a stage look at its port at the same moment, when its successor first speaks.
TEST(Ports, AreNotTakenByThoseWhoLook) {
  const auto [socket, port] = open_port();
  close(socket);
  std::atomic<int> taken = 0;
  std::vector<std::jthread> looking;
  for (int i = 0; i < 4; ++i) {
    looking.emplace_back([&taken, port = port] {
      for (int k = 0; k < 20'000; ++k) taken += wire::is_taken(port);
    });
  }
  looking.clear();
  EXPECT_EQ(taken, 0);
}

}  // namespace
}  // namespace goshawk::runtime
