// goshawk_container as a process, with the probe component.

#include <fcntl.h>
#include <gmock/gmock.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "domain.hpp"
#include "goshawk/runtime/component.hpp"
#include "std_msgs.h"
#include "stranger.hpp"
#include "wire/datagram.hpp"

namespace goshawk::runtime {
namespace {

using runtime_test::join;
using runtime_test::spin_until;
using std_msgs::msg::String;
using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using Steady = std::chrono::steady_clock;
using Words = std::vector<std::string>;

/// The container as a child; killed at the end of the test if it still runs.
class Container {
 public:
  explicit Container(Words arguments,
                     const std::string& domain = std::to_string(runtime_test::domain())) {
    setenv("GOSHAWK_COMPONENT_PATH", COMPONENT_FOLDER, 1);
    setenv("ROS_DOMAIN_ID", domain.c_str(), 1);
    arguments.insert(arguments.begin(), CONTAINER);
    std::vector<char*> argv;
    for (auto& argument : arguments) argv.push_back(argument.data());
    argv.push_back(nullptr);
    static int number = 0;
    log_ = std::filesystem::temp_directory_path() /
           ("goshawk_container_" + std::to_string(getpid()) + "_" + std::to_string(number++));
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, 2, log_.c_str(), O_CREAT | O_TRUNC | O_WRONLY, 0600);
    EXPECT_EQ(posix_spawn(&pid_, CONTAINER, &actions, nullptr, argv.data(), environ), 0);
    posix_spawn_file_actions_destroy(&actions);
  }
  ~Container() {
    if (!ended_) send(SIGKILL);
    (void)wait(5.0);
    std::filesystem::remove(log_);
  }

  void send(int signal) { kill(pid_, signal); }
  std::string pid() const { return std::to_string(pid_); }
  /// @return exit status, -signal, or -1000 where it still runs after `most_s`
  int wait(double most_s) {
    const auto end = Steady::now() + std::chrono::duration<double>(most_s);
    while (!ended_) {
      if (waitpid(pid_, &status_, WNOHANG) == pid_) {
        ended_ = true;
      } else if (Steady::now() > end) {
        return -1000;
      } else {
        usleep(5000);
      }
    }
    return WIFEXITED(status_) ? WEXITSTATUS(status_) : -WTERMSIG(status_);
  }
  std::string log() const {
    std::ostringstream text;
    text << std::ifstream(log_).rdbuf();
    return text.str();
  }

 private:
  pid_t pid_ = 0;
  bool ended_ = false;
  int status_ = 0;
  std::filesystem::path log_;
};

void expect_fault(const Words& arguments, const testing::Matcher<const std::string&>& sentence) {
  Container container(arguments);
  EXPECT_EQ(container.wait(60.0), 2);
  EXPECT_THAT(container.log(), sentence);
}

TEST(ContainerCall, NamesWhatIsWrong) {
  expect_fault({}, HasSubstr("no component named; usage"));
  expect_fault({"prob"}, AllOf(HasSubstr("there is no component 'prob'; did you mean probe?"),
                               HasSubstr("Installed: ")));
  expect_fault({"prob", "robe"}, AllOf(HasSubstr("'prob'"), HasSubstr("'robe'")));
  expect_fault({"--help-me"}, HasSubstr("options follow --ros-args"));
  expect_fault({"hollow"}, HasSubstr("lacks GOSHAWK_REGISTER_COMPONENT"));
  expect_fault({"../probe"}, HasSubstr("'../probe' is not a valid name"));
  expect_fault({"probe", "--ros-args", "-x", "1"}, HasSubstr("has no option '-x'"));
  expect_fault({"probe", "probe:b", "--ros-args", "-r", "__node:=c"},
               HasSubstr("several components"));
  expect_fault({"probe", "probe"}, HasSubstr("two nodes would be named probe"));
  expect_fault({"probe:a b"}, HasSubstr("'a b' is not a valid name"));
}

TEST(ContainerCall, ListsAllParameterFaultsOfAllComponents) {
  expect_fault({"probe:one", "probe:two", "--ros-args", "-p", "one:count:=many", "-p",
                "one:radius:=1", "-p", "two:speed_m_s:=0"},
               AllOf(HasSubstr("one has 2 parameter faults"), HasSubstr("count: 'many'"),
                     HasSubstr("did you mean radius_m?"), HasSubstr("two has 1 parameter fault"),
                     HasSubstr("speed_m_s: '0' is out of range")));
}

TEST(ContainerCall, RefusesAGarbledDomain) {
  Container container({"probe"}, "seven");
  EXPECT_EQ(container.wait(60.0), 2);
  EXPECT_THAT(container.log(), HasSubstr("ROS_DOMAIN_ID is 'seven'"));
}

TEST(LoadComponent, KnowsWhatIsInstalled) {
  setenv("GOSHAWK_COMPONENT_PATH", COMPONENT_FOLDER, 1);
  EXPECT_THAT(installed_components(), Contains("probe"));
  const auto component = load_component("probe");
  ASSERT_TRUE(component) << component.error().message;
  EXPECT_EQ((*component)->describe().size(), 6u);
  EXPECT_EQ(load_component("prob").code(), ErrorCode::invalid_parameter);
  EXPECT_EQ(load_component("hollow").code(), ErrorCode::io_failed);
  EXPECT_FALSE(load_component(""));
}

class Containers : public testing::Test {
 protected:
  void SetUp() override {
    node_.subscribe<String>("/probe", Qos::latched(100),
                            [this](const String& m, const auto&) { hellos_.push_back(m.data()); });
  }
  bool hears(std::size_t count) {
    return spin_until(node_, [&] { return hellos_.size() >= count; });
  }

  std::unique_ptr<Context> context_ = join();
  Node node_{*context_, "test"};
  Words hellos_;
};

TEST_F(Containers, RunTheirComponentsAndEndOnSignals) {
  for (const int signal : {SIGTERM, SIGINT}) {
    hellos_.clear();
    Container container({"probe", "probe:second", "--ros-args", "-p", "label:=x", "-r",
                         "/uav1/probe:=/probe", "-r", "__ns:=/uav1"});
    ASSERT_TRUE(hears(2)) << container.log();
    EXPECT_THAT(hellos_, testing::UnorderedElementsAre("/uav1/probe x", "/uav1/second x"));
    Words nodes;
    for (const auto& p : context_->participants()) {
      nodes.insert(nodes.end(), p.nodes.begin(), p.nodes.end());
    }
    EXPECT_THAT(nodes, Contains("/uav1/second"));
    container.send(signal);
    EXPECT_EQ(container.wait(60.0), 0) << container.log();
  }
}

TEST_F(Containers, EndOnASignalThatComesEarly) {
  Container container({"probe"});
  container.send(SIGTERM);
  const int status = container.wait(60.0);
  // Before main() blocks the signal, the default action ends the process just as well.
  EXPECT_TRUE(status == 0 || status == -SIGTERM) << status;
}

TEST_F(Containers, GetLatchedTopicsAgainAfterAKill) {
  const auto poke = node_.advertise<String>("/poke", Qos::latched());
  String message;
  message.data("still here");
  ASSERT_TRUE(poke.publish(message));
  int poked = 0;
  node_.subscribe<String>("/poked", Qos::reliable_last(),
                          [&](const String&, const auto&) { ++poked; });
  for (int life = 1; life <= 2; ++life) {
    Container container({"probe"});
    EXPECT_TRUE(hears(std::size_t(life))) << "its latched hello in life " << life;
    // The latched poke reaches each life; the answer to it is volatile and may be early.
    EXPECT_TRUE(spin_until(node_, [&] {
      if (poked < life) (void)poke.publish(message);
      return poked >= life;
    }));
    container.send(SIGKILL);
    EXPECT_EQ(container.wait(60.0), -SIGKILL);
    poked = life;
  }
}

TEST_F(Containers, DieOfABugSoThatSupervisionSeesIt) {
  Container container({"probe", "--ros-args", "-p", "label:=throw"});
  EXPECT_EQ(container.wait(60.0), -SIGABRT);
}

// Profiles name the transports, but the filter is in front of each.
TEST_F(Containers, RefuseMalformedDatagramsWithAProfileOfTransportsToo) {
  const auto profile = std::filesystem::temp_directory_path() /
                       ("goshawk_profile_" + std::to_string(getpid()) + ".xml");
  std::ofstream(profile) << R"(<?xml version="1.0" encoding="UTF-8"?>
<profiles xmlns="http://www.eprosima.com/XMLSchemas/fastRTPS_Profiles">
  <transport_descriptors>
    <transport_descriptor>
      <transport_id>udp</transport_id><type>UDPv4</type>
      <interfaceWhiteList><address>127.0.0.1</address></interfaceWhiteList>
      <maxInitialPeersRange>60</maxInitialPeersRange>
    </transport_descriptor>
    <transport_descriptor><transport_id>memory</transport_id><type>SHM</type></transport_descriptor>
  </transport_descriptors>
  <participant profile_name="loopback" is_default_profile="true"><rtps>
    <userTransports>
      <transport_id>udp</transport_id><transport_id>memory</transport_id>
    </userTransports>
    <useBuiltinTransports>false</useBuiltinTransports>
    <builtin>
      <metatrafficUnicastLocatorList>
        <locator><udpv4><address>127.0.0.1</address></udpv4></locator>
      </metatrafficUnicastLocatorList>
      <initialPeersList>
        <locator><udpv4><address>127.0.0.1</address></udpv4></locator>
      </initialPeersList>
    </builtin>
  </rtps></participant>
</profiles>
)";
  setenv("FASTRTPS_DEFAULT_PROFILES_FILE", profile.c_str(), 1);
  Container container({"probe"});
  unsetenv("FASTRTPS_DEFAULT_PROFILES_FILE");
  ASSERT_TRUE(hears(1)) << container.log();
  const auto killer =
      runtime_test::Datagram().add(0x80, runtime_test::Body().zeros(57), 0, 56).bytes();
  runtime_test::Stranger().send_to_all(killer, container.pid());
  EXPECT_TRUE(spin_until(node_, [&] {
    return container.log().find("a datagram was refused") != std::string::npos;
  })) << container.log();
  container.send(SIGTERM);
  EXPECT_EQ(container.wait(60.0), 0) << container.log();
  std::filesystem::remove(profile);
}

}  // namespace
}  // namespace goshawk::runtime
