#pragma once

#include <array>
#include <vector>

namespace goshawk::trajectory_optimizer {

/// Cholesky factors of a symmetric positive definite matrix that is block-tridiagonal with 9 x 9
/// blocks, plus one dense last row and column (the border). Work and memory are linear in the
/// number of blocks; nothing is allocated once resize() has seen the largest size.
class ArrowCholesky {
 public:
  static constexpr int kBlock = 9;
  static constexpr int kBorder = 18;  // the row of the border in a panel

  /// One block column, stored column by column: rows 0..8 the diagonal block (lower triangle is
  /// read), rows 9..17 the block below it, row 18 the border.
  struct Panel {
    std::array<std::array<double, 20>, kBlock> column;
  };

  /// Sets every entry to zero. @param blocks >= 0
  void resize(int blocks);
  int blocks() const { return int(panels_.size()); }

  Panel& panel(int block) { return panels_[std::size_t(block)]; }
  double& corner() { return corner_; }

  /// Replaces the matrix with its factors.
  /// @return false where the matrix is not positive definite or not finite
  bool factor();

  /// @param rhs in: 9 * blocks() values and then 9 of padding (any value); out: the solution
  /// @param border in: the last right-hand side; out: the last unknown
  void solve(std::vector<double>& rhs, double& border) const;

 private:
  std::vector<Panel> panels_;
  std::vector<std::array<double, kBlock>> inverse_diagonal_;
  double corner_ = 1.0;
};

}  // namespace goshawk::trajectory_optimizer
