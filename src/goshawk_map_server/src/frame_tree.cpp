#include "goshawk/map_server/frame_tree.hpp"

#include <fmt/format.h>

namespace goshawk::map_server {

void FrameTree::set_static(const std::string& parent, const std::string& child,
                           const Pose& pose) {
  links_.insert_or_assign(child, Link{parent, pose, PoseBuffer(child, 0.0, 0.0), true});
}

Status FrameTree::add(const std::string& parent, const std::string& child, std::int64_t stamp_ns,
                      const Pose& pose) {
  auto found = links_.find(child);
  if (found == links_.end() || found->second.is_static || found->second.parent != parent) {
    const std::string what = fmt::format("the transform of '{}'", child);
    found = links_
                .insert_or_assign(child,
                                  Link{parent, {}, PoseBuffer(what, kept_s_, max_gap_s_), false})
                .first;
  }
  return found->second.moving.add(stamp_ns, pose);
}

Result<FrameTree::Chain> FrameTree::chain(const std::string& frame, const std::string& base) const {
  Chain chain;
  std::string at = frame;
  while (at != base) {
    const auto found = links_.find(at);
    // A chain longer than all links goes in a circle.
    if (found == links_.end() || chain.links.size() >= links_.size()) {
      return fail(ErrorCode::wrong_frame,
                  fmt::format("no transforms lead from frame '{}' to '{}': publish them on "
                              "/tf_static, or set sensor_frame and the sensor's place as "
                              "parameters",
                              frame, base));
    }
    chain.links.push_back(&found->second);
    at = found->second.parent;
  }
  return chain;
}

Result<Pose> FrameTree::Chain::at(std::int64_t stamp_ns) const {
  Pose pose;
  for (const Link* link : links) {
    if (link->is_static) {
      pose = link->fixed * pose;
      continue;
    }
    const auto moved = link->moving.at(stamp_ns);
    if (!moved) return moved.error();
    pose = *moved * pose;
  }
  return pose;
}

}  // namespace goshawk::map_server
