// Any parameter file and any words behind --ros-args: values, or an error with a sentence.
#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <string>
#include <vector>

#include "goshawk/runtime/ros_args.hpp"

namespace {

using namespace goshawk::runtime;

/// A file in memory that has a path while it lives.
class MemoryFile {
 public:
  MemoryFile(const std::uint8_t* data, std::size_t size) : file_(memfd_create("parameters", 0)) {
    if (file_ < 0 || write(file_, data, size) != ssize_t(size)) std::abort();
  }
  ~MemoryFile() { close(file_); }
  std::string path() const { return "/proc/self/fd/" + std::to_string(file_); }

 private:
  int file_;
};

void must_say(const goshawk::Status& status) {
  if (!status && status.error().message.empty()) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const MemoryFile file(data, size);
  ParameterSource source;
  must_say(source.add_file(file.path(), "tracker", "/uav1"));

  std::vector<std::string> words{"--ros-args"};
  std::string word;
  for (std::size_t k = 0; k < size; ++k) {
    if (data[k] == ' ' || data[k] == '\n') {
      words.push_back(std::move(word));
      word.clear();
    } else {
      word += char(data[k]);
    }
  }
  words.push_back(word);
  auto args = RosArgs::extract(words);
  if (!args) return args.error().message.empty() ? std::abort(), 0 : 0;
  args->params_files.clear();  // names of other files
  (void)args->resolve_topic("path", "tracker");
  auto parameters = args->parameters_of("tracker");
  if (!parameters && parameters.error().message.empty()) std::abort();
  return 0;
}
