#include "tools/meshcomplete/console.h"

#include <fcntl.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <QFile>
#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>

#include "tools/meshcomplete/errors.h"

namespace meshcomplete {
namespace runner {

namespace {

constexpr auto redraw_interval = std::chrono::milliseconds(100);
constexpr auto line_interval = std::chrono::seconds(2);
constexpr int bar_width = 20;

int terminal_width() {
  winsize size{};
  if (ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0) return size.ws_col;
  return 80;
}

void write_line(std::FILE* file, const QString& line) {
  const QByteArray bytes = line.toUtf8() + '\n';
  std::fwrite(bytes.constData(), 1, std::size_t(bytes.size()), file);
}

}  // namespace

Console::Console(bool quiet, const QString& log_file) : quiet_(quiet), terminal_(isatty(STDERR_FILENO) == 1) {
  if (!log_file.isEmpty()) {
    log_ = std::fopen(QFile::encodeName(log_file).constData(), "a");
    if (log_ == nullptr)
      throw UsageError(QString("The log file %1 cannot be written: %2.").arg(log_file, std::strerror(errno)));
    std::setvbuf(log_, nullptr, _IOLBF, 1 << 12);
  }
  // MeshLab's readers and filters print to stdout as they please; that must not get between the results.
  const int own = dup(STDOUT_FILENO);
  out_ = own >= 0 ? fdopen(own, "w") : nullptr;
  if (out_ == nullptr) out_ = std::fopen("/dev/null", "w");
  std::setvbuf(out_, nullptr, _IOLBF, 1 << 14);
  const int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC);
  if (nowhere >= 0) {
    std::fflush(stdout);
    dup2(nowhere, STDOUT_FILENO);
    close(nowhere);
  }
}

Console::~Console() {
  end_progress();
  std::fclose(out_);
  if (log_ != nullptr) std::fclose(log_);
}

void Console::print(const QString& text) {
  end_progress();
  write_line(out_, text);
}

void Console::log(const QString& line) {
  if (log_ != nullptr) write_line(log_, line);
  if (quiet_) return;
  end_progress();
  write_line(out_, line);
}

void Console::to_stderr(const QString& line) {
  end_progress();
  if (log_ != nullptr) write_line(log_, line);
  write_line(stderr, line);
}

void Console::warn(const QString& line) { to_stderr("meshcomplete: warning: " + line); }

void Console::error(const QString& line) { to_stderr("meshcomplete: " + line); }

void Console::begin(const QString& activity) {
  activity_ = activity;
  last_percent_ = -1;
  last_time_ = Clock::now();
  if (quiet_) return;
  if (terminal_)
    draw(0, QString());
  else
    write_line(stderr, activity);
}

void Console::progress(double fraction, const QString& stage) {
  if (quiet_ || activity_.isEmpty()) return;
  const int percent = int(std::floor(100 * std::min(1.0, std::max(0.0, fraction))));
  const Clock::time_point now = Clock::now();
  if (terminal_) {
    if (percent == last_percent_ && now - last_time_ < redraw_interval) return;
    draw(fraction, stage);
  } else {
    if (percent <= last_percent_ || now - last_time_ < line_interval) return;
    write_line(stderr,
               activity_ + ": " + QString::number(percent) + " %" + (stage.isEmpty() ? "" : ", " + stage));
  }
  last_percent_ = percent;
  last_time_ = now;
}

void Console::draw(double fraction, const QString& stage) {
  const double share = std::min(1.0, std::max(0.0, fraction));
  const int filled = int(std::floor(bar_width * share));
  QString line = QString("[%1%2] %3 % ")
                     .arg(QString(filled, '#'), QString(bar_width - filled, '.'))
                     .arg(int(std::floor(100 * share)), 3);
  line += activity_;
  if (!stage.isEmpty()) line += ": " + stage;
  const QByteArray bytes = "\r" + line.left(terminal_width() - 1).toUtf8() + "\033[K";
  std::fwrite(bytes.constData(), 1, std::size_t(bytes.size()), stderr);
  std::fflush(stderr);
  drawn_ = true;
}

void Console::end_progress() {
  if (!drawn_) return;
  std::fputs("\r\033[K", stderr);
  std::fflush(stderr);
  drawn_ = false;
}

}  // namespace runner
}  // namespace meshcomplete
