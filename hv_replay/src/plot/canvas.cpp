#include "canvas.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#ifdef HV_HAVE_FREETYPE
#include <opencv2/freetype.hpp>
#endif

#include "hv_core/error.h"

namespace hv::replay::plot {
namespace {

/// Pixels drawn per pixel saved, along each axis.
constexpr int kOversampling = 2;
/// Fractional bits of coordinates given to OpenCV.
constexpr int kShift = 4;

cv::Scalar ToScalar(Rgb colour) { return cv::Scalar(colour.b, colour.g, colour.r); }

int Thickness(double pixels) {
  return std::max(1, static_cast<int>(std::lround(pixels * kOversampling)));
}

cv::Rect ToRect(const PixelRect& rect) {
  const int left = static_cast<int>(std::lround(rect.left * kOversampling));
  const int top = static_cast<int>(std::lround(rect.top * kOversampling));
  const int right = static_cast<int>(std::lround(rect.right * kOversampling));
  const int bottom = static_cast<int>(std::lround(rect.bottom * kOversampling));
  return cv::Rect(left, top, std::max(0, right - left), std::max(0, bottom - top));
}

}  // namespace

Rgb SeriesColour(std::size_t k) {
  constexpr std::array<Rgb, 6> kColours = {{{37, 99, 235},
                                            {234, 88, 12},
                                            {22, 152, 72},
                                            {147, 51, 214},
                                            {219, 39, 119},
                                            {13, 148, 155}}};
  return kColours[k % kColours.size()];
}

Rgb ScaleColour(double value) {
  static const cv::Mat kTable = [] {
    cv::Mat ramp(1, 256, CV_8UC1);
    for (int i = 0; i < 256; ++i) ramp.at<unsigned char>(0, i) = static_cast<unsigned char>(i);
    cv::Mat table;
    cv::applyColorMap(ramp, table, cv::COLORMAP_PLASMA);
    return table;
  }();
  const int index = static_cast<int>(std::lround(std::clamp(value, 0.0, 1.0) * 240.0));
  const cv::Vec3b bgr = kTable.at<cv::Vec3b>(0, index);
  return {bgr[2], bgr[1], bgr[0]};
}

#ifdef HV_HAVE_FREETYPE
/// DejaVu Sans where it is installed, else OpenCV's stroke font.
class Canvas::Font {
 public:
  explicit Font(bool bold) : bold_(bold) {
    const std::string path =
        std::string("/usr/share/fonts/truetype/dejavu/DejaVuSans") + (bold ? "-Bold" : "") + ".ttf";
    if (!std::filesystem::exists(path)) return;
    free_type_ = cv::freetype::createFreeType2();
    free_type_->loadFontData(path, 0);
  }

  int Width(const std::string& text, int height) {
    if (!free_type_) return cv::getTextSize(text, kStroke, height / 26.0, Weight(), nullptr).width;
    int baseline = 0;
    return free_type_->getTextSize(text, height, -1, &baseline).width;
  }

  void Put(cv::Mat image, const std::string& text, cv::Point at, int height, cv::Scalar colour) {
    if (!free_type_) {
      cv::putText(image, text, at, kStroke, height / 26.0, colour, Weight(), cv::LINE_AA);
    } else {
      free_type_->putText(image, text, at, height, colour, -1, cv::LINE_AA, true);
    }
  }

 private:
  static constexpr int kStroke = cv::FONT_HERSHEY_SIMPLEX;
  int Weight() const { return bold_ ? 3 : 2; }

  const bool bold_;
  cv::Ptr<cv::freetype::FreeType2> free_type_;
};
#else
/// OpenCV's stroke font.
class Canvas::Font {
 public:
  explicit Font(bool bold) : weight_(bold ? 3 : 2) {}

  int Width(const std::string& text, int height) {
    return cv::getTextSize(text, cv::FONT_HERSHEY_SIMPLEX, height / 26.0, weight_, nullptr).width;
  }

  void Put(cv::Mat image, const std::string& text, cv::Point at, int height, cv::Scalar colour) {
    cv::putText(image, text, at, cv::FONT_HERSHEY_SIMPLEX, height / 26.0, colour, weight_,
                cv::LINE_AA);
  }

 private:
  const int weight_;
};
#endif

Canvas::Canvas(int width, int height, Rgb background)
    : image_(height * kOversampling, width * kOversampling, CV_8UC3, ToScalar(background)),
      clip_(0, 0, image_.cols, image_.rows),
      regular_(std::make_unique<Font>(false)),
      bold_(std::make_unique<Font>(true)) {}

Canvas::Canvas(const cv::Mat& background) : Canvas(background.cols, background.rows, kWhite) {
  cv::resize(background, image_, image_.size(), 0, 0, cv::INTER_LINEAR);
}

Canvas::~Canvas() = default;

int Canvas::width() const { return image_.cols / kOversampling; }
int Canvas::height() const { return image_.rows / kOversampling; }

cv::Mat Canvas::Target() { return image_(clip_); }

cv::Point Canvas::Shifted(PixelPoint point) const {
  constexpr double kUnits = kOversampling * (1 << kShift);
  const auto to_int = [](double value) {
    return static_cast<int>(std::lround(std::clamp(value, -4e6, 4e6)));
  };
  return cv::Point(to_int(point.x * kUnits - clip_.x * (1 << kShift)),
                   to_int(point.y * kUnits - clip_.y * (1 << kShift)));
}

void Canvas::Polyline(const std::vector<PixelPoint>& points, Rgb colour, double thickness) {
  std::vector<cv::Point> shifted;
  shifted.reserve(points.size());
  for (const PixelPoint& point : points) shifted.push_back(Shifted(point));
  cv::Mat target = Target();
  cv::polylines(target, shifted, false, ToScalar(colour), Thickness(thickness), cv::LINE_AA,
                kShift);
}

void Canvas::Line(PixelPoint from, PixelPoint to, Rgb colour, double thickness) {
  Polyline({from, to}, colour, thickness);
}

void Canvas::Disc(PixelPoint centre, double radius, Rgb colour) {
  const int shifted = static_cast<int>(std::lround(radius * kOversampling * (1 << kShift)));
  cv::Mat target = Target();
  cv::circle(target, Shifted(centre), shifted, ToScalar(colour), cv::FILLED, cv::LINE_AA, kShift);
}

void Canvas::Rectangle(const PixelRect& rect, Rgb colour) {
  image_(ToRect(rect) & clip_).setTo(ToScalar(colour));
}

void Canvas::Outline(const PixelRect& rect, Rgb colour, double thickness) {
  Polyline({{rect.left, rect.top},
            {rect.right, rect.top},
            {rect.right, rect.bottom},
            {rect.left, rect.bottom},
            {rect.left, rect.top}},
           colour, thickness);
}

double Canvas::TextWidth(const std::string& text, const TextStyle& style) {
  const int height = static_cast<int>(std::lround(style.height * kOversampling));
  return static_cast<double>((style.bold ? *bold_ : *regular_).Width(text, height)) / kOversampling;
}

void Canvas::Text(PixelPoint at, const std::string& text, const TextStyle& style) {
  if (text.empty()) return;
  double left = at.x;
  if (style.anchor != TextAnchor::kLeft) {
    left -= TextWidth(text, style) * (style.anchor == TextAnchor::kRight ? 1.0 : 0.5);
  }
  const cv::Point origin(static_cast<int>(std::lround(left * kOversampling)) - clip_.x,
                         static_cast<int>(std::lround(at.y * kOversampling)) - clip_.y);
  const int height = static_cast<int>(std::lround(style.height * kOversampling));
  (style.bold ? *bold_ : *regular_).Put(Target(), text, origin, height, ToScalar(style.colour));
}

void Canvas::Clip(const PixelRect& rect) {
  clip_ = ToRect(rect) & cv::Rect(0, 0, image_.cols, image_.rows);
}

void Canvas::Unclip() { clip_ = cv::Rect(0, 0, image_.cols, image_.rows); }

void Canvas::Save(const std::string& path) const {
  cv::Mat small;
  cv::resize(image_, small, cv::Size(width(), height()), 0, 0, cv::INTER_AREA);
  try {
    if (cv::imwrite(path, small)) return;
  } catch (const cv::Exception&) {
    throw InputError(path + ": not a picture format that can be written (use .png)");
  }
  throw InputError(path + ": cannot be written");
}

}  // namespace hv::replay::plot
