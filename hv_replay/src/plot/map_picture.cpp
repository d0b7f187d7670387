#include "hv_replay/map_picture.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include <opencv2/imgproc.hpp>

#include "axes.h"
#include "canvas.h"
#include "hv_core/error.h"

namespace hv::replay {
namespace {

constexpr int kMaxWidth = 1600;
constexpr int kMaxHeight = 1000;
constexpr int kBorder = 30;
constexpr double kMaxCoordinate = 1e5;
/// Share of columns cut off on each side of the picture as stray points.
constexpr double kStrayShare = 0.002;
/// Width shown around what is left, as a share of the picture.
constexpr float kRimShare = 0.03F;

std::uint64_t PackKey(std::int32_t x, std::int32_t y) {
  return (static_cast<std::uint64_t>(static_cast<std::uint32_t>(x)) << 32) |
         static_cast<std::uint32_t>(y);
}

std::int32_t KeyX(std::uint64_t key) { return static_cast<std::int32_t>(key >> 32); }
std::int32_t KeyY(std::uint64_t key) { return static_cast<std::int32_t>(key & 0xFFFFFFFFU); }

/// Value below which `share` of `values` lie.
float Quantile(std::vector<float> values, double share) {
  if (values.empty()) return 0.0F;
  const double index = share * static_cast<double>(values.size() - 1);
  const auto nth = values.begin() + static_cast<std::ptrdiff_t>(std::lround(index));
  std::nth_element(values.begin(), nth, values.end());
  return *nth;
}

/// Light of a column of hue `height` in [0, 1] and brightness in [0, 1], BGR.
cv::Vec3f Shade(float height, float brightness) {
  const cv::Vec3f stops[] = {{0.98F, 0.56F, 0.24F},
                             {0.86F, 0.86F, 0.20F},
                             {0.47F, 0.90F, 0.44F},
                             {0.30F, 0.84F, 0.98F},
                             {0.36F, 0.45F, 1.00F}};
  const float position = std::clamp(height, 0.0F, 1.0F) * 3.999F;
  const std::size_t index = static_cast<std::size_t>(position);
  const float share = position - static_cast<float>(index);
  const cv::Vec3f hue = stops[index] * (1.0F - share) + stops[index + 1] * share;
  const cv::Vec3f dark(0.098F, 0.063F, 0.043F);
  const cv::Vec3f light = hue * 0.9F + cv::Vec3f(0.1F, 0.1F, 0.1F) * brightness;
  return dark * (1.0F - brightness) + light * brightness;
}

}  // namespace

/// Turns the columns of a MapPicture into a picture.
class MapPainter {
 public:
  explicit MapPainter(const MapPicture& map) : map_(map) {
    FindBounds();
    FillGrids();
  }

  cv::Mat Paint() const;
  plot::PixelPoint ToPixel(const Eigen::Vector3d& point) const {
    return {kBorder + (point.x() / map_.cell_m_ - left_) * pixels_per_cell_,
            kBorder + (top_ + 1.0 - point.y() / map_.cell_m_) * pixels_per_cell_};
  }
  double pixels_per_metre() const { return pixels_per_cell_ / map_.cell_m_; }

 private:
  void FindBounds();
  void FillGrids();

  const MapPicture& map_;
  int left_ = 0;
  int top_ = 0;
  int columns_ = 1;
  int rows_ = 1;
  double pixels_per_cell_ = 1.0;
  cv::Mat count_;
  cv::Mat height_sum_;
};

void MapPainter::FindBounds() {
  std::vector<float> xs, ys;
  for (const auto& [key, column] : map_.columns_) {
    xs.push_back(static_cast<float>(KeyX(key)));
    ys.push_back(static_cast<float>(KeyY(key)));
  }
  const float left = Quantile(xs, kStrayShare);
  const float right = Quantile(xs, 1.0 - kStrayShare);
  const float bottom = Quantile(ys, kStrayShare);
  const float top = Quantile(ys, 1.0 - kStrayShare);
  const float rim = kRimShare * std::max(right - left, top - bottom);
  left_ = static_cast<int>(left - rim);
  top_ = static_cast<int>(top + rim);
  columns_ = static_cast<int>(right + rim) - left_ + 1;
  rows_ = top_ - static_cast<int>(bottom - rim) + 1;
  pixels_per_cell_ = std::min({static_cast<double>(kMaxWidth - 2 * kBorder) / columns_,
                               static_cast<double>(kMaxHeight - 2 * kBorder) / rows_, 8.0});
}

void MapPainter::FillGrids() {
  const double scale = std::min(1.0, pixels_per_cell_);
  const int width = std::max(1, static_cast<int>(std::ceil(columns_ * scale)));
  const int height = std::max(1, static_cast<int>(std::ceil(rows_ * scale)));
  count_ = cv::Mat::zeros(height, width, CV_32F);
  height_sum_ = cv::Mat::zeros(height, width, CV_32F);
  for (const auto& [key, column] : map_.columns_) {
    const double x = (KeyX(key) - left_) * scale;
    const double y = (top_ - KeyY(key)) * scale;
    if (x < 0.0 || y < 0.0 || x >= width || y >= height) continue;
    count_.at<float>(static_cast<int>(y), static_cast<int>(x)) += column.count;
    height_sum_.at<float>(static_cast<int>(y), static_cast<int>(x)) += column.height_sum;
  }
}

cv::Mat MapPainter::Paint() const {
  // Hue from smoothed heights: where floor and ceiling share a column, single means are noise.
  cv::Mat smooth_count, smooth_height;
  cv::GaussianBlur(count_, smooth_count, cv::Size(), 1.2);
  cv::GaussianBlur(height_sum_, smooth_height, cv::Size(), 1.2);
  const int pixels = count_.rows * count_.cols;
  std::vector<float> counts, heights;
  for (int i = 0; i < pixels; ++i) {
    if (count_.ptr<float>()[i] <= 0.0F) continue;
    counts.push_back(count_.ptr<float>()[i]);
    heights.push_back(smooth_height.ptr<float>()[i] / smooth_count.ptr<float>()[i]);
  }
  const float full = std::log1p(std::max(Quantile(counts, 0.98), 12.0F * Quantile(counts, 0.5)));
  const float low = Quantile(heights, 0.02);
  const float span = std::max(Quantile(heights, 0.98) - low, 0.1F);
  cv::Mat picture(count_.size(), CV_32FC3);
  for (int i = 0; i < pixels; ++i) {
    const float count = count_.ptr<float>()[i];
    const float weight = smooth_count.ptr<float>()[i];
    const float mean = weight > 0.0F ? smooth_height.ptr<float>()[i] / weight : 0.0F;
    const float density = std::min(std::log1p(count) / full, 1.0F);
    const float brightness = count > 0.0F ? 0.15F + 0.85F * std::pow(density, 1.3F) : 0.0F;
    picture.ptr<cv::Vec3f>()[i] = Shade((mean - low) / span, brightness) * 255.0F;
  }
  cv::Mat scaled;
  const double up = std::max(1.0, pixels_per_cell_);
  cv::resize(picture, scaled, cv::Size(), up, up, cv::INTER_LINEAR);
  cv::Mat framed;
  cv::copyMakeBorder(scaled, framed, kBorder, kBorder, kBorder, kBorder, cv::BORDER_CONSTANT,
                     cv::Scalar(25, 16, 11));
  cv::Mat result;
  framed.convertTo(result, CV_8UC3);
  return result;
}

void MapPicture::Add(const Eigen::Vector3d& point) {
  if (!(point.cwiseAbs().maxCoeff() < kMaxCoordinate)) return;
  const auto cell = [this](double value) {
    return static_cast<std::int32_t>(std::floor(value / cell_m_));
  };
  Column& column = columns_[PackKey(cell(point.x()), cell(point.y()))];
  column.count += 1.0F;
  column.height_sum += static_cast<float>(point.z());
}

namespace {

constexpr plot::Rgb kPathColour = {255, 255, 255};
constexpr plot::Rgb kPathRimColour = {11, 16, 25};
constexpr plot::Rgb kStartColour = {74, 222, 128};
constexpr plot::Rgb kNoteColour = {170, 182, 200};

/// A bar of a round length in the lower left corner.
void DrawScaleBar(plot::Canvas& canvas, double pixels_per_metre) {
  const plot::Range lengths = {0.0, 220.0 / pixels_per_metre};
  const double length_m = plot::NiceTicks(lengths, 2).back();
  const double left = 28.0;
  const double base = canvas.height() - 24.0;
  const double right = left + length_m * pixels_per_metre;
  canvas.Line({left, base}, {right, base}, kNoteColour, 2.0);
  canvas.Line({left, base - 5.0}, {left, base + 5.0}, kNoteColour, 2.0);
  canvas.Line({right, base - 5.0}, {right, base + 5.0}, kNoteColour, 2.0);
  const plot::TextStyle style = {13.0, kNoteColour, plot::TextAnchor::kLeft, false};
  char text[40];
  std::snprintf(text, sizeof(text), "%g m", length_m);
  canvas.Text({right + 10.0, base + 5.0}, text, style);
}

using Line = std::vector<plot::PixelPoint>;

/// The line of a trajectory; a new one after each gap.
std::vector<Line> LinesOf(const Trajectory& trajectory, const MapPainter& painter) {
  constexpr double kGap_s = 1.0;
  std::vector<Line> lines;
  Time last;
  for (const StampedPose& pose : trajectory.poses()) {
    if (lines.empty() || pose.stamp - last > kGap_s) lines.emplace_back();
    lines.back().push_back(painter.ToPixel(pose.pose.translation()));
    last = pose.stamp;
  }
  return lines;
}

}  // namespace

void MapPicture::Save(const Trajectory& trajectory, const std::string& title,
                      const std::string& path) const {
  if (columns_.empty()) throw InputError("no map points to draw");
  const MapPainter painter(*this);
  plot::Canvas canvas(painter.Paint());
  const std::vector<Line> lines = LinesOf(trajectory, painter);
  for (const Line& line : lines) canvas.Polyline(line, kPathRimColour, 5.0);
  for (const Line& line : lines) canvas.Polyline(line, kPathColour, 2.0);
  if (!lines.empty()) canvas.Disc(lines.front().front(), 5.0, kStartColour);
  const plot::TextStyle style = {20.0, kPathColour, plot::TextAnchor::kLeft, true};
  canvas.Text({28.0, 40.0}, title, style);
  DrawScaleBar(canvas, painter.pixels_per_metre());
  canvas.Save(path);
}

}  // namespace hv::replay
