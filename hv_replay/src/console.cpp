#include "hv_replay/console.h"

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>

namespace hv::replay {
namespace {

constexpr int kBarWidth = 24;

double NowSeconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

const char* Code(Colour colour) {
  switch (colour) {
    case Colour::kBold:
      return "1";
    case Colour::kDim:
      return "2";
    case Colour::kGreen:
      return "32";
    case Colour::kYellow:
      return "33";
    case Colour::kRed:
      return "31";
    case Colour::kCyan:
      return "36";
    case Colour::kPlain:
      break;
  }
  return "0";
}

}  // namespace

bool ColourOutput() { return isatty(STDOUT_FILENO) != 0 && std::getenv("NO_COLOR") == nullptr; }

std::string Paint(const std::string& text, Colour colour, bool colour_output) {
  if (!colour_output || colour == Colour::kPlain) return text;
  return std::string("\033[") + Code(colour) + "m" + text + "\033[0m";
}

ProgressLine::ProgressLine(std::string label)
    : label_(std::move(label)), terminal_(isatty(STDERR_FILENO) != 0) {}

ProgressLine::~ProgressLine() {
  if (drawn_) std::fputc('\n', stderr);
}

void ProgressLine::Update(double fraction, const std::string& note) {
  if (!terminal_) return;
  const double now = NowSeconds();
  if (drawn_ && fraction < 1.0 && now - last_drawn_s_ < 0.1) return;
  last_drawn_s_ = now;
  drawn_ = true;
  const double share = std::clamp(fraction, 0.0, 1.0);
  const int filled = static_cast<int>(share * kBarWidth);
  std::string bar;
  for (int i = 0; i < kBarWidth; ++i) bar += i < filled ? "█" : "░";
  std::fprintf(stderr, "\r%s %s %3.0f%%  %s\033[K", label_.c_str(), bar.c_str(), 100.0 * share,
               note.c_str());
  std::fflush(stderr);
}

int RunTool(const std::string& name, const std::function<int()>& body) {
  try {
    return body();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: %s\n", name.c_str(), error.what());
    return 1;
  }
}

}  // namespace hv::replay
