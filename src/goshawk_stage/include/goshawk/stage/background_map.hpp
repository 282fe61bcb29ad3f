#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>

#include "goshawk/stage/map_subscription.hpp"

namespace goshawk::stage {

/// The newest map for a node that must not wait: maps are received, decoded and freed in a thread
/// of their own. In lock step they come in the node's own turns, so that a run repeats.
///
///     BackgroundMap map(node);
///     if (const auto grid = map.take()) use(grid);     // as often as you like
///     if (const auto fault = map.take_fault()) report(*fault);
///
/// take() neither waits nor allocates, nor frees a map: the one before is freed in the map's
/// thread, provided that the caller holds no other pointer to it by then.
class BackgroundMap {
 public:
  explicit BackgroundMap(runtime::Node& node);
  ~BackgroundMap();
  BackgroundMap(const BackgroundMap&) = delete;
  BackgroundMap& operator=(const BackgroundMap&) = delete;

  /// @return the newest map, once; nullptr: none since the last call, or it is being handed over
  std::shared_ptr<const VoxelGrid> take();
  /// @return what was wrong with the newest wrong message, once; nothing: none since the last call
  std::optional<Error> take_fault();

 private:
  void hand_over(const std::shared_ptr<const VoxelGrid>& grid);
  void hand_over(const Error& fault);

  std::unique_ptr<runtime::Node> beside_;  // nullptr in lock step
  std::optional<MapSubscription> subscription_;
  std::mutex mutex_;                          // for what follows, held for moments only
  std::shared_ptr<const VoxelGrid> newest_;   // not taken yet
  std::shared_ptr<const VoxelGrid> taken_;    // the last that was
  std::shared_ptr<const VoxelGrid> retired_;  // the one before it, for the thread to free
  std::optional<Error> fault_;
  std::atomic<bool> has_newest_ = false;
  std::atomic<bool> has_fault_ = false;
  std::thread thread_;
};

}  // namespace goshawk::stage
