#include "goshawk/px4/config.hpp"

#include <fmt/format.h>

namespace goshawk::px4 {
namespace {

constexpr double kOffboardCheck_s = 0.1;  // PX4 notices that late
constexpr double kExternal_s = 1.35;
constexpr double kExternal_1_15_s = 1.05;

}  // namespace

double follows_on_s(const Config& config) {
  if (config.mode == ModeKind::offboard) return config.offboard_loss_s + kOffboardCheck_s;
  return config.release == Release::v1_15 ? kExternal_1_15_s : kExternal_s;
}

double flies_on_m(const Config& config, double speed_m_s) {
  const double t_s = follows_on_s(config), a = config.a_max_m_s2;
  const double last_m_s = speed_m_s + a * t_s;
  return speed_m_s * t_s + 0.5 * a * t_s * t_s + last_m_s * last_m_s / (2.0 * config.brake_m_s2);
}

Status check(const Config& config) {
  ParameterFaults faults;
  describe(config, faults);
  const double needed_m = flies_on_m(config, config.v_max_m_s);
  if (faults.empty() && needed_m > config.margin_m) {
    faults.add(fmt::format(
        "margin_m is {:.2g} m, but PX4 flies on for {:.2g} s with the last setpoint of a process "
        "that "
        "has died: {:.2g} m at v_max_m_s {:.2g} and a_max_m_s2 {:.2g}. Widen margin_m here and in "
        "the map server, lower "
        "v_max_m_s and a_max_m_s2 here and in the navigator{}",
        config.margin_m, follows_on_s(config), needed_m, config.v_max_m_s, config.a_max_m_s2,
        config.mode == ModeKind::offboard ? ", or lower PX4's COM_OF_LOSS_T and offboard_loss_s"
                                          : ", or fly in Offboard with a low COM_OF_LOSS_T"));
  }
  return faults.status("px4: ");
}

}  // namespace goshawk::px4
