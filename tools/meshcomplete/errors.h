// How a run of the program ends when it does not end well.
#pragma once

#include <QString>
#include <stdexcept>

namespace meshcomplete {
namespace runner {

/// The program's exit codes.
enum ExitCode { exit_done = 0, exit_failed = 1, exit_usage = 2, exit_open_holes = 3, exit_cancelled = 130 };

/// The user asked for something that does not exist or makes no sense. Nothing was done.
class UsageError : public std::runtime_error {
 public:
  explicit UsageError(const QString& message) : std::runtime_error(message.toStdString()) {}
};

/// Something that was asked for could not be done. Nothing was written.
class Failure : public std::runtime_error {
 public:
  explicit Failure(const QString& message) : std::runtime_error(message.toStdString()) {}
};

/// The user pressed Ctrl-C. Nothing was written.
class Interrupted : public std::runtime_error {
 public:
  Interrupted() : std::runtime_error("Cancelled. Nothing was written.") {}
};

}  // namespace runner
}  // namespace meshcomplete
