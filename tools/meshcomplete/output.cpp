#include "tools/meshcomplete/output.h"

#include <sys/stat.h>
#include <unistd.h>

#include <QDir>
#include <QFile>
#include <QFileInfo>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <mutex>
#include <set>
#include <string>

#include "tools/meshcomplete/errors.h"

namespace meshcomplete {
namespace runner {

namespace {

namespace fs = std::filesystem;

void remove_folder(const std::string& path) {
  // Whoever still writes into the folder may add a file between two looks; once the folder is gone nobody
  // can.
  std::error_code error;
  for (int attempt = 0; attempt < 100 && fs::exists(path, error); ++attempt) fs::remove_all(path, error);
}

/// The hidden folders of this process. Never destroyed: another thread may need them while the program ends.
struct HiddenFolders {
  std::mutex mutex;
  std::set<std::string> paths;

  /// With the mutex locked.
  void remove_all() {
    for (const std::string& path : paths) remove_folder(path);
    paths.clear();
  }
};

HiddenFolders& hidden_folders() {
  static HiddenFolders* const folders = new HiddenFolders;
  return *folders;
}

/// The file that a chain of links ends at, also when that does not exist yet.
QString resolve(const QString& path) {
  QString target = QFileInfo(path).absoluteFilePath();
  for (int step = 0; QFileInfo(target).isSymLink() && step < 40; ++step)
    target = QFileInfo(target).symLinkTarget();
  return QDir::cleanPath(target);
}

QString why() { return QString::fromLocal8Bit(std::strerror(errno)); }

}  // namespace

OutputSet::~OutputSet() { discard_all(); }

void OutputSet::claim(const QString& path) {
  File file;
  file.given = path;
  file.target = resolve(path);
  const QFileInfo target(file.target), folder(target.absolutePath());
  const auto refuse = [&path](const QString& reason) {
    throw UsageError("Cannot write " + path + ": " + reason + ".");
  };
  if (target.isDir()) refuse("it is a folder");
  if (target.exists() && !target.isFile()) refuse("it is not an ordinary file");
  if (!folder.isDir()) refuse("there is no folder " + folder.filePath());
  if (access(QFile::encodeName(folder.filePath()).constData(), W_OK | X_OK) != 0)
    refuse("there is no permission to write in the folder " + folder.filePath());
  if (target.exists() && access(QFile::encodeName(file.target).constData(), W_OK) != 0)
    refuse("it exists, and there is no permission to change it");
  for (const File& other : files_)
    if (other.target == file.target) refuse("it is asked for twice");
  files_.push_back(file);
}

QString OutputSet::temporary_path(const QString& path) {
  for (File& file : files_) {
    if (file.given != path) continue;
    const QFileInfo target(file.target);
    if (file.folder.isEmpty()) {
      HiddenFolders& folders = hidden_folders();
      const std::lock_guard<std::mutex> lock(folders.mutex);
      QByteArray name = QFile::encodeName(target.absolutePath() + "/.meshcomplete-XXXXXX");
      if (mkdtemp(name.data()) == nullptr)
        throw Failure("Cannot write in the folder " + target.absolutePath() + ": " + why() + ".");
      folders.paths.insert(name.toStdString());
      file.folder = QFile::decodeName(name);
    }
    // The name of the file given, not of a link's target: its extension is the format that was asked for.
    return file.folder + "/" + QFileInfo(file.given).fileName();
  }
  throw Failure("Nobody said that " + path + " would be written.");
}

void OutputSet::commit() {
  for (File& file : files_) {
    if (file.folder.isEmpty()) continue;
    const QString main_file = QFileInfo(file.given).fileName();
    const QDir folder(file.folder);
    struct stat before {};
    const bool exists = stat(QFile::encodeName(file.target).constData(), &before) == 0;
    for (const QString& name : folder.entryList(QDir::Files | QDir::Hidden)) {
      const bool is_main = name == main_file;
      const QByteArray from = QFile::encodeName(folder.filePath(name));
      const QByteArray to =
          QFile::encodeName(is_main ? file.target : QFileInfo(file.target).absolutePath() + "/" + name);
      if (is_main && exists && chmod(from.constData(), before.st_mode & 07777) != 0)
        throw Failure("Cannot give " + file.given + " the permissions it had: " + why() + ".");
      if (std::rename(from.constData(), to.constData()) != 0)
        throw Failure("Cannot put " + file.given + " in its place: " + why() + ".");
    }
  }
  discard_all();
}

void OutputSet::discard_all() {
  HiddenFolders& folders = hidden_folders();
  const std::lock_guard<std::mutex> lock(folders.mutex);
  folders.remove_all();
}

void OutputSet::discard_for_good() {
  HiddenFolders& folders = hidden_folders();
  // Never unlocked: the thread that was about to write must not make a folder between this and the end.
  folders.mutex.lock();
  folders.remove_all();
}

}  // namespace runner
}  // namespace meshcomplete
