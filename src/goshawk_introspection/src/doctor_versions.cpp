#include <link.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <filesystem>

#include "goshawk/introspection/doctor.hpp"
#include "goshawk/runtime/version.hpp"

namespace goshawk::introspection {
namespace {

struct Library {
  const char* name;
  const char* file;      // begins so; empty: headers alone
  const char* compiled;  // as CMake found it
};

constexpr Library kLibraries[] = {{"Fast DDS", "libfastrtps.so", GOSHAWK_FASTRTPS},
                                  {"Fast CDR", "libfastcdr.so", GOSHAWK_FASTCDR},
                                  {"Eigen", "", GOSHAWK_EIGEN},
                                  {"OctoMap", "liboctomap.so", GOSHAWK_OCTOMAP},
                                  {"FCL", "libfcl.so", GOSHAWK_FCL},
                                  {"OMPL", "libompl.so", GOSHAWK_OMPL},
                                  {"spdlog", "libspdlog.so", GOSHAWK_SPDLOG},
                                  {"yaml-cpp", "libyaml-cpp.so", GOSHAWK_YAML}};

// The file of a library that this program has loaded, links followed; empty: it has not.
std::string loaded_file(const std::string& begin) {
  struct Search {
    const std::string& begin;
    std::string found;
  } search{begin, ""};
  dl_iterate_phdr(
      [](dl_phdr_info* info, std::size_t, void* data) {
        auto& s = *static_cast<Search*>(data);
        const std::filesystem::path path(info->dlpi_name);
        if (!path.filename().string().starts_with(s.begin)) return 0;
        std::error_code ignored;
        s.found = std::filesystem::canonical(path, ignored).string();
        return 1;
      },
      &search);
  return search.found;
}

std::string on_path(const std::string& program) {
  const char* path = std::getenv("PATH");
  for (std::string_view list = path == nullptr ? "" : path; !list.empty();) {
    const auto colon = list.find(':');
    const std::string file = std::string(list.substr(0, colon)) + "/" + program;
    if (access(file.c_str(), X_OK) == 0) return file;
    list = colon == std::string_view::npos ? "" : list.substr(colon + 1);
  }
  return "";
}

Finding check_browser() {
  for (const char* browser : {"xdg-open", "chromium", "firefox", "google-chrome"}) {
    const std::string file = on_path(browser);
    if (!file.empty()) return {"browser", Level::fine, "goshawk view opens " + file};
  }
  return {"browser", Level::note, "none is on PATH",
          "goshawk view cannot open a page by itself; flights do not need one",
          "open the address that it prints, or apt-get install chromium"};
}

Finding check_node() {
  const std::string node = on_path("node");
  if (!node.empty()) return {"node.js", Level::fine, node};
  return {"node.js", Level::note, "is not on PATH",
          "it fetches Foxglove Studio for goshawk view --foxglove; all else works without",
          "tools/setup --viewer"};
}

}  // namespace

Finding compare_versions(const std::string& name, const std::string& compiled,
                         const std::string& loaded) {
  const auto so = loaded.rfind(".so.");
  const std::string found = so == std::string::npos ? "" : loaded.substr(so + 4);
  const std::string built = compiled.empty() ? "an unknown version" : compiled;
  if (found.empty()) return {name, Level::fine, built + " as compiled"};
  // Before the second dot is what binaries depend on.
  const auto until = [](const std::string& v) { return v.find('.', v.find('.') + 1); };
  if (compiled.empty() || found.substr(0, until(found)) == compiled.substr(0, until(compiled))) {
    return {name, Level::fine, built + " as compiled, " + found + " as loaded"};
  }
  return {name, Level::warning, built + " as compiled, but " + found + " as loaded, of " + loaded,
          "other versions have other layouts: what comes of it is undefined",
          "build again (tools/build --clean), or mend LD_LIBRARY_PATH"};
}

std::vector<Finding> check_versions() {
  std::vector<Finding> findings{{"Goshawk", Level::fine, runtime::version()}};
  for (const Library& l : kLibraries) {
    findings.push_back(
        compare_versions(l.name, l.compiled, *l.file == '\0' ? "" : loaded_file(l.file)));
  }
  findings.push_back(check_browser());
  findings.push_back(check_node());
  return findings;
}

}  // namespace goshawk::introspection
