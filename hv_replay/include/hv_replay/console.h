#pragma once

#include <functional>
#include <string>

namespace hv::replay {

/// True when standard output is a terminal that may be coloured (NO_COLOR is respected).
bool ColourOutput();

enum class Colour { kPlain, kBold, kDim, kGreen, kYellow, kRed, kCyan };

/// `text` in a colour, or as it is when `colour_output` is false.
std::string Paint(const std::string& text, Colour colour, bool colour_output);

/// A line on standard error that is rewritten in place; silent when that is not a terminal.
class ProgressLine {
 public:
  explicit ProgressLine(std::string label);
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  /// `fraction` in [0, 1]; `note` follows the bar. Draws at most about ten times a second.
  void Update(double fraction, const std::string& note);

 private:
  const std::string label_;
  const bool terminal_;
  double last_drawn_s_ = -1.0;
  bool drawn_ = false;
};

/// Runs a tool's body: what it throws becomes one line "<name>: <what>" on standard error and exit
/// status 1.
int RunTool(const std::string& name, const std::function<int()>& body);

}  // namespace hv::replay
