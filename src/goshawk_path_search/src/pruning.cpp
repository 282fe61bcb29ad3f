#include "goshawk/path_search/pruning.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "goshawk/core/line_of_sight.hpp"

namespace goshawk::path_search {
namespace {

// Bounds on the work of `shortest`: a path of more nodes gives every second, third, ... node (and
// all of the greedy polyline); line of sight is tested over so many voxels for each candidate.
constexpr std::size_t kMostCandidates = 200;
constexpr double kWorkPerCandidate = 400.0;
constexpr double kNever = std::numeric_limits<double>::infinity();
constexpr double kGain = 1e-12;  // relative; less is rounding

}  // namespace

void PathPruner::prune(Pruning pruning, const BitGrid& blocked, std::span<const Vec3> nodes,
                       std::vector<int>& kept) {
  blocked_ = &blocked;
  nodes_ = nodes;
  kept.clear();
  const int count = int(nodes.size());
  if (count <= 2 || pruning == Pruning::none) {
    for (int i = 0; i < count; ++i) kept.push_back(i);
  } else if (pruning == Pruning::greedy) {
    greedy(kept);
  } else {
    shortest(kept);
  }
}

bool PathPruner::visible(int from, int to) {
  if (to == from + 1) return true;
  const Vec3& a = nodes_[std::size_t(from)];
  const Vec3& b = nodes_[std::size_t(to)];
  work_left_ -= (b - a).lpNorm<1>() + 1.0;
  return line_is_free(*blocked_, a, b);
}

double PathPruner::length(const std::vector<int>& indices) const {
  double sum = 0.0;
  for (std::size_t k = 1; k < indices.size(); ++k) {
    sum += (nodes_[std::size_t(indices[k])] - nodes_[std::size_t(indices[k - 1])]).norm();
  }
  return sum;
}

// Thesis, Algorithm 2: from each kept node on to the last one before the view is cut for the
// first time. (As printed it skips the test of the final segment's predecessor.)
void PathPruner::greedy(std::vector<int>& kept) {
  const int last = int(nodes_.size()) - 1;
  kept.push_back(0);
  for (int at = 0; at < last;) {
    int next = at + 1;
    while (next < last && visible(at, next + 1)) ++next;
    kept.push_back(next);
    at = next;
  }
}

// A greedy polyline with few tests: the step doubles while the view is free, then is halved.
void PathPruner::greedy_by_halving(bool forward, std::vector<int>& kept) {
  const int last = int(nodes_.size()) - 1;
  const auto sees = [&](int a, int b) {
    return forward ? visible(a, b) : visible(last - b, last - a);
  };
  kept.assign(1, 0);
  for (int at = 0; at < last;) {
    int good = at + 1, bad = last + 1;
    if (sees(at, last)) good = last;
    for (int step = 2; good < last && bad > last && at + step <= last; step *= 2) {
      (sees(at, at + step) ? good : bad) = at + step;
    }
    while (good < last && bad - good > 1) {
      const int middle = good + (bad - good) / 2;
      if (middle > last) break;
      (sees(at, middle) ? good : bad) = middle;
    }
    kept.push_back(good);
    at = good;
  }
  if (forward) return;
  for (int& index : kept) index = last - index;
  std::reverse(kept.begin(), kept.end());
}

// Dynamic programme in path order. The greedy polylines give a bound, which leaves out every
// candidate and every pair of them that cannot be a part of something shorter; of the pairs that
// remain, a node tries the most promising first, so that most nodes take one or two tests.
void PathPruner::shortest(std::vector<int>& kept) {
  work_left_ = kWorkPerCandidate * double(std::min(nodes_.size(), kMostCandidates));
  greedy_by_halving(true, kept);
  if (kept.size() == 2) return;
  greedy_by_halving(false, other_);
  if (length(other_) < length(kept)) std::swap(kept, other_);
  const double bound = length(kept) * (1.0 - kGain);
  choose_candidates(kept);
  reached_.assign(candidates_.size(), kNever);
  before_.assign(candidates_.size(), -1);
  reached_[0] = 0.0;
  for (std::size_t to = 1; to < candidates_.size(); ++to) {
    if (!relax(to, bound)) return;  // out of work: the greedy polyline stands
  }
  if (reached_.back() >= bound) return;
  kept.clear();
  for (int c = int(candidates_.size()) - 1; c >= 0; c = before_[std::size_t(c)]) {
    kept.push_back(candidates_[std::size_t(c)]);
  }
  std::reverse(kept.begin(), kept.end());
}

void PathPruner::choose_candidates(const std::vector<int>& always) {
  const std::size_t stride = (nodes_.size() + kMostCandidates - 1) / kMostCandidates;
  candidates_.clear();
  std::size_t k = 0;
  for (int i = 0; i < int(nodes_.size()); ++i) {
    const bool needed = k < always.size() && always[k] == i;
    if (needed) ++k;
    if (needed || std::size_t(i) % stride == 0) candidates_.push_back(i);
  }
}

// Finds the shortest polyline to one candidate over those before it. @return false: out of work
bool PathPruner::relax(std::size_t to, double bound) {
  const int node = candidates_[to];
  const Vec3& p = nodes_[std::size_t(node)];
  const double rest = (nodes_.back() - p).norm();
  heap_.clear();
  for (std::size_t c = 0; c < to; ++c) {
    const double left = bound - rest - reached_[c];
    const double squared = (p - nodes_[std::size_t(candidates_[c])]).squaredNorm();
    if (left <= 0.0 || squared >= left * left) continue;
    heap_.push_back({reached_[c] + std::sqrt(squared), int(c)});
  }
  const auto later = [](const Candidate& a, const Candidate& b) {
    return a.length != b.length ? a.length > b.length : a.from > b.from;
  };
  std::make_heap(heap_.begin(), heap_.end(), later);
  while (!heap_.empty()) {
    const Candidate best = heap_.front();
    if (work_left_ <= 0.0) return false;
    if (visible(candidates_[std::size_t(best.from)], node)) {
      reached_[to] = best.length;
      before_[to] = best.from;
      return true;
    }
    std::pop_heap(heap_.begin(), heap_.end(), later);
    heap_.pop_back();
  }
  return true;
}

}  // namespace goshawk::path_search
