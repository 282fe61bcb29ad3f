#include "goshawk/stage/memory_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>

namespace goshawk::stage {
namespace {

/// FNV-1a
std::uint64_t fnv1a(const unsigned char* bytes, std::size_t count) {
  std::uint64_t hash = 0xCBF29CE484222325ULL;
  for (std::size_t i = 0; i < count; ++i) hash = (hash ^ bytes[i]) * 0x100000001B3ULL;
  return hash;
}

constexpr std::size_t kSum = sizeof(std::uint64_t);

}  // namespace

MemoryBytes framed(std::string_view kind, const MemoryBytes& content) {
  MemoryBytes bytes(kind.begin(), kind.end());
  bytes.push_back('\n');
  bytes.insert(bytes.end(), content.begin(), content.end());
  const std::uint64_t sum = fnv1a(bytes.data(), bytes.size());
  bytes.resize(bytes.size() + kSum);
  std::memcpy(bytes.data() + bytes.size() - kSum, &sum, kSum);
  return bytes;
}

Result<MemoryBytes> unframed(std::string_view kind, const MemoryBytes& bytes) {
  const std::size_t head = kind.size() + 1;
  if (bytes.size() >= head + kSum) {
    const std::size_t end = bytes.size() - kSum;
    std::uint64_t sum = 0;
    std::memcpy(&sum, bytes.data() + end, kSum);
    if (std::equal(kind.begin(), kind.end(), bytes.begin()) && bytes[kind.size()] == '\n' &&
        sum == fnv1a(bytes.data(), end)) {
      return MemoryBytes(bytes.begin() + std::ptrdiff_t(head), bytes.begin() + std::ptrdiff_t(end));
    }
  }
  return fail(ErrorCode::io_failed, "it is cut off, was changed, or is of another version");
}

Status replace_file(const std::string& path, const MemoryBytes& bytes) {
  const std::string draft = path + ".new";
  errno = 0;
  std::ofstream file(draft, std::ios::binary | std::ios::trunc);
  file.write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
  file.close();
  const std::string why = std::strerror(errno);
  std::error_code error;
  if (file) std::filesystem::rename(draft, path, error);
  if (file && !error) return success();
  return fail(ErrorCode::io_failed,
              fmt::format("{} cannot be written ({}): a stage that is restarted begins anew", path,
                          error ? error.message() : why));
}

Result<MemoryBytes> read_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  file.peek();  // a folder can be opened, but not read
  if (file) return MemoryBytes(std::istreambuf_iterator<char>(file), {});
  const std::string why = std::strerror(errno);
  std::error_code error;  // of a folder that may not be looked into
  if (!std::filesystem::exists(path, error) && !error) return MemoryBytes{};
  return fail(ErrorCode::io_failed, fmt::format("{} cannot be read: {}", path, why));
}

}  // namespace goshawk::stage
