#include "goshawk/viewer_bridge/server.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <thread>

#include "raw_client.hpp"

namespace goshawk::viewer_bridge {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

bool comes_true(const std::function<bool()>& condition, double timeout_s = 60.0) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(timeout_s);
  while (!condition()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return true;
}

class BridgeServer : public ::testing::Test {
 protected:
  void start(ServerOptions options = {}) {
    options.port = 0;
    auto server = Server::start(options);
    ASSERT_TRUE(server) << server.error().message;
    server_ = *std::move(server);
    server_->advertise({3, "/odom", "nav_msgs/msg/Odometry", "float64 x\n"});
  }

  std::vector<ClientEvent> events_of(std::size_t count) {
    std::vector<ClientEvent> events;
    comes_true([&] {
      for (auto& e : server_->take_events()) events.push_back(std::move(e));
      return events.size() >= count;
    });
    return events;
  }

  std::unique_ptr<Server> server_;
};

const std::string kSubscribe = R"({"op":"subscribe","subscriptions":[{"id":5,"channelId":3}]})";

TEST_F(BridgeServer, TellsItsChannelsAndSendsToWhoSubscribed) {
  start();
  RawClient client(server_->port());
  const std::string head = client.shake_hands();
  EXPECT_THAT(head, StartsWith("HTTP/1.1 101"));
  EXPECT_THAT(head, HasSubstr("foxglove.websocket.v1"));
  EXPECT_THAT(client.wait_for(1), HasSubstr(R"("op":"serverInfo")"));
  const std::string channels = client.wait_for(1);
  for (const char* part :
       {R"("op":"advertise")", R"("id":3)", R"("topic":"/odom")", R"("encoding":"cdr")",
        R"("schemaEncoding":"ros2msg")", R"("schemaName":"nav_msgs/msg/Odometry")"}) {
    EXPECT_THAT(channels, HasSubstr(part));
  }
  server_->advertise({4, "/path", "nav_msgs/msg/Path", ""});
  EXPECT_THAT(client.wait_for(1), HasSubstr(R"("topic":"/path")"));

  client.send_text(kSubscribe);
  const auto events = events_of(1);
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(events[0].channel, 3u);
  const std::vector<unsigned char> cdr{9, 8, 7};
  server_->send(4, 1, cdr);
  server_->send(3, 0x0102030405060708, cdr);
  EXPECT_EQ(client.wait_for(2),
            std::string("\x01\x05\0\0\0\x08\x07\x06\x05\x04\x03\x02\x01\x09\x08\x07", 16));
  server_->send_to(events[0].client, 3, 0, cdr);
  EXPECT_EQ(client.wait_for(2).size(), 16u);
  server_->tell(events[0].client, StatusLevel::error, "a sentence");
  EXPECT_THAT(client.wait_for(1), HasSubstr("a sentence"));
}

TEST_F(BridgeServer, ClosesWhoSendsGarbageAndServesTheOthers) {
  start();
  RawClient good(server_->port());
  good.shake_hands();
  good.send_text(kSubscribe);
  ASSERT_EQ(events_of(1).size(), 1u);
  for (const auto& [opcode, garbage] :
       {std::pair{1, std::string("garbage")}, std::pair{2, std::string("\xff\xff")},
        std::pair{2, std::string()}}) {
    RawClient bad(server_->port());
    bad.shake_hands();
    bad.send_frame(opcode, garbage);
    EXPECT_THAT(bad.wait_for(8), HasSubstr("foxglove.websocket.v1"));
  }
  RawClient broken(server_->port());
  broken.shake_hands();
  broken.write(std::string(3000, '\xff'));  // no frame at all
  RawClient large(server_->port());
  large.shake_hands();
  large.send_frame(1, std::string(3U << 20U, ' '));
  RawClient not_http(server_->port());
  not_http.write("hello\r\n\r\n");
  EXPECT_TRUE(comes_true([&] { return server_->clients() == 1; }));
  server_->send(3, 0, std::vector<unsigned char>{1});
  EXPECT_EQ(good.wait_for(2).size(), 14u);
}

TEST_F(BridgeServer, ClosesWhoFloods) {
  ServerOptions options;
  options.client_messages_per_s = 100;
  start(options);
  RawClient client(server_->port());
  client.shake_hands();
  for (int k = 0; k < 300; ++k) client.send_text(kSubscribe);
  EXPECT_THAT(client.wait_for(8), HasSubstr("more than 100 messages a second"));
  EXPECT_LE(server_->take_events().size(), 101u);
}

TEST_F(BridgeServer, DropsWhatASlowReaderDoesNotReadAndThenTheReader) {
  ServerOptions options;
  options.queue_bytes = 4U << 20U;
  options.full_queue_s = 0.3;
  start(options);
  RawClient slow(server_->port(), 4096);
  slow.shake_hands();
  slow.send_text(kSubscribe);
  RawClient quick(server_->port());
  quick.shake_hands();
  quick.send_text(kSubscribe);
  ASSERT_EQ(events_of(2).size(), 2u);
  const std::vector<unsigned char> megabyte(1U << 20U, 1);
  std::size_t got = 0;
  for (int k = 0; k < 200 && server_->clients() == 2; ++k) {
    server_->send(3, k, megabyte);
    if (quick.wait_for(2).size() == megabyte.size() + 13) ++got;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  EXPECT_GT(server_->dropped(), 0u);
  EXPECT_TRUE(comes_true([&] { return server_->clients() == 1; }));
  EXPECT_GT(got, 10u);
  bool told = false;
  for (const auto& line : server_->take_log())
    told = told || line.find("does not read") < line.size();
  EXPECT_TRUE(told);
}

TEST_F(BridgeServer, RefusesStrangersWithASentence) {
  ServerOptions options;
  options.clients = 1;
  start(options);
  RawClient other(server_->port());
  EXPECT_THAT(other.shake_hands(""), HasSubstr("speaks foxglove.websocket.v1"));
  RawClient page(server_->port());
  EXPECT_THAT(page.shake_hands("foxglove.websocket.v1", "https://example.org"),
              HasSubstr("https://example.org may not connect; -p origins:=https://example.org"));
  RawClient first(server_->port());
  EXPECT_THAT(first.shake_hands(), StartsWith("HTTP/1.1 101"));
  ASSERT_TRUE(comes_true([&] { return server_->clients() == 1; }));
  RawClient second(server_->port());
  EXPECT_THAT(second.shake_hands(), HasSubstr("the limit of 1 clients is reached"));
}

TEST_F(BridgeServer, SaysWhyItCannotListen) {
  start();
  ServerOptions options;
  options.port = server_->port();
  const auto busy = Server::start(options);
  ASSERT_FALSE(busy);
  EXPECT_EQ(busy.code(), ErrorCode::io_failed);
  EXPECT_THAT(busy.error().message, HasSubstr(fmt::format("port {}", server_->port())));
  options.port = 70000;
  EXPECT_EQ(Server::start(options).code(), ErrorCode::invalid_parameter);
  options.port = 0;
  options.origins = "localhost";
  EXPECT_EQ(Server::start(options).code(), ErrorCode::invalid_parameter);
  options.origins = "";
  options.address = "not an address";
  EXPECT_EQ(Server::start(options).code(), ErrorCode::invalid_parameter);
  options.address = "203.0.113.1";  // of no interface here
  EXPECT_EQ(Server::start(options).code(), ErrorCode::io_failed);
}

}  // namespace
}  // namespace goshawk::viewer_bridge
