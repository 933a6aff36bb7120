// Declared parameters as MeshLab's, and the values that MeshLab hands back.
#pragma once

#include "common/host/filter_declaration.h"
#include "common/host/meshlab_version.h"

namespace meshcomplete {
namespace host {

/// Adds every declared parameter, with its default for this document, to MeshLab's list. The document may
/// hold no mesh.
void add_parameters(const FilterDeclaration& filter, MeshDocument& document, RichParameterList& list);

/// The values of one run. A parameter that is missing from the list has its default. Filter and document have
/// to outlive it, and the document's layers stay while it lives.
class MeshLabParameterValues : public ParameterValues {
 public:
  /// Throws CompletionError with a message for the user when a value is of the wrong kind or out of range.
  MeshLabParameterValues(const FilterDeclaration& filter, const MeshDocument& document,
                         const RichParameterList& list);

  bool boolean(const char* name) const override;
  int integer(const char* name) const override;
  double real(const char* name) const override;
  int choice(const char* name) const override;
  QString text(const char* name) const override;
  Vector3 point(const char* name) const override;
  const MeshModel* layer(const char* name) const override;

 private:
  const QVariant& value(const char* name, std::initializer_list<ParameterType> types) const;

  const FilterDeclaration& filter_;
  const MeshDocument& document_;
  std::vector<QVariant> values_;  // in the order of the declared parameters
};

}  // namespace host
}  // namespace meshcomplete
