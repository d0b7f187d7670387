#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "hv_loop_btc/btc_descriptor.h"
#include "hv_loop_btc/plane_voxels.h"

namespace hv::loop {

/// A cloud seen along the normal of a plane: each cell of a grid on the plane holds which slices of
/// height above it are occupied, as bits (methods section 2, step 3).
class HeightImage {
 public:
  HeightImage(const std::vector<Eigen::Vector3f>& points, const ReferencePlane& plane,
              const BtcScale& scale);

  /// Cells that stand out: local maxima of the number of set bits that do not lie in the middle of
  /// a line, strongest first, at most `limit`.
  std::vector<BtcKeypoint> Keypoints(std::size_t limit) const;

 private:
  struct Cell {
    std::uint64_t bits = 0;
    Eigen::Vector2f sum = Eigen::Vector2f::Zero();
    float count = 0.0F;
  };
  struct Peak {
    int x = 0;
    int y = 0;
    int strength = 0;  ///< set bits of the cell and its neighbours
  };

  void Fill(const std::vector<Eigen::Vector3f>& points);
  int Strength(int x, int y) const;
  bool OnLine(const Peak& peak) const;
  std::vector<Peak> LocalMaxima() const;
  BtcKeypoint MakeKeypoint(const Peak& peak) const;
  const Cell& At(int x, int y) const {
    return cells_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                  static_cast<std::size_t>(x)];
  }
  bool Inside(int x, int y) const { return x >= 0 && y >= 0 && x < width_ && y < height_; }

  BtcScale scale_;
  ReferencePlane plane_;
  Eigen::Matrix<float, 2, 3> axes_;  ///< of the image, rows
  Eigen::Vector2f low_ = Eigen::Vector2f::Zero();
  int width_ = 0;
  int height_ = 0;
  std::vector<Cell> cells_;
};

}  // namespace hv::loop
