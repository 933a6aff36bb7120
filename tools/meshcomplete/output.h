// Output files that are there as a whole or not at all.
#pragma once

#include <QString>
#include <vector>

namespace meshcomplete {
namespace runner {

/// Files are written in a hidden folder beside their place and then moved there, together with what their
/// format puts beside them (materials). A link in the place of a file stays a link: its target is replaced.
class OutputSet {
 public:
  OutputSet() = default;
  ~OutputSet();
  OutputSet(const OutputSet&) = delete;
  OutputSet& operator=(const OutputSet&) = delete;

  /// Checks that `path` can be written. Throws UsageError with the reason, also when it was claimed before.
  void claim(const QString& path);
  /// Where to write the file that `commit` will move to `path`, which was claimed. Throws Failure.
  QString temporary_path(const QString& path);
  /// Moves everything to its place. Throws Failure; what was moved before stays.
  void commit();
  /// Removes what was written and not moved. Also for another thread, while this object's owner is writing.
  static void discard_all();
  /// The same for a process that is about to end: from then on nobody can make another hidden folder, and a
  /// thread that tries waits for the end.
  static void discard_for_good();

 private:
  struct File {
    QString given;
    QString target;  ///< links resolved
    QString folder;  ///< the hidden folder, empty until needed
  };
  std::vector<File> files_;
};

}  // namespace runner
}  // namespace meshcomplete
