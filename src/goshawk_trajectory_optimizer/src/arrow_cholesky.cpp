#include "goshawk/trajectory_optimizer/arrow_cholesky.hpp"

#include <algorithm>
#include <cmath>

namespace goshawk::trajectory_optimizer {
namespace {

constexpr int kBlock = ArrowCholesky::kBlock;
constexpr int kBorder = ArrowCholesky::kBorder;
constexpr int kRows = 20;  // one of padding: whole pairs for the vector units

// Right-looking: the columns are contiguous, so each update is a vector operation.
bool factor_panel(ArrowCholesky::Panel& panel, std::array<double, kBlock>& inverse_diagonal) {
  for (int j = 0; j < kBlock; ++j) {
    double* const from = panel.column[std::size_t(j)].data();
    if (!(from[j] > 0.0) || !std::isfinite(from[j])) return false;
    const double inverse = 1.0 / std::sqrt(from[j]);
    inverse_diagonal[std::size_t(j)] = inverse;
    for (int r = 0; r < kRows; ++r) from[r] *= inverse;
    for (int c = j + 1; c < kBlock; ++c) {
      double* const to = panel.column[std::size_t(c)].data();
      const double factor = from[c];
      for (int r = 0; r < kRows; ++r) to[r] -= factor * from[r];
    }
  }
  return true;
}

// What the factored panel takes from the next one: diagonal block and border.
void update_next(const ArrowCholesky::Panel& panel, ArrowCholesky::Panel& next) {
  for (int c = 0; c < kBlock; ++c) {
    double* const to = next.column[std::size_t(c)].data();
    double border = to[kBorder];
    for (int k = 0; k < kBlock; ++k) {
      const double* const from = panel.column[std::size_t(k)].data() + kBlock;
      const double factor = from[c];
      for (int r = 0; r < kBlock; ++r) to[r] -= factor * from[r];
      border -= factor * from[kBlock];
    }
    to[kBorder] = border;
  }
}

}  // namespace

void ArrowCholesky::resize(int blocks) {
  panels_.resize(std::size_t(blocks));
  inverse_diagonal_.resize(std::size_t(blocks));
  for (Panel& panel : panels_) {
    for (auto& column : panel.column) column.fill(0.0);
  }
  corner_ = 0.0;
}

bool ArrowCholesky::factor() {
  for (std::size_t k = 0; k < panels_.size(); ++k) {
    if (!factor_panel(panels_[k], inverse_diagonal_[k])) return false;
    if (k + 1 < panels_.size()) update_next(panels_[k], panels_[k + 1]);
    for (const auto& column : panels_[k].column) corner_ -= column[kBorder] * column[kBorder];
  }
  return corner_ > 0.0 && std::isfinite(corner_);
}

void ArrowCholesky::solve(std::vector<double>& rhs, double& border) const {
  const std::size_t n = panels_.size();
  std::fill(rhs.begin() + std::ptrdiff_t(n) * kBlock, rhs.end(), 0.0);
  for (std::size_t k = 0; k < n; ++k) {
    double* const x = rhs.data() + k * kBlock;
    for (int j = 0; j < kBlock; ++j) {
      const double* const column = panels_[k].column[std::size_t(j)].data();
      x[j] *= inverse_diagonal_[k][std::size_t(j)];
      for (int r = j + 1; r < kBorder; ++r) x[r] -= column[r] * x[j];
      border -= column[kBorder] * x[j];
    }
  }
  border /= corner_;
  std::fill(rhs.begin() + std::ptrdiff_t(n) * kBlock, rhs.end(), 0.0);
  for (std::size_t k = n; k-- > 0;) {
    double* const x = rhs.data() + k * kBlock;
    for (int j = kBlock - 1; j >= 0; --j) {
      const double* const column = panels_[k].column[std::size_t(j)].data();
      double even = x[j] - column[kBorder] * border;  // two sums, half the latency
      double odd = 0.0;
      int r = j + 1;
      for (; r + 1 < kBorder; r += 2) {
        even -= column[r] * x[r];
        odd -= column[r + 1] * x[r + 1];
      }
      if (r < kBorder) even -= column[r] * x[r];
      x[j] = (even + odd) * inverse_diagonal_[k][std::size_t(j)];
    }
  }
}

}  // namespace goshawk::trajectory_optimizer
