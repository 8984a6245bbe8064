#include "apps/repose/progress.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

namespace repose {

std::string clock_text(double seconds) {
  const long whole = std::max(0L, static_cast<long>(seconds + 0.5));
  char text[32];
  if (whole >= 3600) {
    std::snprintf(text, sizeof text, "%ld:%02ld:%02ld", whole / 3600, whole / 60 % 60, whole % 60);
  } else {
    std::snprintf(text, sizeof text, "%ld:%02ld", whole / 60, whole % 60);
  }
  return text;
}

Progress::Progress(std::string label, double total, bool wanted)
    : label_(std::move(label)), total_(total), visible_(wanted && isatty(STDERR_FILENO) != 0) {}

Progress::~Progress() {
  leave();
}

void Progress::leave() {
  if (visible_ && drawn_ != Clock::time_point{}) std::fputc('\n', stderr);
  drawn_ = {};
}

void Progress::update(double done, const std::string& detail) {
  if (!visible_) return;
  const auto now = Clock::now();
  if (now - drawn_ < std::chrono::milliseconds(100)) return;
  drawn_ = now;
  draw(done, detail);
}

void Progress::finish(const std::string& detail) {
  if (!visible_) return;
  drawn_ = Clock::now();
  draw(total_, detail);
  leave();
}

void Progress::draw(double done, const std::string& detail) {
  if (first_done_ < 0.0)
    first_done_ = done;  // a resumed run starts late; only what it does itself tells its speed
  constexpr int kWidth = 24;
  const double share = total_ > 0.0 ? std::clamp(done / total_, 0.0, 1.0) : 1.0;
  const int filled = static_cast<int>(share * kWidth);
  const double elapsed = std::chrono::duration<double>(Clock::now() - start_).count();
  const double rate = (done - first_done_) / std::max(elapsed, 1e-9);
  const std::string left = rate > 0.0 ? clock_text((total_ - done) / rate) : "-:--";
  std::string line = label_ + " [" + std::string(static_cast<std::size_t>(filled), '#') +
                     std::string(static_cast<std::size_t>(kWidth - filled), '.') + "] " +
                     std::to_string(static_cast<int>(share * 100.0)) + "%  " + left + " left  " + detail;
  winsize size{};
  if (ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0) {
    line.resize(std::min<std::size_t>(line.size(), size.ws_col - 1u));
  }
  std::fprintf(stderr, "\r\033[K%s", line.c_str());
  std::fflush(stderr);
}

}  // namespace repose
