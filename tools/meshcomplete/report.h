// The account of a run: what was read, what every filter did to every hole, what was written, and what it
// cost.
#pragma once

#include <QString>
#include <QStringList>
#include <mutex>
#include <utility>
#include <vector>

#include "common/core/patch.h"

namespace meshcomplete {
namespace runner {

struct FileRecord {
  QString file;
  std::size_t vertices = 0;
  std::size_t faces = 0;
  QStringList notes;

  /// "12 vertices, 20 faces"
  QString counts() const { return QString("%1 vertices, %2 faces").arg(vertices).arg(faces); }
};

struct FilterRecord {
  QString name;
  std::vector<std::pair<QString, QString>> parameters;  ///< as used, defaults included
  bool done = false;
  QString message;
  double seconds = 0;
  QStringList log;
  CompletionReport report;
};

struct RunRecord {
  std::vector<FileRecord> inputs;
  std::vector<FilterRecord> filters;
  std::vector<FileRecord> outputs;
  double load_seconds = 0;
  double save_seconds = 0;
  double total_seconds = 0;
};

/// Greatest amount of memory that the process has had, in megabytes (2^20 bytes).
double peak_memory_mb();

/// Whether some hole that was asked for is open still.
bool left_open(const RunRecord& record);

/// The record as JSON text. Always valid JSON: numbers that are not finite become null.
QByteArray as_json(const RunRecord& record, int exit_code, const QString& message);

/// A record that one thread fills while another may have to write it because the program ends early.
class SharedRecord {
 public:
  template <typename Change>
  void edit(Change change) {
    const std::lock_guard<std::timed_mutex> lock(mutex_);
    change(record_);
  }
  /// A copy; what there is without waiting long when another thread has died inside `edit`.
  RunRecord copy();

 private:
  std::timed_mutex mutex_;
  RunRecord record_;
};

}  // namespace runner
}  // namespace meshcomplete
