#include <gmock/gmock.h>

#include <cstdlib>

#include "goshawk/runtime/context.hpp"

namespace goshawk::runtime {
namespace {

using testing::HasSubstr;

/// Sets a variable of the environment for one test.
class Variable {
 public:
  Variable(const char* name, const char* value) : name_(name) {
    const char* before = std::getenv(name);
    was_set_ = before != nullptr;
    if (was_set_) before_ = before;
    setenv(name, value, 1);
  }
  ~Variable() { was_set_ ? setenv(name_, before_.c_str(), 1) : unsetenv(name_); }

 private:
  const char* name_;
  bool was_set_ = false;
  std::string before_;
};

TEST(ContextOptions, TakeDomainAndInterfacesFromTheEnvironment) {
  const Variable domain("ROS_DOMAIN_ID", "42");
  const Variable interfaces("GOSHAWK_INTERFACES", "all");
  const auto options = ContextOptions::from_environment();
  ASSERT_TRUE(options) << options.error().message;
  EXPECT_EQ(options->domain, 42);
  EXPECT_EQ(options->interfaces, "all");
}

TEST(ContextOptions, RefuseInterfacesThatAreSetButEmpty) {
  const Variable interfaces("GOSHAWK_INTERFACES", "");
  const auto options = ContextOptions::from_environment();
  ASSERT_EQ(options.code(), ErrorCode::invalid_parameter);
  EXPECT_THAT(options.error().message, HasSubstr("GOSHAWK_INTERFACES is set but empty: unset it"));
}

TEST(ContextOptions, TakeTheLayoutOfTheRosGraphFromTheEnvironment) {
  for (const auto& [text, layout] :
       {std::pair{"", RosGraphLayout::automatic}, std::pair{"auto", RosGraphLayout::automatic},
        std::pair{"humble", RosGraphLayout::humble}, std::pair{"iron", RosGraphLayout::iron},
        std::pair{"off", RosGraphLayout::off}}) {
    const Variable variable("GOSHAWK_ROS_GRAPH", text);
    const auto options = ContextOptions::from_environment();
    ASSERT_TRUE(options) << options.error().message;
    EXPECT_EQ(options->ros_graph, layout) << text;
  }
  const Variable variable("GOSHAWK_ROS_GRAPH", "foxy");
  const auto options = ContextOptions::from_environment();
  ASSERT_EQ(options.code(), ErrorCode::invalid_parameter);
  EXPECT_THAT(options.error().message,
              HasSubstr("GOSHAWK_ROS_GRAPH is 'foxy': it must be auto, humble, iron"));
}

TEST(ContextOptions, RefuseADomainThatDoesNotExist) {
  for (const char* text : {"233", "-1", "7x", "x"}) {
    const Variable domain("ROS_DOMAIN_ID", text);
    EXPECT_EQ(ContextOptions::from_environment().code(), ErrorCode::invalid_parameter) << text;
  }
}

}  // namespace
}  // namespace goshawk::runtime
