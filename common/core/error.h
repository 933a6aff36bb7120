// The one exception type that the suite throws, and the one that says "the user cancelled".
#pragma once

#include <stdexcept>
#include <string>

namespace meshcomplete {

/// Something that stops the whole operation. `what()` is one or two sentences that a MeshLab user understands
/// and can act on; `stage()` names the step that failed ("reading the mesh", "tracing boundary loops", ...).
/// A hole that cannot be closed is not an error: it is data in the report.
class CompletionError : public std::runtime_error {
 public:
  CompletionError(std::string stage, const std::string& message)
      : std::runtime_error(message), stage_(std::move(stage)) {}
  const std::string& stage() const { return stage_; }

 private:
  std::string stage_;
};

/// Thrown by `Progress` when the user has asked to stop. The mesh is as it was.
class Cancelled : public CompletionError {
 public:
  Cancelled() : CompletionError("cancelled", "Cancelled. The mesh was not changed.") {}
};

}  // namespace meshcomplete
