#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "goshawk/path_search/move_cost.hpp"

namespace goshawk::path_search {

/// What the search knows of a voxel, in 64 bits that compare like the quality of the label:
///
///     63..49 query number | 48..6 kMaxCost - g | 5..1 direction of arrival | 0 expanded
///
/// A label of an earlier query is smaller than every label of this one, and of two labels of one
/// query the larger has the smaller cost. So "unknown or worse" is one comparison, memory that is
/// zero is a valid empty table, and nothing is cleared between queries.
using Label = std::uint64_t;

inline constexpr int kCostBits = 43;
inline constexpr Cost kMaxCost = (Cost{1} << kCostBits) - 1;  // 4 million voxels
inline constexpr Label kExpanded = 1;

/// Memory of zeros for labels. It is mapped, not written: pages that no search touches are never
/// made.
class LabelMemory {
 public:
  /// All labels empty. @return false if there is no memory for so many
  bool resize(std::size_t labels);
  /// Makes the pages of the first labels, at most so many, now. @pre resize() was true
  void populate(std::size_t labels);
  Label* data() const { return labels_.get(); }

 private:
  struct Unmap {
    std::size_t bytes;
    void operator()(Label* labels) const;
  };
  std::unique_ptr<Label, Unmap> labels_;
};

/// What labels of one query have in common.
class QueryLabels {
 public:
  /// The label of cost 0, without direction.
  Label root() const { return root_; }
  bool is_current(Label label) const { return label >> 49 == query_; }
  /// @pre is_current(label)
  Cost cost(Label label) const { return Cost((root_ >> 6) - (label >> 6)); }

  static int direction(Label label) { return int((label >> 1) & 31U); }
  /// The label of a node that is reached from one of label `from` at a further cost.
  static Label extend(Label from, Cost cost, int direction) {
    return ((from & ~Label{63}) - (Label(cost) << 6)) | (Label(direction) << 1);
  }
  static bool improves(Label candidate, Label held) {
    return (candidate & ~Label{63}) > (held | 63U);
  }

 protected:
  static constexpr Label kLastQuery = (Label{1} << 15) - 1;

  void use(Label query) {
    query_ = query;
    root_ = (query_ << 49) | (Label(kMaxCost) << 6);
  }

  Label query_ = 0;
  Label root_ = 0;
};

/// One label a node, in the order of the nodes.
class LabelTable : public QueryLabels {
 public:
  /// All labels empty. @return false if there is no memory for so many
  bool resize(Index3 size, std::int64_t nodes);

  /// Asks now for the memory of as many labels as a search of some length needs.
  void populate() { memory_.populate(kPopulated); }

  /// Forgets all labels. Once in 32767 queries the table is renewed, at the price of resize().
  /// @return false if that found no memory
  bool start_query();

  Label& at(std::uint32_t node, Index3) { return memory_.data()[node]; }
  Label held(std::uint32_t node, Index3) const { return memory_.data()[node]; }
  const Label* around(std::uint32_t node) const { return memory_.data() + node; }

 private:
  static constexpr std::size_t kPopulated = std::size_t{1} << 20;

  LabelMemory memory_;
  std::int64_t nodes_ = 0;
};

}  // namespace goshawk::path_search
