// Ending early: Ctrl-C, and crashes inside MeshLab's code.
#pragma once

#include <QString>
#include <functional>

namespace meshcomplete {
namespace runner {
namespace guard {

/// What Ctrl-C does.
enum class Reaction {
  end_at_once,  ///< nothing is lost that is not cleaned up: the program ends
  ask,          ///< `cancelled()` becomes true; a second Ctrl-C ends the program
  finish,       ///< too late to cancel: results are being put in place
};

/// Called in the guard's own thread before the program ends early, at most once; `message` says why it ends.
/// Has to clean up and to write the report.
using Ending = std::function<void(int exit_code, const QString& message)>;

/// Takes SIGINT, SIGTERM, SIGHUP and the signals of crashes over. Call first, before there is another thread.
void install();
void set_ending(Ending ending);
void set_reaction(Reaction reaction);
/// What is going on, for the message after a crash: "reading bunny.ply".
void set_activity(const QString& activity);
bool cancelled();

}  // namespace guard
}  // namespace runner
}  // namespace meshcomplete
