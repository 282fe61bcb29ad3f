#pragma once

#include <memory>
#include <string>
#include <vector>

#include "goshawk/runtime/node.hpp"

namespace goshawk::runtime {

/// A stage as a plug-in: constructed with its node, it subscribes and publishes; the container
/// spins the node. Constructors leave a component usable, or throw StartupFault.
class Component {
 public:
  virtual ~Component() = default;
};

/// What libgoshawk_NAME_component.so exports.
struct ComponentExport {
  std::unique_ptr<Component> (*create)(Node& node);
  std::vector<ParameterDescription> (*describe)();
};

/// Loads libgoshawk_NAME_component.so from this library's folder, GOSHAWK_COMPONENT_PATH or
/// LD_LIBRARY_PATH. @return invalid_parameter that lists the installed components
Result<const ComponentExport*> load_component(const std::string& name);

/// @return names of all installed components, sorted
std::vector<std::string> installed_components();

}  // namespace goshawk::runtime

/// Once in each component's source. Config is its parameter struct.
#define GOSHAWK_REGISTER_COMPONENT(Class, Config)                                        \
  extern "C" __attribute__((visibility("default")))                                      \
  const goshawk::runtime::ComponentExport goshawk_component{                             \
      [](goshawk::runtime::Node& node) -> std::unique_ptr<goshawk::runtime::Component> { \
        return std::make_unique<Class>(node);                                            \
      },                                                                                 \
      &goshawk::runtime::describe_parameters<Config>};
