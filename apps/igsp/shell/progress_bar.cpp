#include "shell/progress_bar.hpp"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>

#include "shell/interrupt.hpp"

namespace igsp::cli {
namespace {

constexpr int name_width = 22, tail_width = 17, longest_bar = 40;

double now_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

int terminal_width() {
  winsize size{};
  return ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

}  // namespace

ProgressBar::ProgressBar(bool wanted) : enabled_(wanted && isatty(STDERR_FILENO) == 1) {}

// After an error or an interrupt the last stage keeps the share it had.
ProgressBar::~ProgressBar() {
  if (!stage_.empty()) std::fputs("\n", stderr);
}

void ProgressBar::update(const Progress& progress) {
  if (!enabled_) return;
  if (progress.stage != stage_) {
    finish();
    stage_ = progress.stage;
    stage_start_ = now_s();
    percent_ = -1;
  }
  const int percent = static_cast<int>(100 * std::clamp(progress.fraction, 0.0, 1.0));
  if (percent != percent_) draw(percent);
}

void ProgressBar::draw(int percent) {
  percent_ = percent;
  const int bar = std::clamp(terminal_width() - name_width - tail_width, 5, longest_bar);
  const int full = percent * bar / 100;
  const std::string line = fmt::format("\r{:<{}.{}} [{:#<{}}{:<{}}] {:>3}% {:6.1f} s", stage_, name_width, name_width,
                                       "", full, "", bar - full, percent, now_s() - stage_start_);
  std::fputs(line.c_str(), stderr);
  std::fflush(stderr);
}

void ProgressBar::finish() {
  if (stage_.empty()) return;
  draw(100);
  std::fputs("\n", stderr);
  stage_.clear();
}

void ProgressBar::print_above(const std::string& line) {
  if (!enabled_) return;
  std::fputs(fmt::format("\r\033[K{}\n", line).c_str(), stderr);
  if (!stage_.empty()) draw(std::max(percent_, 0));
}

void ProgressBar::clear() {
  if (stage_.empty()) return;
  std::fputs("\r\033[K", stderr);
  stage_.clear();
}

ProgressCallback ProgressBar::callback() {
  return [this](const Progress& progress) {
    update(progress);
    return !interrupted();
  };
}

}  // namespace igsp::cli
