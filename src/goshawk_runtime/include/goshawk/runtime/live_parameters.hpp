#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "goshawk/runtime/parameters.hpp"

namespace goshawk::runtime {

struct ParameterChange {
  std::string name;
  std::string old_value;
  std::string value;
};

/// The parameters of a running node (docs/adr/0008-parameters-at-run-time.md).
class LiveParameters {
 public:
  virtual ~LiveParameters() = default;

  /// Current values; at_run_time only if set() can change them.
  virtual std::vector<ParameterDescription> list() const = 0;

  /// Sets all of the wanted values or, if anything is wrong with one, none.
  /// @return old and new values; invalid_parameter that lists every fault: an unknown name, a wrong
  /// type, a value out of range, a parameter that is fixed at start, or the component's own refusal
  virtual Result<std::vector<ParameterChange>> set(const ParameterSource& wanted) = 0;
};

/// The parameters of a config struct and the component that uses it.
template <typename Config>
class LiveConfig final : public LiveParameters {
 public:
  /// Adopts a whole config, or refuses it and changes nothing.
  using Reconfigure = std::function<Status(const Config&)>;

  /// @param reconfigure empty: nothing can be changed
  LiveConfig(Config config, std::string node_name, Reconfigure reconfigure)
      : config_(std::move(config)),
        node_name_(std::move(node_name)),
        reconfigure_(std::move(reconfigure)) {}

  std::vector<ParameterDescription> list() const override {
    auto list = describe_parameters(config_);
    if (!reconfigure_) {
      for (auto& parameter : list) parameter.at_run_time = false;
    }
    return list;
  }

  Result<std::vector<ParameterChange>> set(const ParameterSource& wanted) override {
    const auto changeable = reconfigure_ ? detail::Changeable::at_run_time : detail::Changeable::no;
    auto candidate = read_parameters<Config>(wanted, node_name_, nullptr, config_, changeable);
    if (!candidate) return candidate.error();
    const auto before = describe_parameters(config_);
    if (reconfigure_) {
      if (auto status = reconfigure_(*candidate); !status) return status.error();
    }
    config_ = *std::move(candidate);
    const auto after = describe_parameters(config_);
    std::vector<ParameterChange> changes;
    for (std::size_t i = 0; i < after.size(); ++i) {
      if (!wanted.entries().contains(after[i].name)) continue;
      changes.push_back({after[i].name, before[i].value, after[i].value});
    }
    return changes;
  }

 private:
  Config config_;
  std::string node_name_;
  Reconfigure reconfigure_;
};

}  // namespace goshawk::runtime
