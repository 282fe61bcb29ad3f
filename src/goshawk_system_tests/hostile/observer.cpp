#include "observer.hpp"

#include <chrono>
#include <stdexcept>

namespace goshawk::hostile {
namespace {

constexpr std::size_t kMostKept = 4'000;
constexpr std::size_t kLargest =
    4'096;  // [byte] of those kept: mutations of a map's payload say little

}  // namespace

Observer::Observer() {
  auto options = runtime::ContextOptions::from_environment();
  if (!options) throw std::runtime_error(options.error().message);
  options->tap = [this](auto datagram, bool sent) { keep(datagram, sent); };
  auto context = runtime::Context::create(*options);
  if (!context) throw std::runtime_error(context.error().message);
  context_ = *std::move(context);
  node_ = std::make_unique<runtime::Node>(*context_, "observer");
}

void Observer::keep(std::span<const std::byte> datagram, bool sent) {
  if (datagram.size() <= kHeader || datagram.size() > kLargest) return;
  const std::lock_guard lock(mutex_);
  auto& kept = sent ? sent_ : received_;
  if (kept.size() < kMostKept) kept.emplace(datagram.begin(), datagram.end());
}

void Observer::watch(double for_s) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(for_s);
  while (std::chrono::steady_clock::now() < end) {
    for (const auto& e : context_->endpoints()) {
      if (!e.writer || !e.topic.starts_with('/') || !topics_.insert(e.topic).second) continue;
      node_->subscribe_raw(e.topic, runtime::raw_message_type(runtime::wire_type_name(e.type)),
                           {e.reliable, e.transient_local, 10}, [](const void*, const auto&) {});
    }
    node_->spin_some(0.1);
  }
}

Observer::Captured Observer::captured() const {
  const std::lock_guard lock(mutex_);
  return {{sent_.begin(), sent_.end()}, {received_.begin(), received_.end()}};
}

}  // namespace goshawk::hostile
