#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "goshawk/core/random.hpp"

namespace goshawk::hostile {

using Bytes = std::vector<std::byte>;

constexpr std::size_t kHeader = 20;  // [byte] of an RTPS datagram

/// Makes datagrams that a parser may trip over from good ones. The same seed makes the same ones.
class Mutator {
 public:
  explicit Mutator(std::uint64_t seed) : random_(seed) {}

  /// @param good not empty; RTPS datagrams as captured
  /// @return one of them, changed in up to four ways; every tenth is left as it is
  Bytes operator()(std::span<const Bytes> good);

 private:
  void change(Bytes& datagram, std::span<const Bytes> good);
  void change_number(Bytes& datagram);
  void change_submessages(Bytes& datagram, std::span<const Bytes> good);
  std::size_t below(std::size_t n) { return std::size_t(random_.below(int(n))); }

  Random random_;
};

/// @return whether a sample of a topic is in it; discovery is no such
bool carries_sample(const Bytes& datagram);

/// Puts another participant's name in place of `from`, in the header and wherever else it stands.
void replace_name(Bytes& datagram, std::span<const std::byte> from, std::span<const std::byte> to);

}  // namespace goshawk::hostile
