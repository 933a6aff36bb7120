// What the program prints: results and logs to stdout, progress, warnings and errors to stderr.
#pragma once

#include <QString>
#include <chrono>
#include <cstdio>

namespace meshcomplete {
namespace runner {

/// Keeps the program's own output apart from what MeshLab's libraries print on their own.
class Console {
 public:
  /// Takes stdout over: from here on only this object writes to it. `log_file` (may be empty) gets a copy of
  /// the log, appended. Throws UsageError when it cannot be written.
  Console(bool quiet, const QString& log_file);
  ~Console();
  Console(const Console&) = delete;
  Console& operator=(const Console&) = delete;

  /// A result that was asked for: printed also when quiet.
  void print(const QString& text);
  /// A line of a filter's log, or of the program's own account of what it does. Not printed when quiet.
  void log(const QString& line);
  void warn(const QString& line);
  void error(const QString& line);

  /// What is going on now, e.g. "Reading bunny.ply": starts a new line of progress.
  void begin(const QString& activity);
  /// How far it is (0 to 1). On a terminal one line that is drawn again and again, elsewhere a line now and
  /// then.
  void progress(double fraction, const QString& stage);
  /// Removes the progress line.
  void end_progress();

 private:
  void draw(double fraction, const QString& stage);
  void to_stderr(const QString& line);

  using Clock = std::chrono::steady_clock;
  bool quiet_;
  bool terminal_;
  std::FILE* out_;
  std::FILE* log_ = nullptr;
  QString activity_;
  bool drawn_ = false;
  int last_percent_ = -1;
  Clock::time_point last_time_;
};

}  // namespace runner
}  // namespace meshcomplete
