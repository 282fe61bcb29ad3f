// The parser: what it refuses and how, what it hands on, what it completes.

#include "program.hpp"

#include <gmock/gmock.h>

#include "values.hpp"

namespace goshawk::cli {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// A program with a verb `fly`, a verb `topic` of two words, and a verb that takes --ros-args.
class ProgramTest : public testing::Test {
 protected:
  ProgramTest() {
    const Verb fly = program_.verb("fly", "fly somewhere");
    add_points(fly, "--goal", goals_, "[m]");
    fly->add_option("--speed", speed_, "[m/s]")->check(CLI::Range(0.1, 20.0));
    fly.choice("--weather", weather_, "what blows", {"calm", "wind"});
    fly.runs([this](const Console&) { return ran("fly"); });

    const Verb topic = program_.verb("topic", "topics");
    const Verb echo = topic.word("echo", "print");
    echo.completes(echo->add_option("topic", topic_, "its name")->required(), [](const Words&) {
      return Words{"/path", "/odom"};
    });
    echo.runs([this](const Console&) { return ran("topic echo"); });
    topic.word("list", "all").runs([this](const Console&) { return ran("topic list"); });

    const Verb start = program_.verb("start", "start one");
    start->add_option("what", topic_, "a component");
    start.takes_ros_args(ros_args_);
    start.runs([this](const Console&) { return ran("start"); });
  }

  int ran(const std::string& verb) {
    ran_ = verb;
    return kDone;
  }

  struct Refusal {
    int status;
    std::string out, err;
  };
  Refusal call(const Words& words) {
    testing::internal::CaptureStdout();
    testing::internal::CaptureStderr();
    const int status = program_.run(words);
    const auto out = testing::internal::GetCapturedStdout();
    return {status, out, testing::internal::GetCapturedStderr()};
  }

  Program program_;
  std::vector<Vec3> goals_;
  double speed_ = 1.0;
  std::string weather_ = "calm", topic_, ran_;
  Words ros_args_;
};

TEST_F(ProgramTest, HandsOnWhatWasGiven) {
  EXPECT_EQ(call({"fly", "--goal", "1,2,3", "--goal=-4,5,6e0", "--speed", "2"}).status, kDone);
  EXPECT_EQ(ran_, "fly");
  EXPECT_THAT(goals_, ElementsAre(Vec3(1, 2, 3), Vec3(-4, 5, 6)));
  EXPECT_EQ(speed_, 2.0);
  EXPECT_EQ(call({"topic", "echo", "list"}).status, kDone);  // a name, not a verb
  EXPECT_EQ(topic_, "list");
}

TEST_F(ProgramTest, NamesTheNearestVerbAndOption) {
  for (const auto& [words, sentence] :
       {std::pair<Words, const char*>{{"fyl"}, "did you mean fly?"},
        {{"topic", "ecko"}, "did you mean echo?"},
        {{"fly", "--gaol", "1,2,3"}, "no option --gaol; did you mean --goal?"},
        {{"fly", "--gaol=1,2,3"}, "no option --gaol; did you mean --goal?"},
        {{"topic"}, "a verb is missing: goshawk topic echo | list"},
        {{"topic", "--gaol"}, "--gaol"},
        {{"topic", "echo"}, "topic is required"},
        {{"topic", "echo", "a", "b"}, "'b' is one word too many"},
        {{"fly", "--speed", "fast"}, "--speed: 'fast' is not a number"},
        {{"fly", "--speed", "99"}, "--speed: 99 is not from 0.1 to 20"},
        {{"fly", "--speed"}, "--speed"},
        {{"fly", "--weather", "wnid"}, "not one of calm, wind; did you mean wind?"},
        {{"fly", "--goal", "1,2"}, "'1,2' is not a point"}}) {
    const auto refusal = call(words);
    EXPECT_EQ(refusal.status, kWrongCall);
    EXPECT_THAT(refusal.err, HasSubstr(sentence));
    EXPECT_THAT(refusal.out, IsEmpty());
  }
  EXPECT_EQ(ran_, "");
}

TEST_F(ProgramTest, RefusesAsJsonWhereThatIsAskedFor) {
  const auto of = [&](const Words& words) { return Json::parse(call(words).out); };
  const Json option = of({"fly", "--gaol", "1", "--json"});
  EXPECT_EQ(option["ok"], false);
  EXPECT_EQ(option["code"], "invalid_input");
  EXPECT_THAT(option["message"].get<std::string>(), HasSubstr("--goal"));
  EXPECT_EQ(of({"fly", "--json", "--goal", "here"})["code"], "invalid_parameter");
  EXPECT_EQ(of({"topic", "--json"})["ok"], false);
}

TEST_F(ProgramTest, LeavesRosArgsAlone) {
  EXPECT_EQ(call({"start", "tracker", "--ros-args", "-p", "--gaol:=1", "--json"}).status, kDone);
  EXPECT_THAT(ros_args_, ElementsAre("-p", "--gaol:=1", "--json"));
  EXPECT_EQ(call({"fly", "--ros-args", "-p", "a:=1"}).status, kWrongCall);
}

TEST_F(ProgramTest, Helps) {
  const auto help = call({"fly", "--help"});
  EXPECT_EQ(help.status, kDone);
  EXPECT_THAT(help.out, AllOf(HasSubstr("goshawk fly"), HasSubstr("--goal"), HasSubstr("--json")));
  EXPECT_THAT(call({"--help"}).out, AllOf(HasSubstr("fly somewhere"), HasSubstr("topics")));
  EXPECT_EQ(program_.help({"fyl"}), kWrongCall);
  const auto nothing = call({});
  EXPECT_EQ(nothing.status, kWrongCall);
  EXPECT_THAT(nothing.err, HasSubstr("fly somewhere"));
}

TEST_F(ProgramTest, ABugIsAnInternalFaultAndNotDone) {
  program_.verb("fail", "").runs([](const Console&) -> int { throw std::logic_error("oops"); });
  const auto outcome = call({"fail"});
  EXPECT_EQ(outcome.status, kNotDone);
  EXPECT_THAT(outcome.err, HasSubstr("internal fault: oops"));
}

TEST_F(ProgramTest, CompletesVerbsOptionsAndValues) {
  EXPECT_THAT(program_.complete({""}), ElementsAre("fly", "topic", "start"));
  EXPECT_THAT(program_.complete({"topic", ""}), ElementsAre("echo", "list"));
  EXPECT_THAT(program_.complete({"fly", "-"}),
              AllOf(Contains("--goal"), Contains("--json"), Contains("--help")));
  EXPECT_THAT(program_.complete({"fly", "--weather", ""}), ElementsAre("calm", "wind"));
  EXPECT_THAT(program_.complete({"fly", "--weather", "calm", ""}), IsEmpty());
  EXPECT_THAT(program_.complete({"fly", "--goal", ""}), IsEmpty());
  EXPECT_THAT(program_.complete({"topic", "echo", ""}), ElementsAre("/path", "/odom"));
  EXPECT_THAT(program_.complete({"fly", "--weather", "=", "ca"}), ElementsAre("calm", "wind"));
  EXPECT_THAT(program_.complete({"fly", "--weather", "="}), ElementsAre("calm", "wind"));
  EXPECT_THAT(program_.complete({"topic", "echo", "--json", ""}), ElementsAre("/path", "/odom"));
}

}  // namespace
}  // namespace goshawk::cli
