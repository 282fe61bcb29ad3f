#include "goshawk/runtime/writers.hpp"

#include <gmock/gmock.h>
#include <unistd.h>

#include <atomic>
#include <thread>

#include "domain.hpp"
#include "std_msgs.h"

namespace goshawk::runtime {
namespace {

using runtime_test::join;
using runtime_test::spin_until;
using std_msgs::msg::String;
using testing::Contains;
using testing::Each;
using testing::ElementsAre;
using testing::HasSubstr;

String text(const std::string& data) {
  String message;
  message.data(data);
  return message;
}

/// A process of its own, as the reader sees it.
struct Speaker {
  explicit Speaker(const std::string& name, Qos qos = Qos::reliable_last(),
                   const std::string& topic = "t")
      : context(join({"/" + name})),
        node(std::make_unique<Node>(*context, name)),
        publisher(node->advertise<String>(topic, qos)) {}
  void say(const std::string& data) const { EXPECT_TRUE(publisher->publish(text(data))); }
  void leave() {
    publisher.reset();
    node.reset();
    context.reset();
  }

  std::unique_ptr<Context> context;
  std::unique_ptr<Node> node;
  std::optional<Publisher<String>> publisher;
};

class HeardFromOne : public testing::Test {
 protected:
  void listen(Qos qos = Qos::reliable_last(), Writers writers = Writers::one("t"),
              const std::string& topic = "t") {
    reader_.subscribe<String>(
        topic, qos,
        [this](const String& m, const auto&) {
          if (m.data() == "hello") {
            greeted_ = true;
          } else {
            heard_.push_back(m.data());
          }
        },
        std::move(writers));
    reader_.on_second_writer([this](const Error& e) { refused_.push_back(e); });
  }
  bool meets(const Speaker& speaker) {
    return spin_until(reader_, [&] { return speaker.publisher->matched() > 0; });
  }
  /// Reader and writer match apart from each other: only who was heard is certainly chosen.
  bool is_greeted_by(const Speaker& speaker) {
    return spin_until(reader_, [&] { return speaker.say("hello"), greeted_; });
  }
  bool hears(const std::string& data) {
    return spin_until(reader_, [&] { return std::ranges::count(heard_, data) > 0; });
  }
  bool refuses() {
    const auto before = refused_.size();
    return spin_until(reader_, [&] { return refused_.size() > before; });
  }

  std::unique_ptr<Context> context_ = join({"/reader"});
  Node reader_{*context_, "reader"};
  std::vector<std::string> heard_;
  bool greeted_ = false;
  std::vector<Error> refused_;
};

TEST_F(HeardFromOne, ASecondWriterIsIgnoredAndNamed) {
  listen();
  const Speaker stage("stage");
  ASSERT_TRUE(is_greeted_by(stage));
  const Speaker stranger("stranger");
  ASSERT_TRUE(meets(stranger));
  stranger.say("lie");
  ASSERT_TRUE(refuses());
  stage.say("truth");
  ASSERT_TRUE(hears("truth"));
  EXPECT_THAT(heard_, ElementsAre("truth"));
  EXPECT_EQ(refused_[0].code, ErrorCode::second_writer);
  EXPECT_THAT(refused_[0].message, HasSubstr("/t is written by /stage"));
  EXPECT_THAT(refused_[0].message, HasSubstr("/stranger (process " + std::to_string(getpid())));
}

TEST_F(HeardFromOne, AWriterThatComesAfterTheFirstHasLeftIsHeardAtOnce) {
  listen();
  Speaker stage("stage");
  ASSERT_TRUE(meets(stage));
  stage.say("before");
  ASSERT_TRUE(hears("before"));
  const Speaker stranger("stranger");
  ASSERT_TRUE(meets(stranger));
  stranger.say("lie");
  ASSERT_TRUE(refuses());
  stage.leave();
  const Speaker again("stage");
  ASSERT_TRUE(meets(again));
  again.say("after");
  ASSERT_TRUE(hears("after"));
  stranger.say("lie");
  again.say("on");
  ASSERT_TRUE(hears("on"));
  EXPECT_THAT(heard_, ElementsAre("before", "after", "on"));
}

TEST_F(HeardFromOne, WhatALatchedWriterSaidTooEarlyIsHeardWhenItsTurnComes) {
  listen(Qos::latched());
  Speaker old("old", Qos::latched());
  ASSERT_TRUE(is_greeted_by(old));
  const Speaker successor("successor", Qos::latched());
  ASSERT_TRUE(meets(successor));
  successor.say("outdated");
  successor.say("new");
  ASSERT_TRUE(refuses());
  const Speaker stranger("stranger", Qos::latched());
  ASSERT_TRUE(meets(stranger));
  stranger.say("lie");
  ASSERT_TRUE(refuses());
  old.leave();
  ASSERT_TRUE(hears("new"));
  EXPECT_THAT(heard_, ElementsAre("new"));
}

TEST_F(HeardFromOne, AFloodOfAStrangersMessagesHidesNothing) {
  listen(Qos::best_effort());
  const Speaker stage("stage", Qos::best_effort());
  ASSERT_TRUE(is_greeted_by(stage));
  const Speaker stranger("stranger", Qos::best_effort());
  ASSERT_TRUE(meets(stranger));
  std::atomic<bool> done = false;
  std::thread flooding([&] {
    while (!done) {
      stranger.say("lie");
      std::this_thread::sleep_for(std::chrono::microseconds(200));
    }
  });
  EXPECT_TRUE(refuses());
  EXPECT_TRUE(spin_until(reader_, [&] {
    stage.say("truth");
    return heard_.size() > 100;
  }));
  done = true;
  flooding.join();
  EXPECT_THAT(heard_, Each("truth"));
  EXPECT_LT(refused_.size(), 30u) << "a flood must not fill the log";
}

TEST_F(HeardFromOne, OnlyTheNewestMessageOfADepthOfOneIsDelivered) {
  listen(Qos::reliable_last(1));
  const Speaker stage("stage", Qos::reliable_last(100));
  ASSERT_TRUE(meets(stage));
  for (int i = 0; i < 20; ++i) stage.say(std::to_string(i));
  // All are there before the reader's node runs.
  ASSERT_TRUE(stage.publisher->wait_acknowledged(60.0));
  ASSERT_TRUE(hears("19"));
  EXPECT_THAT(heard_, ElementsAre("19"));
}

TEST_F(HeardFromOne, OneWriterSpeaksForAllTopicsOfAGroup) {
  listen(Qos::reliable_last(), Writers::one("map"), "map");
  listen(Qos::reliable_last(), Writers::one("map"), "updates");
  const Speaker stage("stage", Qos::reliable_last(), "map");
  ASSERT_TRUE(is_greeted_by(stage));
  const Speaker stranger("stranger", Qos::reliable_last(), "updates");
  ASSERT_TRUE(meets(stranger));
  stranger.say("lie");
  ASSERT_TRUE(refuses());
  EXPECT_TRUE(heard_.empty());
}

TEST_F(HeardFromOne, AGroupIsSplitByWhatMessagesSayOfThemselves) {
  const auto part = [](const String& m) {
    return m.data().starts_with("search") ? std::uint8_t{1}
           : m.data().starts_with("map")  ? std::uint8_t{2}
                                          : std::uint8_t{0};
  };
  listen(Qos::reliable_last(), Writers::one_each<String>("reports", part));
  const Speaker search("search"), map("map");
  ASSERT_TRUE(meets(search) && meets(map));
  search.say("search: found");
  map.say("map: ready");
  ASSERT_TRUE(hears("search: found") && hears("map: ready"));
  map.say("search: failed");
  ASSERT_TRUE(refuses());
  map.say("anything");
  search.say("anything else");
  ASSERT_TRUE(hears("anything") && hears("anything else"));
  EXPECT_EQ(heard_.size(), 4u);
}

TEST_F(HeardFromOne, AWriterOfTheSameProcessComesFirst) {
  listen();
  const Speaker stranger("stranger");
  ASSERT_TRUE(meets(stranger));
  const auto own = reader_.advertise<String>("t", Qos::reliable_last());
  ASSERT_TRUE(spin_until(reader_, [&] { return own.matched() > 0; }));
  stranger.say("lie");
  ASSERT_TRUE(refuses());
  ASSERT_TRUE(own.publish(text("truth")));
  ASSERT_TRUE(hears("truth"));
  EXPECT_THAT(heard_, ElementsAre("truth"));
}

TEST_F(HeardFromOne, WithoutTheRuleEverybodyIsHeard) {
  listen(Qos::reliable_last(), Writers::any());
  const Speaker a("a"), b("b");
  ASSERT_TRUE(meets(a) && meets(b));
  a.say("one");
  b.say("two");
  ASSERT_TRUE(hears("one") && hears("two"));
  EXPECT_TRUE(refused_.empty());
}

}  // namespace
}  // namespace goshawk::runtime
