#include <fmt/format.h>

#include <cmath>
#include <concepts>
#include <type_traits>

#include "goshawk/conversions/geometry.hpp"
#include "goshawk/conversions/moving_boxes.hpp"
#include "goshawk/core/parameter.hpp"
#include "goshawk/movers/movers_file.hpp"
#include "goshawk/runtime/component.hpp"
#include "goshawk/stage/stage_reporter.hpp"

namespace goshawk::movers {
namespace {

using namespace goshawk::runtime;
using goshawk_msgs::msg::MovingBoxes;

struct Config {
  std::string movers_file = "";
  double movers_start_s = 0.0;
  double rate_hz = 50.0;
};

template <typename Self, typename Visitor>
requires std::same_as<std::remove_const_t<Self>, Config>
void describe(Self& c, Visitor&& visit) {
  visit("movers_file", c.movers_file, "", "what moves in the true world (docs/movers.md)",
        Anything{});
  visit("movers_start_s", c.movers_start_s, "s",
        "stamp at which the movers' time is 0; the same for all that read the file",
        Range{0.0, 1e10});
  visit("rate_hz", c.rate_hz, "Hz", "messages a second", Range{1.0, 1000.0});
}

std::vector<Mover> read(const Config& config) {
  if (config.movers_file.empty()) {
    throw StartupFault(fail(ErrorCode::invalid_parameter,
                            "movers_file is empty: name a file of movers (docs/movers.md)"));
  }
  auto movers = read_movers(config.movers_file);
  if (!movers) throw StartupFault(movers.error());
  return *std::move(movers);
}

/// A file of movers -> movers: where each is now, and how it moves. The truth.
class MoversComponent : public Component {
 public:
  explicit MoversComponent(Node& node)
      : node_(node),
        config_(node.parameters<Config>()),
        movers_(read(config_)),
        reporter_(node, StageRole::other, "movers"),
        publisher_(node.advertise<MovingBoxes>("movers", Qos::best_effort(2))),
        boxes_(movers_.size()) {
    node.every(1.0 / config_.rate_hz, [this] { publish(); });
    reporter_.ready(fmt::format("{} movers, {:g} times a second", movers_.size(), config_.rate_hz));
  }

 private:
  void publish() {
    const std::int64_t now_ns = node_.now_ns();
    if (now_ns == 0) return;  // simulated time has not begun
    const double t_s = 1e-9 * double(now_ns - std::llround(1e9 * config_.movers_start_s));
    for (std::size_t i = 0; i < movers_.size(); ++i) boxes_[i] = box_at(movers_[i], t_s);
    message_.header(conversions::make_header(now_ns));
    conversions::fill_msg(boxes_, message_);
    reporter_.send(publisher_, message_);
  }

  static MovingBox box_at(const Mover& mover, double t_s) {
    const BoxState state = mover.at(t_s);
    return {.id = mover.id,
            .kind = mover.kind,
            .position_map = state.position_map,
            .q_map_box = state.q_map_box,
            .half_m = mover.half_m,
            .velocity_map = state.velocity_map,
            .angular_velocity_map = state.angular_velocity_map};
  }

  Node& node_;
  Config config_;
  std::vector<Mover> movers_;
  stage::StageReporter reporter_;
  Publisher<MovingBoxes> publisher_;
  std::vector<MovingBox> boxes_;
  MovingBoxes message_;
};

}  // namespace
}  // namespace goshawk::movers

GOSHAWK_REGISTER_COMPONENT(goshawk::movers::MoversComponent, goshawk::movers::Config)
