#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "goshawk/map_server/pose_buffer.hpp"

namespace goshawk::map_server {

/// What /tf and /tf_static tell of sensors on the vehicle.
class FrameTree {
 public:
  /// @param kept_s, max_gap_s of frames that move, as PoseBuffer
  FrameTree(double kept_s, double max_gap_s) : kept_s_(kept_s), max_gap_s_(max_gap_s) {}

  /// A frame that never moves in its parent. A later one takes its place.
  void set_static(const std::string& parent, const std::string& child, const Pose& pose);
  /// A frame that moves. @return as PoseBuffer::add
  Status add(const std::string& parent, const std::string& child, std::int64_t stamp_ns,
             const Pose& pose);

  struct Chain;

  /// The links from a frame up to `base`, for look-ups at many moments.
  /// @return wrong_frame if no chain leads there
  Result<Chain> chain(const std::string& frame, const std::string& base) const;


 private:
  struct Link {
    std::string parent;
    Pose fixed;
    PoseBuffer moving;
    bool is_static;
  };

  double kept_s_, max_gap_s_;
  std::map<std::string, Link, std::less<>> links_;  // by child
};

/// A frame in `base`, at any moment. Valid until the tree changes.
struct FrameTree::Chain {
  std::vector<const FrameTree::Link*> links;  // the lowest first
  /// @return as PoseBuffer::at
  Result<Pose> at(std::int64_t stamp_ns) const;
};

}  // namespace goshawk::map_server
