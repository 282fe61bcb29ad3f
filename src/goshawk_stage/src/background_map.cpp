#include "goshawk/stage/background_map.hpp"

#include <utility>

namespace goshawk::stage {

BackgroundMap::BackgroundMap(runtime::Node& node)
    : beside_(node.in_lock_step() ? nullptr : node.beside()) {
  if (beside_) beside_->on_second_writer([this](const Error& fault) { hand_over(fault); });
  subscription_.emplace(
      beside_ ? *beside_ : node, [this](const auto& grid) { hand_over(grid); },
      [this](const Error& fault) { hand_over(fault); });
  if (beside_) thread_ = std::thread([this] { beside_->spin(); });
}

BackgroundMap::~BackgroundMap() {
  if (!beside_) return;
  beside_->stop();
  thread_.join();
}

// In the map's thread: what is replaced here is freed after the lock is.
void BackgroundMap::hand_over(const std::shared_ptr<const VoxelGrid>& grid) {
  std::shared_ptr<const VoxelGrid> unseen, retired;
  const std::lock_guard lock(mutex_);
  unseen = std::exchange(newest_, grid);
  retired = std::exchange(retired_, nullptr);
  has_newest_ = true;
}

void BackgroundMap::hand_over(const Error& fault) {
  const std::lock_guard lock(mutex_);
  fault_ = fault;
  has_fault_ = true;
}

std::optional<Error> BackgroundMap::take_fault() {
  if (!has_fault_) return {};
  const std::unique_lock lock(mutex_, std::try_to_lock);
  if (!lock.owns_lock()) return {};
  has_fault_ = false;
  return std::exchange(fault_, std::nullopt);
}

std::shared_ptr<const VoxelGrid> BackgroundMap::take() {
  if (!has_newest_) return nullptr;
  const std::unique_lock lock(mutex_, std::try_to_lock);
  if (!lock.owns_lock()) return nullptr;
  has_newest_ = false;
  retired_ = std::exchange(taken_, std::exchange(newest_, nullptr));
  return taken_;
}

}  // namespace goshawk::stage
