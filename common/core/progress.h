// Progress and cancelling: one object passed by reference, split into sub-ranges.
#pragma once

#include <functional>
#include <memory>
#include <string>

namespace meshcomplete {

/// Reports how far an operation is, and notices when the user wants to stop.
///
/// `update` may be called from any thread. The receiver is only ever called from the thread that made the
/// root object (MeshLab's callback pumps the GUI's event loop and must stay on the main thread); what other
/// threads report is forwarded at the next call from that thread. Fractions that reach the receiver never
/// decrease.
class Progress {
 public:
  /// Receives the fraction done (0 to 1) and the current stage; returns false to cancel.
  using Receiver = std::function<bool(double fraction, const std::string& stage)>;

  /// Reports to nobody and is never cancelled.
  Progress();
  explicit Progress(Receiver receiver);

  /// The part of this range between the fractions `from` and `to`, with a stage name of its own.
  Progress part(double from, double to, std::string stage) const;

  /// `fraction` of this range is done (clamped to 0 to 1). Throws `Cancelled` once the user has asked to
  /// stop. Cost: a few nanoseconds unless the receiver has to be called (at most about 30 times a second).
  void update(double fraction) const;

  /// Adds `amount` to what is done of this range, for loops whose parts end in any order, in any thread.
  void advance(double amount) const;

  /// Throws `Cancelled` once the user has asked to stop, without reporting anything new.
  void check() const;

 private:
  struct Shared;
  struct Range;
  std::shared_ptr<Shared> shared_;
  std::shared_ptr<Range> range_;
};

}  // namespace meshcomplete
