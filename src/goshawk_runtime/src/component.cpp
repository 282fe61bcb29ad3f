#include "goshawk/runtime/component.hpp"

#include <dlfcn.h>

#include <algorithm>
#include <filesystem>

namespace goshawk::runtime {
namespace {

constexpr std::string_view kPrefix = "libgoshawk_";
constexpr std::string_view kSuffix = "_component.so";

// Folders that may have components: this library's own, then those of GOSHAWK_COMPONENT_PATH and
// LD_LIBRARY_PATH.
std::vector<std::filesystem::path> component_folders() {
  std::vector<std::filesystem::path> folders;
  Dl_info self{};
  if (dladdr(reinterpret_cast<const void*>(&installed_components), &self) != 0) {
    folders.push_back(std::filesystem::weakly_canonical(self.dli_fname).parent_path());
  }
  for (const char* variable : {"GOSHAWK_COMPONENT_PATH", "LD_LIBRARY_PATH"}) {
    const char* value = std::getenv(variable);
    for (std::string_view list = value == nullptr ? "" : value; !list.empty();) {
      const auto colon = list.find(':');
      if (colon != 0) folders.emplace_back(list.substr(0, colon));
      list = colon == std::string_view::npos ? "" : list.substr(colon + 1);
    }
  }
  return folders;
}

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (const auto& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

}  // namespace

std::vector<std::string> installed_components() {
  std::vector<std::string> names;
  for (const auto& folder : component_folders()) {
    std::error_code ignored;
    for (const auto& file : std::filesystem::directory_iterator(folder, ignored)) {
      const std::string name = file.path().filename().string();
      if (!name.starts_with(kPrefix) || !name.ends_with(kSuffix)) continue;
      names.push_back(name.substr(kPrefix.size(), name.size() - kPrefix.size() - kSuffix.size()));
    }
  }
  std::ranges::sort(names);
  names.erase(std::unique(names.begin(), names.end()), names.end());
  return names;
}

Result<const ComponentExport*> load_component(const std::string& name) {
  const std::string file = std::string(kPrefix) + name + std::string(kSuffix);
  for (const auto& folder : component_folders()) {
    if (!std::filesystem::exists(folder / file)) continue;
    void* library = dlopen((folder / file).c_str(), RTLD_NOW | RTLD_LOCAL);
    if (library == nullptr) {
      return fail(ErrorCode::io_failed, "component " + name + " cannot be loaded: " + dlerror());
    }
    const void* symbol = dlsym(library, "goshawk_component");
    if (symbol == nullptr) {
      return fail(
          ErrorCode::io_failed,
          (folder / file).string() + " is not a component: it lacks GOSHAWK_REGISTER_COMPONENT");
    }
    return static_cast<const ComponentExport*>(symbol);
  }
  const auto known = installed_components();
  const std::string near = nearest_name(name, known);
  return fail(ErrorCode::invalid_parameter,
              "there is no component '" + name + "'" +
                  (near.empty() ? "." : "; did you mean " + near + "?") +
                  " Installed: " + joined(known));
}

}  // namespace goshawk::runtime
