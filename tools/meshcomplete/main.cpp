// meshcomplete: runs MeshLab filters on mesh files, without a window and without a display.
#include <tbb/global_control.h>
#include <unistd.h>

#include <QApplication>
#include <QDir>
#include <QElapsedTimer>
#include <QFileInfo>
#include <QLocale>
#include <QSaveFile>
#include <cstdio>
#include <cstdlib>
#include <memory>

#include "common/host/runner_host.h"
#include "tools/meshcomplete/console.h"
#include "tools/meshcomplete/errors.h"
#include "tools/meshcomplete/guard.h"
#include "tools/meshcomplete/help.h"
#include "tools/meshcomplete/options.h"
#include "tools/meshcomplete/output.h"
#include "tools/meshcomplete/report.h"
#include "tools/meshcomplete/session.h"

namespace {

using namespace meshcomplete::runner;

/// Qt's own debugging messages, and those of MeshLab, are for developers.
void keep_quiet(QtMsgType type, const QMessageLogContext&, const QString& message) {
  if (type == QtCriticalMsg || type == QtFatalMsg) std::fprintf(stderr, "%s\n", qUtf8Printable(message));
}

/// Numbers are read and written with a decimal point, file names are UTF-8, and no display is asked for,
/// whatever the caller's environment says.
void prepare_environment() {
  setenv("LC_ALL", "C.UTF-8", 1);
  setenv("QT_QPA_PLATFORM", "offscreen", 1);
  unsetenv("QT_QPA_PLATFORMTHEME");
  QLocale::setDefault(QLocale::c());
  qInstallMessageHandler(keep_quiet);
}

/// Writes the report that the options ask for, if any.
bool write_report(const Options& options, const RunRecord& record, int exit_code, const QString& message) {
  if (options.report.isEmpty()) return true;
  QSaveFile file(options.report);
  file.setDirectWriteFallback(true);
  return file.open(QIODevice::WriteOnly) && file.write(as_json(record, exit_code, message)) >= 0 &&
         file.commit();
}

void check_report_path(const Options& options) {
  if (options.report.isEmpty()) return;
  const QFileInfo file(options.report);
  if (file.isDir() || !QFileInfo(file.absolutePath()).isDir() ||
      access(QFile::encodeName(file.absolutePath()).constData(), W_OK) != 0)
    throw UsageError("The report " + options.report + " cannot be written there.");
}

/// Runs the session and turns every way to end into an exit code and a message.
int run_session(const Options& options, Console& console, SharedRecord& record, QString& message) {
  try {
    check_report_path(options);
    // Never destroyed: MeshLab's plugins were not made to be unloaded, and the process ends right afterwards.
    auto* host = new meshcomplete::host::RunnerHost;
    return Session(options, *host, console, record).run();
  } catch (const UsageError& error) {
    message = error.what();
    return exit_usage;
  } catch (const Interrupted& error) {
    message = error.what();
    return exit_cancelled;
  } catch (const std::bad_alloc&) {
    message = "There is not enough memory for this. Nothing was written.";
  } catch (const std::exception& error) {
    message = QString::fromUtf8(error.what()) + " Nothing was written.";
  }
  return exit_failed;
}

int run_program(const Options& options) {
  if (options.help || options.version) {
    const QString version = QString("meshcomplete " MESHCOMPLETE_VERSION " for MeshLab %1")
                                .arg(meshcomplete::host::RunnerHost::release());
    std::printf("%s\n", qUtf8Printable(options.help ? help_text() : version));
    return exit_done;
  }
  std::unique_ptr<tbb::global_control> threads;
  if (options.threads)
    threads = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism,
                                                    std::size_t(*options.threads));
  Console console(options.quiet, options.log_file);
  auto* record = new SharedRecord;
  QElapsedTimer timer;
  timer.start();
  const auto finished_record = [record, &timer]() {
    RunRecord copy = record->copy();
    copy.total_seconds = double(timer.nsecsElapsed()) * 1e-9;
    return copy;
  };
  guard::set_ending([&](int exit_code, const QString& why) {
    OutputSet::discard_for_good();
    write_report(options, finished_record(), exit_code, why);
  });
  QString message;
  int exit_code = run_session(options, console, *record, message);
  guard::set_reaction(guard::Reaction::finish);
  OutputSet::discard_all();
  if (!message.isEmpty()) console.error(message);
  if (!write_report(options, finished_record(), exit_code, message)) {
    if (exit_code != exit_usage) console.error("The report " + options.report + " could not be written.");
    if (exit_code == exit_done || exit_code == exit_open_holes) exit_code = exit_failed;
  }
  guard::set_ending(guard::Ending());
  return exit_code;
}

}  // namespace

int main(int argc, char* argv[]) {
  prepare_environment();
  guard::install();
  int exit_code = exit_usage;
  try {
    QApplication application(argc, argv);
    exit_code = run_program(parse_options(application.arguments().mid(1)));
    std::fflush(nullptr);
    // Past the destructors of MeshLab's plugins, which may crash when no window was ever there.
    _exit(exit_code);
  } catch (const UsageError& error) {
    std::fprintf(stderr, "meshcomplete: %s\n", error.what());
  }
  std::fflush(nullptr);
  _exit(exit_code);
}
