// The texts of --help, --list, --describe and -d.
#pragma once

#include <QString>

#include "common/host/runner_host.h"

namespace meshcomplete {
namespace runner {

QString help_text();
/// Our filters, then MeshLab's own.
QString list_text(const host::RunnerHost& host);
/// A filter with every parameter: type, default, range, unit and meaning.
QString describe_text(host::RunnerHost& host, const host::HostFilter& filter);

}  // namespace runner
}  // namespace meshcomplete
