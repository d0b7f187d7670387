#pragma once

#include <memory>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

namespace hv::replay::plot {

struct Rgb {
  int r = 0;
  int g = 0;
  int b = 0;
};

struct PixelPoint {
  double x = 0.0;
  double y = 0.0;
};

/// Part of a picture [px], y down.
struct PixelRect {
  double left = 0.0;
  double top = 0.0;
  double right = 0.0;
  double bottom = 0.0;
  double width() const { return right - left; }
  double height() const { return bottom - top; }
};

enum class TextAnchor { kLeft, kCentre, kRight };

struct TextStyle {
  double height = 14.0;  ///< [px]
  Rgb colour = {51, 56, 66};
  TextAnchor anchor = TextAnchor::kLeft;
  bool bold = false;
};

/// The shared look of all figures.
inline constexpr Rgb kWhite = {255, 255, 255};
inline constexpr Rgb kGridColour = {228, 231, 236};
inline constexpr Rgb kAxisColour = {148, 155, 168};
inline constexpr Rgb kTextColour = {51, 56, 66};
inline constexpr Rgb kFaintTextColour = {108, 116, 130};
inline constexpr Rgb kReferenceColour = {165, 172, 184};

/// Colour of the k-th curve of a figure.
Rgb SeriesColour(std::size_t k);

/// Colour of a value in [0, 1] on a perceptual scale from dark violet to yellow.
Rgb ScaleColour(double value);

/// A picture to draw on in pixels of the final image; drawn at twice the size and averaged down.
class Canvas {
 public:
  Canvas(int width, int height, Rgb background);
  /// Draws over an existing 8-bit BGR picture of the final size.
  explicit Canvas(const cv::Mat& background);
  ~Canvas();

  int width() const;
  int height() const;

  void Polyline(const std::vector<PixelPoint>& points, Rgb colour, double thickness);
  void Line(PixelPoint from, PixelPoint to, Rgb colour, double thickness);
  void Disc(PixelPoint centre, double radius, Rgb colour);
  void Rectangle(const PixelRect& rect, Rgb colour);
  void Outline(const PixelRect& rect, Rgb colour, double thickness);
  /// `at` is on the base line of the text.
  void Text(PixelPoint at, const std::string& text, const TextStyle& style);
  double TextWidth(const std::string& text, const TextStyle& style);
  /// Restricts drawing to `rect` until Unclip.
  void Clip(const PixelRect& rect);
  void Unclip();

  /// Throws InputError when the file cannot be written.
  void Save(const std::string& path) const;

 private:
  class Font;
  cv::Mat Target();
  cv::Point Shifted(PixelPoint point) const;

  cv::Mat image_;
  cv::Rect clip_;
  std::unique_ptr<Font> regular_;
  std::unique_ptr<Font> bold_;
};

}  // namespace hv::replay::plot
