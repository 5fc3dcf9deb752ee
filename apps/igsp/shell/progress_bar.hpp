#pragma once

#include <string>
#include <string_view>

#include "igsp/progress.hpp"

namespace igsp::cli {

/// Draws a bar per stage on standard error, if that is a terminal and bars are wanted at all.
class ProgressBar {
 public:
  explicit ProgressBar(bool wanted);
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  void update(const Progress& progress);

  /// The last stage is done: other output can follow.
  void finish();

  /// A line above the bar, where the bar is drawn at all.
  void print_above(const std::string& line);

  /// Takes the bar away: what it showed is said elsewhere.
  void clear();

  /// A callback that draws and asks to stop after an interrupt. Valid as long as the bar.
  ProgressCallback callback();

 private:
  void draw(int percent);

  bool enabled_;
  std::string stage_;
  int percent_ = -1;
  double stage_start_ = 0.0;
};

}  // namespace igsp::cli
