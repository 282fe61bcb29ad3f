// A component for container_test: latches "<node> <label>" on `probe`, answers `poke` on `poked`.

#include "goshawk/runtime/component.hpp"
#include "std_msgs.h"
#include "test_config.hpp"

namespace goshawk::runtime_test {

class Probe : public runtime::Component {
 public:
  explicit Probe(runtime::Node& node)
      : config_(node.parameters<Config>()),
        hello_(node.advertise<std_msgs::msg::String>("probe", runtime::Qos::latched())),
        poked_(node.advertise<std_msgs::msg::String>("poked", runtime::Qos::reliable_last())) {
    if (config_.label == "throw") throw std::logic_error("a bug in a constructor");
    std_msgs::msg::String hello;
    hello.data(node.full_name() + " " + config_.label);
    (void)hello_.publish(hello);
    node.subscribe<std_msgs::msg::String>(
        "poke", runtime::Qos::latched(),
        [this](const std_msgs::msg::String& m, const auto&) { (void)poked_.publish(m); });
  }

 private:
  Config config_;
  runtime::Publisher<std_msgs::msg::String> hello_;
  runtime::Publisher<std_msgs::msg::String> poked_;
};

}  // namespace goshawk::runtime_test

GOSHAWK_REGISTER_COMPONENT(goshawk::runtime_test::Probe, goshawk::runtime_test::Config)
