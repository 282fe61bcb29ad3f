#include "../src/one_writer.hpp"

#include <gtest/gtest.h>

#include <set>

namespace goshawk::runtime {
namespace {

Participant named(int number) {
  Participant p{};
  p[11] = std::byte(number);
  return p;
}

constexpr std::int64_t kSecond_ns = 1'000'000'000;

class OneWriterTest : public testing::Test {
 protected:
  const Participant own_ = named(1), stage_ = named(2), stranger_ = named(3), again_ = named(4);
  OneWriter one_{own_};
  std::set<Participant> dead_;
  std::int64_t now_ns_ = 5 * kSecond_ns;

  bool admits(const Participant& writer) {
    return one_.admits(writer, now_ns_, [&](const auto& w) { return !dead_.contains(w); });
  }
};

TEST_F(OneWriterTest, IsTheOneThatWasFoundFirst) {
  one_.found(stage_);
  one_.found(stranger_);
  EXPECT_TRUE(admits(stage_));
  EXPECT_FALSE(admits(stranger_));
  EXPECT_TRUE(admits(stage_));
}

TEST_F(OneWriterTest, KeepsThePlaceOfAStageThatHasNotSpokenYet) {
  one_.found(stage_);
  one_.found(stranger_);
  EXPECT_FALSE(admits(stranger_));
  EXPECT_TRUE(admits(stage_));
}

TEST_F(OneWriterTest, PassesOverOneThatHasDiedBeforeItSpoke) {
  one_.found(stage_);
  one_.found(again_);
  dead_.insert(stage_);
  EXPECT_TRUE(admits(again_));
}

TEST_F(OneWriterTest, IsThisProcessIfItWritesItself) {
  one_.found(stranger_);
  one_.found(own_);
  EXPECT_FALSE(admits(stranger_));
  EXPECT_TRUE(admits(own_));
}

TEST_F(OneWriterTest, IsTheFirstToSpeakIfNoneWasFound) {
  EXPECT_TRUE(admits(stranger_));
  EXPECT_FALSE(admits(stage_));
}

TEST_F(OneWriterTest, AcceptsARestartedStageAtOnce) {
  one_.found(stage_);
  EXPECT_TRUE(admits(stage_));
  dead_.insert(stage_);
  one_.found(again_);
  EXPECT_TRUE(admits(again_));
  dead_.erase(stage_);  // it was only believed dead: it has lost its place
  EXPECT_FALSE(admits(stage_));
}

TEST_F(OneWriterTest, DoesNotPassToAStrangerThatWasRefusedBeforeTheStageIsBack) {
  one_.found(stage_);
  EXPECT_FALSE(admits(stranger_));
  dead_.insert(stage_);
  EXPECT_FALSE(admits(stranger_));
  now_ns_ += OneWriter::kGrace_ns - 1;
  EXPECT_FALSE(admits(stranger_));
  EXPECT_TRUE(admits(again_));
  EXPECT_FALSE(admits(stranger_));
}

TEST_F(OneWriterTest, PassesToOneThatWasRefusedIfNobodyElseCame) {
  one_.found(stage_);
  EXPECT_FALSE(admits(again_));
  dead_.insert(stage_);
  EXPECT_FALSE(admits(again_));
  now_ns_ += OneWriter::kGrace_ns;
  EXPECT_TRUE(admits(again_));
}

TEST_F(OneWriterTest, CountsTheGraceFromEachDeath) {
  one_.found(stage_);
  EXPECT_FALSE(admits(stranger_));
  dead_.insert(stage_);
  EXPECT_FALSE(admits(stranger_));
  dead_.erase(stage_);
  now_ns_ += 2 * OneWriter::kGrace_ns;
  EXPECT_TRUE(admits(stage_));
  EXPECT_FALSE(admits(stranger_));
  dead_.insert(stage_);
  EXPECT_FALSE(admits(stranger_));
}

TEST_F(OneWriterTest, IsAStageRatherThanWhoDoesNotClaimToBeOne) {
  OneWriter one(own_, [&](const Participant& p) { return p == stage_ || p == again_ ? 1 : 0; });
  const auto heard = [&](const Participant& p) {
    return one.admits(p, now_ns_, [&](const auto& w) { return !dead_.contains(w); });
  };
  one.found(stranger_);
  EXPECT_TRUE(heard(stranger_));
  one.found(stage_);
  EXPECT_TRUE(heard(stage_)) << "a stage that is found later replaces it";
  EXPECT_FALSE(heard(stranger_));
  EXPECT_FALSE(heard(again_)) << "one of the same rank does not";
}

TEST_F(OneWriterTest, ForgetsAParticipantWithItsLastWriter) {
  one_.found(stage_);
  one_.found(stage_);
  one_.lost(stage_);
  EXPECT_TRUE(one_.is_matched(stage_));
  one_.lost(stage_);
  EXPECT_FALSE(one_.is_matched(stage_));
  one_.lost(stage_);
  EXPECT_FALSE(one_.is_matched(stage_));
}

}  // namespace
}  // namespace goshawk::runtime
